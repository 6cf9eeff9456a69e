//! Reference of `effect/blue_noise.wgsl` in a pass that has no tile.

use super::noise;

/// A threshold by column and row: white noise that repeats every 64 steps.
pub fn blue_noise(x: i64, y: i64) -> f64 {
    let i = (y.rem_euclid(64) * 64 + x.rem_euclid(64)) as u32;
    (f64::from(noise::hash(i) & 255) + 0.5) / 256.0
}
