//! A flight of stairs on a landing, in meters. It climbs towards -z.

use bevy::prelude::*;

use super::{
    Part,
    solid::{PLAIN, ball, beam, extrude, revolve, tube, turned},
};
use crate::scenes::shape::Shape;

const STEPS: u32 = 12;
const RISE: f32 = 0.17;
const RUN: f32 = 0.27;
const HALF_WIDTH: f32 = 0.5;
/// How far a tread projects over its riser.
const NOSING: f32 = 0.03;
/// Thickness of a tread.
const TREAD: f32 = 0.04;
/// Where the stringers begin and end on the z axis.
const FRONT: f32 = 0.12;
const BACK: f32 = -(STEPS as f32) * RUN - 0.01;
/// Vertical size of a stringer.
const STRINGER: f32 = 0.36;
/// Height of the handrail over the stringers.
const RAIL: f32 = 0.85;
/// Where the balusters are on the x axis.
const RAIL_X: f32 = HALF_WIDTH + 0.015;

pub(super) fn parts() -> Vec<Part> {
    let mut steps = Shape::default();
    for i in 0..STEPS {
        step(&mut steps, i as f32);
    }
    let (mut frame, mut rails) = (Shape::default(), Shape::default());
    frame.cuboid([-0.9, -0.1, BACK - 0.3], [0.9, 0.0, 0.9], PLAIN);
    for side in [-1.0, 1.0] {
        stringer(&mut frame, side);
        railing(&mut rails, side * RAIL_X);
    }
    vec![(steps, 0xb98b58), (frame, 0x8e8a84), (rails, 0x3b4148)]
}

/// The height of the upper edge of a stringer.
fn top_of_stringer(z: f32) -> f32 {
    RISE + (NOSING - z) * (RISE / RUN) + 0.05
}

/// A point of the cross-section at the left end of the steps.
fn at_left(z: f32, y: f32) -> Vec3 {
    Vec3::new(-HALF_WIDTH, y, z)
}

/// Adds a riser and the tread on it. Parts that touch reach into each other, so that no
/// two faces are in one plane.
fn step(shape: &mut Shape, i: f32) {
    let (floor, z) = (i * RISE, -i * RUN);
    let top = floor + RISE;
    let (front, back) = (z + NOSING, z - RUN - 0.01);
    let bevel = 0.012;
    let tread = [
        at_left(back, top),
        at_left(front - bevel, top),
        at_left(front, top - bevel),
        at_left(front, top - TREAD + bevel),
        at_left(front - bevel, top - TREAD),
        at_left(back, top - TREAD),
    ];
    extrude(shape, &tread, Vec3::X * (2.0 * HALF_WIDTH));
    shape.cuboid(
        [-HALF_WIDTH, floor - TREAD / 2.0, z - 0.02],
        [HALF_WIDTH, top - TREAD / 2.0, z],
        PLAIN,
    );
}

/// Adds the board that carries the ends of the steps on one side.
fn stringer(shape: &mut Shape, side: f32) {
    let floor = -0.01;
    let foot = FRONT - (STRINGER - top_of_stringer(FRONT) + floor) / (RISE / RUN);
    let x = side * (HALF_WIDTH - 0.01);
    let outline = [
        (floor, FRONT),
        (top_of_stringer(FRONT), FRONT),
        (top_of_stringer(BACK), BACK),
        (top_of_stringer(BACK) - STRINGER, BACK),
        (floor, foot),
    ]
    .map(|(y, z)| Vec3::new(x, y, z));
    extrude(shape, &outline, Vec3::X * (side * 0.05));
}

/// Adds the balusters, the newel post and the handrail of one side.
fn railing(shape: &mut Shape, x: f32) {
    // The lower end is in the stringer and the upper end in the handrail.
    let height = RAIL + 0.03;
    let baluster = revolve(&turned(&[(0.012, 0.0), (0.012, height)]), 12);
    for i in 0..STEPS {
        let z = -(i as f32 + 0.35) * RUN;
        let foot = Transform::from_xyz(x, top_of_stringer(z) - 0.03, z);
        shape.add(&baluster, foot);
    }
    let rail = |z: f32| Vec3::new(x, top_of_stringer(z) + RAIL, z);
    let (start, end) = (rail(FRONT), rail(BACK + 0.05));
    let out = Vec3::Z * 0.15;
    tube(shape, &[start + out, start, end, end - out], 0.028, 16);
    let head = start + Vec3::Y * 0.06;
    beam(shape, Vec3::new(x, -0.02, FRONT), head, 0.07);
    let knob = Transform::from_translation(head + Vec3::Y * 0.03).with_scale(Vec3::splat(0.042));
    ball(shape, knob, 24);
}
