//! Twin of `finish/finish.wgsl`.

use super::{Rgb, mix, noise};

pub fn compare(weight: f64, split: f64, original: Rgb, styled: Rgb, x: f64) -> Rgb {
    let seen = if x < split { 0.0 } else { weight };
    std::array::from_fn(|i| mix(original[i], styled[i], seen))
}

/// `None` is a view without geometry.
pub fn range_share(ends: Option<[f64; 2]>, raw: f64) -> f64 {
    match ends {
        _ if raw == 0.0 => 0.0,
        None => 0.0,
        Some([near, far]) if near <= far => 1.0,
        Some([near, far]) => ((raw - far) / (near - far)).clamp(0.0, 1.0),
    }
}

pub fn object_color(id: u32) -> Rgb {
    if id == 0 {
        return [0.0; 3];
    }
    let bytes = noise::hash(id).to_le_bytes();
    std::array::from_fn(|i| 0.2 + 0.8 * f64::from(bytes[i]) / 255.0)
}

pub fn difference(original: Rgb, styled: Rgb) -> Rgb {
    std::array::from_fn(|i| (4.0 * (styled[i] - original[i]).abs()).min(1.0))
}
