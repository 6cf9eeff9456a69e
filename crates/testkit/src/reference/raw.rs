//! Reference of `raw_depth_key` in `depth/raw.wgsl`, without the oblique projection.

/// The bits of a raw depth that counts for the range (0 < d <= 1), else 0.
pub fn key(d: f32) -> u32 {
    if d > 0.0 && d <= 1.0 { d.to_bits() } else { 0 }
}
