//! Twin of `depth/raw.wgsl`.

use bevy::math::{DMat4, DVec4};

/// Whether a depth is geometry for the range: positive, at most one, a number.
pub fn key(d: f32) -> u32 {
    if d > 0.0 && d <= 1.0 { d.to_bits() } else { 0 }
}

/// Distance before the camera of a point of the depth buffer.
pub fn distance(clip_from_view: DMat4, ndc: [f64; 2], d: f64) -> f64 {
    let view = clip_from_view.inverse() * DVec4::new(ndc[0], ndc[1], d, 1.0);
    -view.z / view.w
}
