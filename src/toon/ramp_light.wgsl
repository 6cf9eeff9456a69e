#define_import_path bevy_comics::toon::ramp_light

// What the modes of a ramp have in common.

#import bevy_comics::toon::{
    bindings::toon,
    surface::{Arriving, Surface, biased_cosine, biased_over_pixel},
}
#ifdef RAMP_MAP
#import bevy_comics::toon::ramp_map::{map_row, map_shadowed, map_tone}
#else
#import bevy_comics::toon::ramp::{Ramp, mixed_ramp, shadowed_tone, tone}
#endif
#ifdef DETAIL_HIGHLIGHT
#import bevy_comics::toon::detail::detail_of_highlight
#endif

#ifdef RAMP_MAP
@group(#{MATERIAL_BIND_GROUP}) @binding(105) var ramp_sums: texture_2d<f32>;
#endif

// Cosine of the angle between normal and light, and its change over a pixel. Without
// form shadows every surface faces the light.
fn angle_of(s: Surface, light: Arriving) -> vec2<f32> {
    if toon.light.form_shadow <= 0.0 {
        return vec2(1.0, 0.0);
    }
    return vec2(biased_cosine(s, light.to_light), biased_over_pixel(s, light.to_light));
}

// The detail of the ramp in the light from a direction.
fn detail_of(s: Surface, to_light: vec3<f32>) -> f32 {
#ifdef DETAIL_HIGHLIGHT
    return detail_of_highlight(toon.detail, dot(reflect(-to_light, s.normal), s.to_eye));
#else
    return s.detail;
#endif
}

// The ramp at a detail: of a map, its row.
#ifdef RAMP_MAP
fn ramp_of(detail: f32) -> f32 {
#ifdef RAMP_DETAIL
    return map_row(ramp_sums, detail);
#else
    return 0.0;
#endif
}

fn tone_at(row: f32, arriving: f32, width: f32) -> vec3<f32> {
    return map_tone(ramp_sums, row, arriving, width);
}

fn shadowed_at(row: f32, angle: vec2<f32>, lit: f32) -> vec3<f32> {
    return map_shadowed(ramp_sums, row, angle.x, angle.y, lit);
}

fn full_tone(row: f32) -> vec3<f32> {
    return tone_at(row, 1.0, 0.0);
}
#else
fn ramp_of(detail: f32) -> Ramp {
#ifdef RAMP_DETAIL
    return mixed_ramp(toon.ramp, detail);
#else
    return toon.ramp;
#endif
}

fn tone_at(ramp: Ramp, arriving: f32, width: f32) -> vec3<f32> {
    return tone(ramp, arriving, width);
}

fn shadowed_at(ramp: Ramp, angle: vec2<f32>, lit: f32) -> vec3<f32> {
    return shadowed_tone(ramp, angle.x, angle.y, lit);
}

fn full_tone(ramp: Ramp) -> vec3<f32> {
    return tone(ramp, 1.0, 0.0);
}
#endif

// The part of a tone that shadows take away; the rest is that of full light.
fn shadow_strength() -> f32 {
    return min(max(toon.light.form_shadow, toon.light.cast_shadow), 1.0);
}

// The tone of one light. `angle` is what `angle_of` returned.
fn tone_of(angle: vec2<f32>, lit: f32, detail: f32) -> vec3<f32> {
    let ramp = ramp_of(detail);
    let color = shadowed_at(ramp, angle, lit);
    let strength = shadow_strength();
    if strength >= 1.0 {
        return color;
    }
    return mix(full_tone(ramp), color, strength);
}

// The color of a surface in a tone. `direct` is light of light sources, `even` light from
// all around.
fn toned(base: vec3<f32>, color: vec3<f32>, direct: vec3<f32>, even: vec3<f32>) -> vec3<f32> {
#ifdef RAMP_ABSOLUTE
    return color * (direct + even);
#else
    return base * (color * direct + even);
#endif
}
