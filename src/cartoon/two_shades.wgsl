#define_import_path bevy_comics::cartoon::two_shades

// Light without a ramp: all of it, or none.

#import bevy_comics::cartoon::{
    reflect::{PI, highlight_of, unshadowed},
    surface::{Arriving, Surface},
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi, without the colour of the surface; and that of highlights.
    color: vec3<f32>,
    shine: vec3<f32>,
}

fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving) {
    (*sum).color += light.color * (unshadowed(s, light) * light.diffuse);
    (*sum).shine += light.color * highlight_of(s, light);
}

// Reflected light, exposed. `tint` is the colour of highlights, `around` the light that
// arrives evenly.
fn reflected(sum: Sum, base: vec3<f32>, tint: vec3<f32>, around: vec3<f32>) -> vec3<f32> {
    return view.exposure * ((base * sum.color + tint * sum.shine) / PI + base * around);
}
