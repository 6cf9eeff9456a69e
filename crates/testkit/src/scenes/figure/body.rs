//! Shoulders, a raised arm with its hand, and a scarf. In the frame of the head.

use std::f32::consts::{PI, TAU};

use bevy::prelude::*;

use super::clay::{bone, ellipsoid, join, lock, outward, sheet, strip, surface};
use crate::{scenes::shape::Shape, specimens::solid::ball};

/// Joints of the raised arm.
pub const ELBOW: Vec3 = Vec3::new(1.72, -2.85, 0.2);
pub const WRIST: Vec3 = Vec3::new(1.6, -1.5, 0.72);

const SHOULDER: Vec3 = Vec3::new(0.98, -2.02, -0.28);
/// Where the tail of the scarf begins.
pub const KNOT: Vec3 = Vec3::new(-0.5, -1.38, -0.42);

/// A small fold of cloth along a direction.
fn fold(p: Vec3, direction: Vec3, depth: f32) -> f32 {
    depth * (p.dot(direction)).sin() * (0.7 * p.dot(direction.zxy()) + 1.0).sin()
}

/// Distance to the coat.
fn cloth(p: Vec3) -> f32 {
    let mirrored = Vec3::new(p.x.abs(), p.y, p.z);
    let middle = SHOULDER * Vec3::new(0.0, 1.0, 1.0);
    let across = bone(mirrored, (middle, SHOULDER), (0.4, 0.37));
    let chest = ellipsoid(p, Vec3::new(0.0, -2.75, -0.24), Vec3::new(1.0, 1.1, 0.62));
    let throat = (Vec3::new(0.0, -1.4, -0.24), Vec3::new(0.0, -2.0, -0.26));
    let neck = bone(p, throat, (0.36, 0.62));
    let other = SHOULDER * Vec3::new(-1.0, 1.0, 1.0);
    let hanging = bone(p, (other, Vec3::new(-1.4, -3.6, 0.0)), (0.37, 0.3));
    let raised = bone(p, (SHOULDER, ELBOW), (0.37, 0.33));
    let mut coat = join(across, chest, 0.3);
    coat = join(coat, neck, 0.35);
    coat = join(coat, hanging.min(raised), 0.12);
    coat + fold(p, Vec3::new(5.0, 7.0, 3.0), 0.012)
}

pub fn coat() -> Shape {
    let (low, high) = (Vec3::new(-2.0, -3.6, -1.1), Vec3::new(2.3, -1.2, 0.9));
    surface(low, high, 0.045, cloth)
}

/// The place of the coat in front of a point, and its normal.
fn on_coat(x: f32, y: f32) -> (Vec3, Vec3) {
    let mut place = Vec3::new(x, y, 1.4);
    for _ in 0..40 {
        place.z -= 0.7 * cloth(place);
    }
    (place, outward(&cloth, place))
}

/// The band down the front of the coat.
pub fn placket() -> Shape {
    let mut shape = Shape::default();
    sheet(&mut shape, 40, 6, |u, v| {
        let (place, normal) = on_coat(-0.12 + 0.24 * v, -1.5 - 1.4 * u);
        (place + normal * 0.02, normal)
    });
    shape
}

pub fn buttons() -> Shape {
    let mut shape = Shape::default();
    for y in [-2.0, -2.5] {
        let (place, normal) = on_coat(0.0, y);
        let turn = Quat::from_rotation_arc(Vec3::Z, normal);
        let at = Transform::from_translation(place + normal * 0.02).with_rotation(turn);
        ball(&mut shape, at.with_scale(Vec3::new(0.065, 0.065, 0.03)), 24);
    }
    shape
}

/// The sleeve of the forearm, with its elbow at the origin.
pub fn sleeve() -> Shape {
    let along = WRIST - ELBOW;
    let (low, high) = (Vec3::new(-0.6, -0.45, -0.5), Vec3::new(0.5, 1.6, 1.0));
    surface(low, high, 0.036, |p| {
        let end = along * 0.9;
        let arm = bone(p, (Vec3::ZERO, end), (0.33, 0.25));
        let across = along.normalize();
        // Rings of cloth that is pushed together at the elbow.
        let t = p.dot(across) / along.length();
        let rings = 0.022 * (TAU * 4.5 * t).sin() * (1.0 - t).clamp(0.0, 1.0);
        let cut = (p - end).dot(across);
        (arm + rings).max(cut)
    })
}

/// The turned-up end of the sleeve.
pub fn cuff() -> Shape {
    let along = WRIST - ELBOW;
    let axis = along.normalize();
    let (u, v) = axis.any_orthonormal_pair();
    let middle = along * 0.86;
    let mut shape = Shape::default();
    // The profile around which the ring is turned: half height and half thickness.
    strip(&mut shape, 48, 16, |t, angle| {
        let around = -TAU * t;
        let out = u * around.cos() + v * around.sin();
        let square = |x: f32| x.signum() * x.abs().powf(0.5);
        let (sin, cos) = angle.sin_cos();
        middle + out * (0.225 + 0.06 * square(cos)) + axis * (0.13 * square(sin))
    });
    shape
}

