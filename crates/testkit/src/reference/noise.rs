//! Reference of `effect/noise.wgsl`.

use super::mix;

/// PCG-RXS-M-XS on 32 bits (O'Neill 2014; as a hash, Jarzynski and Olano 2020).
pub fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A random number in [-1, 1) for a corner of the lattice.
fn lattice(x: i32, y: i32, seed: u32) -> f64 {
    let h = hash(x as u32 ^ hash(y as u32 ^ hash(seed)));
    f64::from(h >> 8) / f64::from(1 << 23) - 1.0
}

/// Smooth noise in [-1, 1), with one random number per unit cell.
pub fn wave(at: [f64; 2], seed: u32) -> f64 {
    let cell = at.map(|v| v.floor() as i32);
    let t = at.map(|v| {
        let f = v - v.floor();
        f * f * (3.0 - 2.0 * f)
    });
    let corner = |i: i32, j: i32| lattice(cell[0] + i, cell[1] + j, seed);
    mix(
        mix(corner(0, 0), corner(1, 0), t[0]),
        mix(corner(0, 1), corner(1, 1), t[0]),
        t[1],
    )
}
