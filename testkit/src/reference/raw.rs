//! Twin of `depth/raw.wgsl`.

/// Whether a depth is geometry for the range: positive, at most one, a number.
pub fn key(d: f32) -> u32 {
    if d > 0.0 && d <= 1.0 { d.to_bits() } else { 0 }
}
