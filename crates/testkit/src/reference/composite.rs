//! Reference of `composite/composite.wgsl`.

use super::{Rgb, Rgba, mix, noise};

/// `x`, `split`: pixels from the left edge of the viewport.
pub fn compare(weight: f64, split: f64, original: Rgba, styled: Rgba, x: f64) -> Rgba {
    let seen = if x < split { 0.0 } else { weight };
    std::array::from_fn(|i| mix(original[i], styled[i], seen))
}

/// Position of a raw depth in the range: 1 at the near end, 0 at the far end and
/// for the sky. `ends`: raw depth of (near, far); `None` without geometry.
pub fn range_fraction(ends: Option<[f64; 2]>, raw: f64) -> f64 {
    match ends {
        _ if raw == 0.0 => 0.0,
        None => 0.0,
        Some([near, far]) if near <= far => 1.0,
        Some([near, far]) => ((raw - far) / (near - far)).clamp(0.0, 1.0),
    }
}

/// Display code of the colour that stands for an object; black for id 0.
pub fn object_color(id: u32) -> Rgb {
    if id == 0 {
        return [0.0; 3];
    }
    let bytes = noise::hash(id).to_le_bytes();
    std::array::from_fn(|i| 0.2 + 0.8 * f64::from(bytes[i]) / 255.0)
}

/// Four times the difference of two colours in display codes, at most 1.
pub fn difference(original: Rgb, styled: Rgb) -> Rgb {
    std::array::from_fn(|i| (4.0 * (styled[i] - original[i]).abs()).min(1.0))
}
