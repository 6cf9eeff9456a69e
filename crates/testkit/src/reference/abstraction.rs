//! Reference of `lines/modifiers/abstraction.wgsl`, and of bands that split in `effect/color.wgsl`.

use super::{mix, smoothstep, tone_bands::band_tone};

/// What is `near` at D = 0 and `far` at D = 1.
pub fn graded([near, far]: [f64; 2], exponent: f64, d: f64) -> f64 {
    mix(near, far, d.clamp(0.0, 1.0).powf(exponent))
}

/// The abstraction of an object by distance, with a dial of its own: a factor and what is added.
pub fn dialled(by_distance: f64, [factor, added]: [f64; 2]) -> f64 {
    (factor * by_distance + added).clamp(0.0, 1.0)
}

/// Bands that have split `splits` times. `step`: the width of a step in lightness.
pub fn split_bands(levels: f64, splits: f64, y: f64, step: f64) -> f64 {
    let whole = splits.floor();
    let [fewer, more] =
        [0.0, 1.0].map(|one| band_tone(levels * (whole + one).exp2(), step, y, 1.0));
    mix(fewer, more, smoothstep(0.0, 1.0, splits - whole))
}

/// Factors of the response of an edge, and of the opacity of a crease.
pub fn lines([threshold, crease_opacity]: [f64; 2], a: f64) -> [f64; 2] {
    [1.0 / mix(1.0, threshold, a), mix(1.0, crease_opacity, a)]
}
