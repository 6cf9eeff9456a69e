//! Thin things: a lattice mast, cables, a coil and a fence.

use std::f32::consts::TAU;

use bevy::prelude::*;

use super::{
    Part,
    solid::{beam, tube},
};
use crate::scenes::shape::Shape;

/// Foot and height of the mast and of the post at the other end of the cables.
const MAST: (Vec3, f32) = (Vec3::new(-1.1, 0.0, 0.0), 2.4);
const POST: (Vec3, f32) = (Vec3::new(1.3, 0.0, 0.0), 1.75);

/// Bays of the mast.
const BAYS: u32 = 9;

pub(super) fn parts() -> Vec<Part> {
    let [mut steel, mut cables, mut copper, mut fence]: [Shape; 4] = default();
    mast(&mut steel);
    beam(&mut steel, POST.0, POST.0 + Vec3::Y * POST.1, 0.06);
    let ends = [MAST, POST].map(|(foot, height)| foot + Vec3::Y * (height - 0.1));
    for end in ends {
        let arm = Vec3::Z * 0.4;
        beam(&mut steel, end - arm, end + arm, 0.035);
    }
    for (z, scale) in [(-0.35, 1.2), (0.0, 1.7), (0.35, 2.4)] {
        let [from, to] = ends.map(|end| end + Vec3::Z * z);
        tube(&mut cables, &catenary(from, to, scale), 0.008, 8);
    }
    coil(&mut copper);
    panel(&mut fence);
    vec![
        (steel, 0x7d868c),
        (cables, 0x26282b),
        (copper, 0xb5672f),
        (fence, 0x3f6b4f),
    ]
}

/// Adds a square mast that becomes narrower towards its top.
fn mast(shape: &mut Shape) {
    let corner = |k: u32, level: u32| {
        let t = level as f32 / BAYS as f32;
        let (sin, cos) = (TAU * (k as f32 + 0.5) / 4.0).sin_cos();
        MAST.0 + Vec3::Y * (MAST.1 * t) + Vec3::new(cos, 0.0, sin) * (0.26 - 0.14 * t)
    };
    for k in 0..4 {
        beam(shape, corner(k, 0), corner(k, BAYS), 0.026);
        for level in 0..BAYS {
            let (low, high) = (corner(k, level), corner(k, level + 1));
            let (low_next, high_next) = (corner(k + 1, level), corner(k + 1, level + 1));
            beam(shape, high, high_next, 0.014);
            // Of different widths, so that their faces are not in one plane.
            beam(shape, low, high_next, 0.012);
            beam(shape, low_next, high, 0.009);
        }
    }
}

/// Points of the curve in which a cable hangs between two points of one z:
/// `y = scale cosh((x - lowest) / scale)` and a constant.
fn catenary(from: Vec3, to: Vec3, scale: f32) -> Vec<Vec3> {
    const SEGMENTS: u32 = 48;
    let (span, climb) = (to.x - from.x, to.y - from.y);
    let lowest =
        span / 2.0 - scale * (climb / (2.0 * scale * (span / (2.0 * scale)).sinh())).asinh();
    let height = |x: f32| scale * ((x - lowest) / scale).cosh();
    let points = (0..=SEGMENTS).map(|i| {
        let x = span * i as f32 / SEGMENTS as f32;
        from + Vec3::new(x, height(x) - height(0.0), 0.0)
    });
    points.collect()
}

/// Adds a helix of nine turns that lies along the x axis.
fn coil(shape: &mut Shape) {
    const TURNS: u32 = 9;
    const STEPS_PER_TURN: u32 = 24;
    let path: Vec<_> = (0..=TURNS * STEPS_PER_TURN)
        .map(|i| {
            let turns = i as f32 / STEPS_PER_TURN as f32;
            let (sin, cos) = (TAU * turns).sin_cos();
            Vec3::new(0.1 + 0.07 * turns, 0.18 + 0.16 * sin, 0.75 + 0.16 * cos)
        })
        .collect();
    tube(shape, &path, 0.014, 8);
}

/// Adds a frame with upright and level wires. The level wires are before the others.
fn panel(shape: &mut Shape) {
    let (low, high) = (Vec3::new(-0.9, 0.05, -0.75), Vec3::new(1.1, 0.95, -0.75));
    let point = |x: f32, y: f32| low + (high - low) * Vec3::new(x, y, 0.0);
    let frame = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| point(x, y));
    for (k, corner) in frame.iter().enumerate() {
        // Of different widths, so that the ends of the bars are not in one plane.
        let width = if k % 2 == 0 { 0.03 } else { 0.034 };
        beam(shape, *corner, frame[(k + 1) % 4], width);
    }
    let depth = Vec3::Z * 0.004;
    for i in 1..21 {
        let x = i as f32 / 21.0;
        let wire = [point(x, 0.0) - depth, point(x, 1.0) - depth];
        tube(shape, &wire, 0.005, 6);
    }
    for i in 1..10 {
        let y = i as f32 / 10.0;
        let wire = [point(0.0, y) + depth, point(1.0, y) + depth];
        tube(shape, &wire, 0.005, 6);
    }
}
