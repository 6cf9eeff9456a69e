#define_import_path bevy_comics::cartoon::ramp_light

// What the modes of a ramp have in common.

#import bevy_comics::cartoon::{
    bindings::cartoon,
    ramp::{Ramp, mixed_ramp, shadowed_tone, tone},
    surface::{Arriving, Surface, biased_cosine, biased_over_pixel},
}
#ifdef DETAIL_HIGHLIGHT
#import bevy_comics::cartoon::detail::detail_of_highlight
#endif

// Cosine of the angle between normal and light, and its change over a pixel. Without
// backface shadows every surface faces the light.
fn angle_of(s: Surface, light: Arriving) -> vec2<f32> {
    if cartoon.light.backface <= 0.0 {
        return vec2(1.0, 0.0);
    }
    return vec2(biased_cosine(s, light.to_light), biased_over_pixel(s, light.to_light));
}

// The detail of the ramp in the light from a direction.
fn detail_of(s: Surface, to_light: vec3<f32>) -> f32 {
#ifdef DETAIL_HIGHLIGHT
    return detail_of_highlight(cartoon.detail, dot(reflect(-to_light, s.normal), s.to_eye));
#else
    return s.detail;
#endif
}

// The ramp at a detail.
fn ramp_of(detail: f32) -> Ramp {
#ifdef RAMP_DETAIL
    return mixed_ramp(cartoon.ramp, detail);
#else
    return cartoon.ramp;
#endif
}

// A tone of a ramp, of which shadows take away only a part.
fn weakened(ramp: Ramp, color: vec3<f32>) -> vec3<f32> {
    let strength = max(cartoon.light.backface, cartoon.light.projected);
    if strength >= 1.0 {
        return color;
    }
    return mix(tone(ramp, 1.0, 0.0), color, strength);
}

// The tone of one light. `angle` is what `angle_of` returned.
fn tone_of(angle: vec2<f32>, lit: f32, detail: f32) -> vec3<f32> {
    let ramp = ramp_of(detail);
    return weakened(ramp, shadowed_tone(ramp, angle.x, angle.y, lit));
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
