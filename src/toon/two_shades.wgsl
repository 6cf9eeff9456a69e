#define_import_path bevy_comics::toon::two_shades

// Light without a ramp: all of it, or none.

#import bevy_comics::toon::{
    reflect::PI,
    surface::{Arriving, Surface},
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi, without the color of the surface.
    color: vec3<f32>,
}

// `left` is what shadows leave of the light.
fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving, left: f32) {
    (*sum).color += light.color * (left * light.diffuse);
}

// Reflected light, exposed. `around` is the light that arrives evenly, `specular` that of
// highlights, times pi.
fn reflected(sum: Sum, base: vec3<f32>, around: vec3<f32>, specular: vec3<f32>) -> vec3<f32> {
    return view.exposure * ((base * sum.color + specular) / PI + base * around);
}
