#define_import_path bevy_comics::cartoon::ramp_light

// What the modes of a ramp have in common.

#import bevy_comics::cartoon::{
    bindings::cartoon,
    ramp::{shadowed_tone, tone},
    surface::{Arriving, Surface, cosine_over_pixel},
}

// Cosine of the angle between normal and light, and its change over a pixel. Without
// backface shadows every surface faces the light.
fn angle_of(s: Surface, light: Arriving) -> vec2<f32> {
    if cartoon.light.backface <= 0.0 {
        return vec2(1.0, 0.0);
    }
    return vec2(dot(s.normal, light.to_light), cosine_over_pixel(s.foot, light.to_light));
}

// A tone, of which shadows take away only a part.
fn weakened(color: vec3<f32>) -> vec3<f32> {
    let strength = max(cartoon.light.backface, cartoon.light.projected);
    return mix(tone(cartoon.ramp, 1.0, 0.0), color, strength);
}

// The tone of one light.
fn tone_of(cosine: f32, width: f32, lit: f32) -> vec3<f32> {
    return weakened(shadowed_tone(cartoon.ramp, cosine, width, lit));
}

// The colour of a surface in a tone. `direct` is light of light sources, `even` light from
// all around.
fn toned(base: vec3<f32>, color: vec3<f32>, direct: vec3<f32>, even: vec3<f32>) -> vec3<f32> {
#ifdef RAMP_ABSOLUTE
    return color * (direct + even);
#else
    return base * (color * direct + even);
#endif
}
