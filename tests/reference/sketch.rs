//! Twin of `styles/sketch.wgsl`.

use super::{Rgb, mix};
use bevy_comics::Sketch;

/// PCG-RXS-M-XS on 32 bits (O'Neill 2014; as a hash, Jarzynski and Olano 2020).
pub fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn lattice(x: i32, y: i32, seed: u32) -> f64 {
    let h = hash(x as u32 ^ hash(y as u32 ^ hash(seed)));
    f64::from(h >> 8) / f64::from(1 << 23) - 1.0
}

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

pub fn stray(s: &Sketch, at: [f64; 2], stroke: u32, drawing: u32, scale: f64) -> [f64; 2] {
    let seed = drawing * 16 + stroke * 4;
    let p = at.map(|v| v / (f64::from(s.wavelength) * scale));
    [seed, seed + 1].map(|seed| f64::from(s.jitter) * scale * wave(p, seed))
}

pub fn pen_pressure(s: &Sketch, at: [f64; 2], stroke: u32, drawing: u32, scale: f64) -> f64 {
    let p = at.map(|v| v / (f64::from(s.wavelength) * scale) * 1.7);
    let n = wave(p, drawing * 16 + stroke * 4 + 2);
    1.0 - f64::from(s.pressure) * (0.5 + 0.5 * n)
}

pub fn draw_sketch(s: &Sketch, picture: Rgb, inked: f64) -> Rgb {
    let rgb = |color: bevy::color::Color| {
        let c = color.to_linear();
        [c.red, c.green, c.blue].map(f64::from)
    };
    let (paper, ink) = (rgb(s.paper), rgb(s.ink));
    let amount = inked.max(0.0).powf(f64::from(s.gamma)).min(1.0);
    std::array::from_fn(|i| {
        let ground = mix(paper[i], paper[i] * picture[i], f64::from(s.wash));
        mix(ground, ink[i], amount)
    })
}
