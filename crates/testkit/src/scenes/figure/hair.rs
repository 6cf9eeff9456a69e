//! Hair: a cap, and locks that fall from it. In the frame of the head.

use std::f32::consts::PI;

use bevy::prelude::*;

use super::clay::{curve, lock};
use crate::{
    scenes::{noise::smoothstep, shape::Shape},
    specimens::solid::sculpt,
};

/// The middle of the skull, and its half axes.
const SKULL: Vec3 = Vec3::new(0.0, 0.2, -0.08);
const RADII: Vec3 = Vec3::new(0.79, 0.84, 0.85);

/// A point above the skull. Degrees: from the front to +x, and upwards from the middle.
fn above(around: f32, up: f32, lift: f32) -> Vec3 {
    let (around, up) = (around.to_radians(), up.to_radians());
    let direction = Vec3::new(around.sin() * up.cos(), up.sin(), around.cos() * up.cos());
    SKULL + direction * (RADII + lift)
}

fn from_skull(p: Vec3) -> Vec3 {
    p - SKULL
}

/// Half of the width along a lock: it begins wide, swells, and ends in a point.
fn pointed(t: f32, width: f32, thickness: f32) -> Vec2 {
    let t = t.clamp(0.0, 1.0);
    let swell = 0.75 + 0.4 * (PI * t).sin();
    let end = (1.0 - t.powi(3)).max(0.0).sqrt();
    Vec2::new(width, thickness) * swell * end
}

/// Close to the head, down to the hairline; below that it is inside the head.
pub fn cap() -> Shape {
    sculpt(50, |direction| {
        let cover = smoothstep(-0.02, 0.1, 0.72 * direction.y - 0.69 * direction.z + 0.05);
        let radius = 0.82 + cover * 0.26;
        SKULL + direction * RADII * radius
    })
}

/// A lock that follows the skull. `from` and `to`: degrees around and up.
fn along_skull(shape: &mut Shape, from: Vec2, to: Vec2, size: Vec2) {
    let path = |t: f32| {
        let at = from.lerp(to, t);
        let lift = 0.05 + 0.09 * (PI * t.clamp(0.0, 1.0)).sin() + 0.05 * t;
        above(at.x, at.y, lift)
    };
    lock(shape, path, from_skull, |t| pointed(t, size.x, size.y));
}

/// The fringe: where each lock begins and ends, degrees around and up, and half of its width.
const FRINGE: [([f32; 2], [f32; 2], f32); 8] = [
    ([-62.0, 62.0], [-68.0, -4.0], 0.17),
    ([62.0, 62.0], [70.0, -6.0], 0.17),
    ([-34.0, 68.0], [-50.0, 6.0], 0.18),
    ([40.0, 66.0], [52.0, 8.0], 0.17),
    ([-12.0, 70.0], [-31.0, 10.0], 0.17),
    ([28.0, 68.0], [32.0, 12.0], 0.15),
    ([2.0, 70.0], [-12.0, 8.0], 0.15),
    ([16.0, 70.0], [12.0, 16.0], 0.14),
];

pub fn fringe() -> Shape {
    let mut shape = Shape::default();
    for (from, to, width) in FRINGE {
        let size = Vec2::new(width, 0.06);
        along_skull(&mut shape, from.into(), to.into(), size);
    }
    shape
}

/// The long lock in front of an ear, with its root at the origin. `side`: 1 for +x.
pub fn side_lock(side: f32) -> (Vec3, Shape) {
    let root = above(side * 74.0, 46.0, 0.05);
    let mut shape = Shape::default();
    let front = [[1.02, 0.3, 0.3], [0.88, -0.45, 0.42], [0.6, -0.98, 0.5]];
    let behind = [[1.06, 0.25, 0.08], [1.04, -0.5, 0.2], [0.78, -1.12, 0.26]];
    for (points, width) in [(front, 0.17), (behind, 0.19)] {
        let [a, b, c] = points.map(|[x, y, z]| Vec3::new(side * x, y, z));
        let path = curve([root, a, b, c].map(|p| p - root));
        let out = |p: Vec3| (p + root) * Vec3::new(1.0, 0.0, 0.8);
        lock(&mut shape, path, out, |t| pointed(t, width, 0.075));
    }
    (root, shape)
}

/// The hair at the back, down to the neck.
pub fn back() -> Shape {
    let mut shape = Shape::default();
    for k in 0..13u8 {
        let around = 90.0 + 15.0 * f32::from(k);
        let turn = Quat::from_rotation_y(around.to_radians());
        let long = if k % 2 == 0 { 0.0 } else { 0.13 };
        let at = |radius: f32, y: f32| turn * (Vec3::Z * radius) + Vec3::new(0.0, y, -0.1);
        let path = curve([
            above(around, 50.0, 0.04),
            at(1.1, 0.2),
            at(1.0, -0.55),
            at(0.68, -1.05 + long),
        ]);
        let out = |p: Vec3| p * Vec3::new(1.0, 0.0, 1.0);
        lock(&mut shape, path, out, |t| pointed(t, 0.26, 0.1));
    }
    shape
}

/// A lock that does not lie down.
pub fn cowlick() -> (Vec3, Shape) {
    let root = above(20.0, 84.0, 0.03);
    let mut shape = Shape::default();
    let points = [
        [0.0, -0.05, 0.0],
        [0.03, 0.24, 0.02],
        [0.2, 0.36, 0.06],
        [0.42, 0.22, 0.12],
    ];
    let path = curve(points.map(Vec3::from));
    let (out, size) = (|_| Vec3::Y + Vec3::Z, |t| pointed(t, 0.075, 0.045));
    lock(&mut shape, path, out, size);
    (root, shape)
}
