//! Reference of `effect/nested.wgsl`.

use super::{
    mix,
    noise::{hash, wave},
    smoothstep,
};

/// A coordinate as marks are numbered by it: far from the origin it counts modulo 2^20.
pub fn coordinate(x: f64) -> f64 {
    let turn = f64::from(1 << 20);
    x - turn * (x / turn).round()
}

/// The exponent of a level, and how far its new marks have grown.
pub fn level_of(least: f64) -> (i32, f64) {
    let exponent = least.log2().floor() as i32 + 1;
    (exponent, f64::from(exponent).exp2() / least - 1.0)
}

/// A random number of a mark.
pub fn mark_of(number: i64, exponent: i32, seed: u32) -> u32 {
    let (mut odd, mut exponent) = (number, exponent);
    if odd == 0 {
        return hash(seed);
    }
    while odd % 2 == 0 {
        odd /= 2;
        exponent += 1;
    }
    hash(odd as u32 ^ hash(exponent as u32 ^ hash(seed)))
}

/// A random number of the node of square lattices.
pub fn mark_of_node([mut i, mut j]: [i64; 2], mut exponent: i32, seed: u32) -> u32 {
    if [i, j] == [0, 0] {
        exponent = 0;
    }
    while [i, j] != [0, 0] && i % 2 == 0 && j % 2 == 0 {
        (i, j) = (i / 2, j / 2);
        exponent += 1;
    }
    let of_level = (exponent as u32).wrapping_mul(2_654_435_769);
    let of_level = of_level.wrapping_add(seed.wrapping_mul(2_246_822_519));
    hash(i as u32 ^ hash(j as u32 ^ of_level))
}

/// Noise along a line. The WGSL has it in one dimension: a row of the lattice.
pub fn noise_along(at: f64, grown: f64, period: f64, seed: u32) -> f64 {
    let of = |x: f64| wave([x, 0.0], seed);
    mix(of(at / period), of(2.0 * at / period), grown)
}

/// Where a stroke begins, as a fraction of its length.
pub fn stroke_start(mark: u32, exponent: i32) -> f64 {
    f64::from(mark.rotate_left((-exponent).rem_euclid(32) as u32) >> 8) / f64::from(1 << 24)
}

/// Factor of the width of a line; its mean is 1.
pub fn stroke_factor(at: f64, grown: f64, breaks: f64) -> f64 {
    let taper = 0.15 / (1.0 + grown);
    let thin = |by: f64| 1.0 - smoothstep(0.0, taper, by);
    let away = (at - at.round()).abs();
    (1.0 - breaks * thin(away)) * (1.0 - breaks * grown * thin(0.5 - away)) / (1.0 - 0.15 * breaks)
}
