//! Repeatable random numbers and smooth noise for the scenes.

use bevy::math::{Vec2, Vec3};

/// A small counter-based generator (the finaliser of `MurmurHash3`, 64 bits).
#[derive(Clone, Debug)]
pub struct Random(u64);

fn mix(mut x: u64) -> u64 {
    x ^= x >> 33;
    x = x.wrapping_mul(0xff51_afd7_ed55_8ccd);
    x ^= x >> 33;
    x = x.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    x ^ (x >> 33)
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(mix(seed.wrapping_add(0x9e37_79b9_7f4a_7c15)))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mix(self.0) >> 40) as f32 / (1u64 << 24) as f32
    }

    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    pub fn pick<T: Clone>(&mut self, from: &[T]) -> T {
        from[((self.unit() * from.len() as f32) as usize).min(from.len() - 1)].clone()
    }
}

fn lattice(x: i32, y: i32, z: i32) -> f32 {
    let key = (x as u32 as u64) | ((y as u32 as u64) << 32);
    (mix(key ^ mix(z as u32 as u64 + 0x51)) >> 40) as f32 / (1u64 << 23) as f32 - 1.0
}

/// Value noise in [-1, 1], smooth in its first two derivatives.
pub fn noise3(p: Vec3) -> f32 {
    let cell = p.floor();
    let f = p - cell;
    let s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let (x, y, z) = (cell.x as i32, cell.y as i32, cell.z as i32);
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |y, z| lerp(lattice(x, y, z), lattice(x + 1, y, z), s.x);
    let plane = |z| lerp(row(y, z), row(y + 1, z), s.y);
    lerp(plane(z), plane(z + 1), s.z)
}

/// A plane of [`noise3`].
pub fn noise2(p: Vec2) -> f32 {
    noise3(p.extend(0.5))
}

/// Sum of octaves of noise in (-1, 1). Each octave is rotated against the one before,
/// which hides the grid of the noise.
pub fn fractal(p: Vec2, octaves: u32) -> f32 {
    let (mut sum, mut gain, mut q) = (0.0, 0.5, p);
    for _ in 0..octaves {
        sum += gain * noise2(q);
        gain *= 0.5;
        q = Vec2::new(0.8 * q.x - 0.6 * q.y, 0.6 * q.x + 0.8 * q.y) * 2.03;
    }
    sum
}

/// Sharp ridges in [0, 1.1]: a sum of octaves of `1 - |noise|`. Each octave is weighted
/// by the one before, so that the detail is on the ridges.
pub fn ridges(p: Vec2, octaves: u32) -> f32 {
    let (mut sum, mut gain, mut weight, mut q) = (0.0, 0.55, 1.0, p);
    for _ in 0..octaves {
        let ridge = 1.0 - noise2(q).abs() * 1.6;
        let crest = ridge.max(0.0).powi(2) * weight;
        weight = (crest * 1.8).clamp(0.0, 1.0);
        sum += gain * crest;
        gain *= 0.5;
        q = Vec2::new(0.8 * q.x - 0.6 * q.y, 0.6 * q.x + 0.8 * q.y) * 2.07;
    }
    sum
}

pub fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
