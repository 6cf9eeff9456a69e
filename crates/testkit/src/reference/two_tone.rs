//! Reference of `effects/two_tone/two_tone.wgsl`.

use super::{Rgb, Rgba, color::luminance, mix, smoothstep};
use bevy_comics::{TwoTone, effect::linear_rgb};

/// Fraction of the light tone at a lightness that changes by `change` over a pixel.
pub fn light_fraction(s: &TwoTone, y: f64, change: f64) -> f64 {
    let half = (0.5 * f64::from(s.softness) * change).max(1e-4);
    let threshold = mix(-half, 1.0 + half, f64::from(s.threshold));
    smoothstep(threshold - half, threshold + half, y)
}

/// Fraction of the light tone where ink was drawn over a picture: the luminance `before`
/// and `after` the ink.
pub fn inked_light_fraction(s: &TwoTone, before: f64, after: f64, change: f64) -> f64 {
    let light = light_fraction(s, before.sqrt(), change);
    if after < before {
        light * (1.0 - (1.15 * (before - after) / before.max(1e-4)).min(1.0))
    } else {
        let added = (1.15 * (after - before) / (1.0 - before).max(1e-4)).min(1.0);
        mix(light, 1.0, added)
    }
}

/// The colour of a pixel without ink, multiplied by its opacity.
pub fn two_tone(s: &TwoTone, picture: Rgba, change: f64) -> Rgb {
    let alpha = picture[3];
    let y = luminance([0, 1, 2].map(|i| picture[i] / alpha.max(1e-3))).clamp(0.0, 1.0);
    let light = inked_light_fraction(s, y, y, change);
    let (dark, bright) = if s.invert {
        (s.light, s.dark)
    } else {
        (s.dark, s.light)
    };
    let [dark, bright] = [dark, bright].map(|c| linear_rgb(c).to_array().map(f64::from));
    std::array::from_fn(|i| {
        let tone = mix(dark[i], bright[i], light);
        mix(picture[i], tone * alpha, f64::from(s.amount))
    })
}
