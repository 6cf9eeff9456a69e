//! Reference of `toon/reflect.wgsl`.

use bevy_comics::ToonLight;

use super::super::light::{edge_at, highlight};
use super::surface::{
    Arriving, Surface, biased_cosine, biased_over_pixel, cosine_over_pixel, half_way,
};

/// Strengths of the backface shadow and of the projected shadow.
pub fn shadows(light: &ToonLight) -> [f64; 2] {
    [light.form_shadows, light.cast_shadows].map(|on| match on {
        true => f64::from(light.shadow_strength),
        false => 0.0,
    })
}

/// Fraction of a light that the stronger of its two shadows leaves.
pub fn unshadowed(light: &ToonLight, s: &Surface, lamp: &Arriving) -> f64 {
    let [backface, projected] = shadows(light);
    let cosine = biased_cosine(s, lamp.to_light);
    let width = biased_over_pixel(s, lamp.to_light);
    let faces = edge_at(f64::from(light.shadow_threshold), cosine, width);
    let left = [
        1.0 - backface * (1.0 - faces),
        1.0 - projected * (1.0 - lamp.lit),
    ];
    left[0].min(left[1])
}

/// Highlight of a light, as a multiple of it. `left` is what shadows leave.
pub fn highlight_of(light: &ToonLight, s: &Surface, lamp: &Arriving, left: f64) -> f64 {
    let half = half_way(lamp.to_highlight, s.to_eye);
    let cosine = s.normal.dot(half).clamp(0.0, 1.0);
    let width = cosine_over_pixel(&s.foot, half);
    lamp.shine * left * highlight(light, s.roughness, cosine, width)
}
