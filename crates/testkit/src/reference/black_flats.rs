//! Reference of `effects/black_flats/black_flats.wgsl`.

use super::{
    Rgb, Rgba,
    color::{largest, srgb_encode_one},
    mix, smoothstep,
};
use bevy_comics::BlackFlats;

fn softness(s: &BlackFlats) -> f64 {
    f64::from(s.softness).max(1e-3)
}

/// Coverage of a dark area, 0 to 1. `linear`: the unstyled color; `l`: complement
/// of the depth map.
pub fn dark_area(s: &BlackFlats, linear: Rgb, l: f64) -> f64 {
    let threshold = f64::from(s.value.unwrap_or(0.0)) * mix(1.0, l, f64::from(s.depth_weight));
    if threshold <= 0.0 {
        return 0.0;
    }
    let value = srgb_encode_one(largest(linear));
    1.0 - smoothstep(
        threshold * (1.0 - softness(s)),
        threshold * (1.0 + softness(s)),
        value,
    )
}

/// Coverage of a steep area, 0 to 1. `prewitt`: response of the depth map at the
/// resolution of the viewport; `rows`: height of the viewport in pixels. The
/// threshold is defined for a map of 512 rows.
pub fn steep_area(s: &BlackFlats, prewitt: f64, rows: u32) -> f64 {
    let Some(slope) = s.slope.map(f64::from) else {
        return 0.0;
    };
    let response = prewitt * f64::from(rows) / 512.0;
    smoothstep(
        slope * (1.0 - softness(s)),
        slope * (1.0 + softness(s)),
        response,
    )
}

/// Fills what is there of a picture.
pub fn fill(s: &BlackFlats, picture: Rgba, coverage: f64) -> Rgb {
    let ink = s.color.to_linear();
    let ink = [ink.red, ink.green, ink.blue].map(f64::from);
    let t = (coverage * f64::from(s.opacity)).clamp(0.0, 1.0);
    std::array::from_fn(|i| mix(picture[i], ink[i] * picture[3], t))
}