/// Fingers of the raised hand: knuckles, middles and tips, in units of the hand from its wrist, and
/// the radii. The palm faces +z, and the thumb is on the side of the head.
const KNUCKLES: [[f32; 3]; 4] = [
    [-0.19, 0.5, 0.02],
    [-0.06, 0.54, 0.0],
    [0.08, 0.52, 0.0],
    [0.19, 0.45, 0.02],
];
const MIDDLES: [[f32; 3]; 4] = [
    [-0.27, 0.74, 0.04],
    [-0.085, 0.82, 0.02],
    [0.13, 0.78, 0.02],
    [0.285, 0.65, 0.04],
];
const TIPS: [[f32; 3]; 4] = [
    [-0.31, 0.93, 0.06],
    [-0.095, 1.04, 0.05],
    [0.165, 0.98, 0.05],
    [0.35, 0.81, 0.07],
];
const FINGER_RADII: [f32; 4] = [0.072, 0.075, 0.072, 0.063];

const THUMB: [[f32; 3]; 3] = [[-0.14, 0.14, 0.05], [-0.34, 0.3, 0.13], [-0.44, 0.5, 0.14]];

/// The raised hand, with its wrist at the origin.
pub fn hand() -> Shape {
    let (low, high) = (Vec3::new(-0.65, -0.4, -0.35), Vec3::new(0.55, 1.25, 0.4));
    surface(low, high, 0.022, |p| {
        let palm = ellipsoid(p, Vec3::new(0.0, 0.31, 0.0), Vec3::new(0.27, 0.31, 0.12));
        let forearm = (Vec3::new(0.02, -0.3, -0.02), Vec3::new(0.0, 0.12, 0.0));
        let wrist = bone(p, forearm, (0.15, 0.15));
        let ball = ellipsoid(p, Vec3::new(-0.13, 0.2, 0.08), Vec3::new(0.12, 0.17, 0.1));
        let mut hand = join(palm, wrist, 0.16);
        hand = join(hand, ball, 0.08);
        let [a, b, c] = THUMB.map(Vec3::from);
        let thumb = bone(p, (a, b), (0.095, 0.08)).min(bone(p, (b, c), (0.08, 0.066)));
        hand = join(hand, thumb, 0.07);
        let mut fingers = f32::INFINITY;
        for (k, radius) in FINGER_RADII.into_iter().enumerate() {
            let [a, b, c] = [KNUCKLES[k], MIDDLES[k], TIPS[k]].map(Vec3::from);
            let root = bone(p, (a - Vec3::Y * 0.12, b), (radius * 1.05, radius));
            let end = bone(p, (b, c), (radius, radius * 0.82));
            fingers = join(fingers, join(root, end, 0.03), 0.012);
        }
        join(hand, fingers, 0.045)
    })
}

/// The scarf around the neck: two turns of folded cloth.
pub fn scarf() -> Shape {
    let mut shape = Shape::default();
    for (height, size, tilt, phase) in [(-1.5, 0.27, 0.1, 0.0), (-1.2, 0.23, -0.12, 1.3)] {
        strip(&mut shape, 120, 28, |t, angle| {
            // The seam is at the back.
            let around = TAU * t - PI / 2.0;
            let out = Vec3::new(around.cos(), 0.0, around.sin());
            let ring = Vec3::new(0.5 * around.cos(), 0.0, 0.47 * around.sin() - 0.16);
            let lean = tilt * around.cos() - 0.1 * around.sin();
            let folds = 1.0
                + 0.1 * (3.0 * angle + 4.0 * around + phase).cos()
                + 0.05 * (5.0 * angle - 3.0 * around).sin();
            let (sin, cos) = angle.sin_cos();
            let section = out * (0.9 * cos) + Vec3::Y * sin;
            ring + Vec3::Y * (height + lean) + section * (size * folds)
        });
    }
    shape
}

/// The middle of the tail of the scarf, from its root on.
fn tail_path(t: f32) -> Vec3 {
    let wave = 0.2 * (TAU * 1.1 * t - 0.5).sin() * t;
    let depth = 0.3 * (6.5 * t).sin() * t - 0.2 * t;
    Vec3::new(-2.3 * t, 0.3 * t + wave, depth)
}

/// A part of the tail of the scarf, which turns in the wind.
fn tail_part(shape: &mut Shape, ends: (f32, f32), thickness: f32) {
    let at = |t: f32| ends.0 + (ends.1 - ends.0) * t;
    let out = |p: Vec3| Vec3::new(0.5 * (3.4 * p.x).sin(), 0.3 + 0.3 * (2.2 * p.x).cos(), 1.0);
    let size = |t: f32| {
        let end = f32::from((0.001..0.999).contains(&t));
        Vec2::new(0.17 + 0.15 * at(t).sqrt(), thickness) * end
    };
    lock(shape, |t| tail_path(at(t)), out, size);
}

/// The tail of the scarf in the wind, with its root at the origin.
pub fn tail() -> Shape {
    let mut shape = Shape::default();
    tail_part(&mut shape, (0.0, 1.0), 0.03);
    shape
}

/// Two bands across the end of the tail.
pub fn bands() -> Shape {
    let mut shape = Shape::default();
    for ends in [(0.76, 0.82), (0.87, 0.93)] {
        tail_part(&mut shape, ends, 0.045);
    }
    shape
}
