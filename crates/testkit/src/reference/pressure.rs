//! Reference of `objects/pressure.wgsl`: noise that is anchored to an object.

use super::{mix, noise::hash};

/// An object in world space: its origin and its three axes.
pub struct Frame {
    pub origin: [f64; 3],
    pub axes: [[f64; 3]; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

impl Frame {
    /// The length of the longest axis.
    pub fn scale(&self) -> f64 {
        let lengths = self.axes.map(|axis| dot(axis, axis).sqrt());
        lengths.into_iter().fold(1e-20, f64::max)
    }

    /// A place of the world as the object sees it, in units of its longest axis.
    pub fn place(&self, world: [f64; 3]) -> [f64; 3] {
        let away = std::array::from_fn(|i| world[i] - self.origin[i]);
        self.axes.map(|axis| {
            let length = dot(axis, axis).sqrt().max(1e-20);
            dot(away, axis) / length / self.scale()
        })
    }
}

/// A random number in [-1, 1) for a corner of the lattice.
fn lattice(corner: [i64; 3], seed: u32) -> f64 {
    let [x, y, z] = corner.map(|v| v as i32 as u32);
    let h = hash(x ^ hash(y ^ hash(z ^ hash(seed))));
    f64::from(h >> 8) / f64::from(1 << 23) - 1.0
}

/// Smooth noise in [-1, 1), with one random number per unit cell.
pub fn solid_wave(at: [f64; 3], seed: u32) -> f64 {
    let cell = at.map(|v| v.floor() as i64);
    let t = at.map(|v| {
        let f = v - v.floor();
        f * f * (3.0 - 2.0 * f)
    });
    let corner = |i: i64, j: i64, k: i64| lattice([cell[0] + i, cell[1] + j, cell[2] + k], seed);
    let row = |j, k| mix(corner(0, j, k), corner(1, j, k), t[0]);
    let plane = |k| mix(row(0, k), row(1, k), t[1]);
    mix(plane(0), plane(1), t[2])
}

/// The turn of the lattice against the object: that of the quaternion (4; 1, 2, 3).
fn turned(place: [f64; 3]) -> [f64; 3] {
    let rows = [[2.0, -10.0, 11.0], [14.0, 5.0, 2.0], [-5.0, 10.0, 10.0]];
    rows.map(|row| dot(row, place) / 15.0)
}

/// Noise of one octave, with one random number per 2^octave units.
fn octave_wave(place: [f64; 3], octave: i32, seed: u32) -> f64 {
    let at = turned(place).map(|v| v * f64::from(octave).exp2().recip());
    solid_wave(at, seed ^ hash(octave as u32))
}

/// Noise in [-1, 1] whose waves are 2^level units long.
pub fn nested_wave(place: [f64; 3], level: f64, seed: u32) -> f64 {
    let level = level.clamp(-60.0, 60.0);
    let octave = level.floor() as i32;
    let (sin, cos) = (level.fract().rem_euclid(1.0) * 0.5 * std::f64::consts::PI).sin_cos();
    let mixed = cos * octave_wave(place, octave, seed) + sin * octave_wave(place, octave + 1, seed);
    mixed.clamp(-1.0, 1.0)
}

/// The factor of the width of lines at a place. `pixels`: those of the viewport per unit.
pub fn pressure_factor(
    [amount, wavelength]: [f64; 2],
    place: [f64; 3],
    pixels: f64,
    seed: u32,
) -> f64 {
    1.0 + amount * nested_wave(place, (wavelength / pixels).log2(), seed)
}

/// The factor that the texture of widths stores, in codes of 8 bits.
pub fn stored_factor(factor: f64) -> f64 {
    127.0 * factor.clamp(0.0, 2.0)
}
