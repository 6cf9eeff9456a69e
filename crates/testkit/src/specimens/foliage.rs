//! A bush: 400 folded leaves on the twigs of a ball.

use std::f32::consts::TAU;

use bevy::prelude::*;

use super::{
    Part,
    solid::{PLAIN, tube},
};
use crate::scenes::{noise::Random, shape::Shape};

const BRANCHES: u32 = 10;
const TWIGS_PER_BRANCH: u32 = 5;
const LEAVES_PER_TWIG: u32 = 8;

pub(super) fn parts() -> Vec<Part> {
    let mut random = Random::new(2024);
    let mut wood = Shape::default();
    let mut leaves = [Shape::default(), Shape::default()];
    let stem = [(0.0, -1.3, 0.0), (0.04, -0.8, 0.02), (0.0, -0.3, 0.0)].map(Vec3::from);
    tube(&mut wood, &stem, 0.035, 10);
    for i in 0..BRANCHES {
        // A spiral of the golden angle spreads the branches evenly.
        let y = 1.0 - 2.0 * (i as f32 + 0.5) / BRANCHES as f32;
        let (sin, cos) = (2.4 * i as f32).sin_cos();
        let towards = Vec3::new(cos * (1.0 - y * y).sqrt(), y, sin * (1.0 - y * y).sqrt());
        let fork = stem[1].lerp(stem[2], random.unit());
        let tip = towards * random.range(0.5, 0.7);
        let elbow = fork.lerp(tip, 0.5) + Vec3::Y * 0.08;
        tube(&mut wood, &[fork, elbow, tip], 0.015, 6);
        for _ in 0..TWIGS_PER_BRANCH {
            let start = elbow.lerp(tip, random.range(0.2, 1.0));
            let end = (towards + direction(&mut random) * 0.8).normalize_or(towards)
                * random.range(0.75, 1.0);
            tube(&mut wood, &[start, end], 0.006, 5);
            for k in 1..=LEAVES_PER_TWIG {
                let at = start.lerp(end, 0.3 + 0.7 * k as f32 / LEAVES_PER_TWIG as f32);
                let along = (end - start).normalize() + direction(&mut random) * 0.9;
                leaf(&mut leaves[k as usize % 2], at, along, &mut random);
            }
        }
    }
    let [young, old] = leaves;
    vec![(wood, 0x6b4a2f), (young, 0x8fb544), (old, 0x4d7f3a)]
}

/// A random unit vector.
fn direction(random: &mut Random) -> Vec3 {
    let y = random.range(-1.0, 1.0);
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    Vec3::new(cos * (1.0 - y * y).sqrt(), y, sin * (1.0 - y * y).sqrt())
}

/// Adds a leaf: two flat halves that meet in a fold along its middle. Each half has a
/// front on both sides.
fn leaf(shape: &mut Shape, at: Vec3, along: Vec3, random: &mut Random) {
    let along = along.normalize_or(Vec3::Y);
    let turn = Quat::from_axis_angle(along, TAU * random.unit());
    let across = turn * along.any_orthonormal_vector();
    let up = along.cross(across);
    let length = random.range(0.13, 0.21);
    let width = length * random.range(0.25, 0.35);
    let (rise, reach) = random.range(0.3, 0.7).sin_cos();
    for side in [across * reach + up * rise, up * rise - across * reach] {
        let half = [
            at,
            at + along * (0.3 * length) + side * width,
            at + along * (0.65 * length) + side * (0.8 * width),
            at + along * length,
        ];
        let [a, b, c, d] = half;
        shape.polygon(&half, PLAIN);
        shape.polygon(&[d, c, b, a], PLAIN);
    }
}
