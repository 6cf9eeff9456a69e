//! Reference of `toon/art_map.wgsl`.

use bevy::math::DVec3;

/// A few of the 256 tones of a texel.
const STEP: f64 = 0.0156;

/// Ink of a texel.
pub fn ink_at(tone: f64, threshold: f64) -> f64 {
    let from = threshold / (1.0 + STEP);
    let to = (threshold + STEP) / (1.0 + STEP);
    ((tone - from) / (to - from)).clamp(0.0, 1.0)
}

/// The weights of the three planes of coordinates.
pub fn plane_weights(normal: DVec3) -> DVec3 {
    let w = (normal * normal - 0.2).max(DVec3::ZERO).powf(2.0);
    w / w.element_sum()
}

/// The tone of a plane.
pub fn plane_tone(tone: f64, weight: f64) -> f64 {
    1.0 - (1.0 - tone).max(1e-20).powf(weight)
}
