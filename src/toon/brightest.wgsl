#define_import_path bevy_comics::toon::brightest

// A ramp for the brightest light, and the rest evenly: `RampMode::Brightest`.

#import bevy_comics::toon::{
    ramp_light::{angle_of, detail_of, tone_of, toned},
    reflect::PI,
    surface::{Arriving, Surface},
    ambient::brightness,
}
#import bevy_pbr::mesh_view_bindings::view

struct Sum {
    // Light times pi of the brightest light before shadows, and of all others.
    color: vec3<f32>,
    rest: vec3<f32>,
    // Of the brightest light: brightness, what `angle_of` returned, how much of it arrives, and
    // the detail of the ramp.
    // The brightness is in rings, so that another light is the brightest beyond a ring, not
    // within it.
    bright: f32,
    angle: vec2<f32>,
    lit: f32,
    detail: f32,
}

fn add(sum: ptr<function, Sum>, s: Surface, light: Arriving, left: f32) {
    let color = light.color * light.diffuse;
    let bright = brightness(color);
    if bright > (*sum).bright {
        (*sum).rest += (*sum).color;
        (*sum).color = color;
        (*sum).bright = bright;
        (*sum).angle = angle_of(s, light);
        (*sum).lit = light.lit;
        (*sum).detail = detail_of(s, light.to_light);
    } else {
        (*sum).rest += color;
    }
}

fn reflected(sum: Sum, base: vec3<f32>, around: vec3<f32>, specular: vec3<f32>) -> vec3<f32> {
    // Half of a light: its mean over all directions that a surface can face.
    let even = 0.5 * sum.rest / PI + around;
    let tone = tone_of(sum.angle, sum.lit, sum.detail);
    return view.exposure * (toned(base, tone, sum.color / PI, even) + specular / PI);
}
