//! A standing person, in meters, who looks along +z.

use bevy::prelude::*;

use super::{
    Part,
    solid::{ball, capsule, revolve, sculpt, turned},
};
use crate::scenes::{
    noise::{noise3, smoothstep},
    shape::Shape,
};

/// Joints of the side of +x; the other side is mirrored.
const SHOULDER: Vec3 = Vec3::new(0.19, 1.39, -0.01);
const ELBOW: Vec3 = Vec3::new(0.27, 1.13, -0.03);
const WRIST: Vec3 = Vec3::new(0.31, 0.9, 0.04);
const HIP: Vec3 = Vec3::new(0.09, 0.92, 0.0);
const KNEE: Vec3 = Vec3::new(0.11, 0.5, 0.02);
const ANKLE: Vec3 = Vec3::new(0.12, 0.09, -0.02);

const HEAD: Vec3 = Vec3::new(0.0, 1.66, 0.01);
const HEAD_RADII: Vec3 = Vec3::new(0.078, 0.112, 0.098);

pub(super) fn parts() -> Vec<Part> {
    vec![
        (skin(), 0xd9a27e),
        (shirt(), 0x4f78a8),
        (trousers(), 0x5a4f46),
        (shoes(), 0x2b2a2c),
        (hair(), 0x4a2f1e),
    ]
}

/// A point given for the side of +x, on the side of a sign.
fn on(side: f32, p: Vec3) -> Vec3 {
    Vec3::new(side * p.x, p.y, p.z)
}

fn skin() -> Shape {
    let mut skin = sculpt(30, head);
    let neck = (Vec3::new(0.0, 1.4, -0.015), Vec3::new(0.0, 1.56, 0.0));
    capsule(&mut skin, (neck.0, 0.055), (neck.1, 0.05), 32);
    let nose = (Vec3::new(0.0, 1.668, 0.1), Vec3::new(0.0, 1.632, 0.12));
    capsule(&mut skin, (nose.0, 0.01), (nose.1, 0.016), 16);
    for side in [-1.0, 1.0] {
        let brow = [(0.012, 1.696, 0.1), (0.048, 1.698, 0.082)];
        let [inner, outer] = brow.map(|p| on(side, Vec3::from(p)));
        capsule(&mut skin, (inner, 0.01), (outer, 0.008), 16);
        let eye = on(side, Vec3::new(0.028, 1.671, 0.086));
        let eyeball = Transform::from_translation(eye).with_scale(Vec3::splat(0.013));
        ball(&mut skin, eyeball, 20);
        let ear = Transform::from_translation(on(side, Vec3::new(0.08, 1.655, 0.0)))
            .with_rotation(Quat::from_rotation_y(side * 0.35))
            .with_scale(Vec3::new(0.013, 0.034, 0.021));
        ball(&mut skin, ear, 24);
        let [shoulder, elbow, wrist] = [SHOULDER, ELBOW, WRIST].map(|p| on(side, p));
        capsule(&mut skin, (shoulder, 0.05), (elbow, 0.042), 24);
        capsule(&mut skin, (elbow, 0.042), (wrist, 0.028), 24);
        hand(&mut skin, side);
    }
    skin
}

/// The surface of the head: an egg with eye sockets, a mouth and a chin.
fn head(direction: Vec3) -> Vec3 {
    let spot = |towards: Vec3, sharpness: f32| {
        (sharpness * (direction.dot(towards.normalize()) - 1.0)).exp()
    };
    let sockets: f32 = [-1.0, 1.0]
        .map(|side| spot(Vec3::new(0.36 * side, 0.1, 0.93), 45.0))
        .iter()
        .sum();
    let chin = spot(Vec3::new(0.0, -0.8, 0.6), 20.0);
    let from_lips = (direction.y + 0.5) / 0.07;
    let mouth = (-from_lips * from_lips).exp() * smoothstep(0.7, 0.85, direction.z);
    let radius = 1.0 - 0.13 * sockets + 0.07 * chin - 0.04 * mouth;
    let jaw = 1.0 - 0.3 * smoothstep(0.0, 1.0, -direction.y);
    HEAD + HEAD_RADII * direction * radius * Vec3::new(jaw, 1.0, 1.0)
}

/// Adds a hand that hangs down, with its palm to the body.
fn hand(shape: &mut Shape, side: f32) {
    let [elbow, wrist] = [ELBOW, WRIST].map(|p| on(side, p));
    let down = (wrist - elbow).normalize();
    let front = Vec3::Z.reject_from_normalized(down).normalize();
    let inward = down.cross(front) * side;
    for (i, length) in [0.085, 0.095, 0.088, 0.07].into_iter().enumerate() {
        let spread = (1.5 - i as f32) * 0.02;
        let root = wrist + down * 0.015 + front * (spread * 0.6);
        let knuckle = wrist + down * 0.085 + front * spread;
        capsule(shape, (root, 0.016), (knuckle, 0.0125), 16);
        let from = down + front * (spread * 3.0);
        finger(shape, knuckle, (from, inward), (length, 0.0095));
    }
    let root = wrist + down * 0.025 + front * 0.02;
    let from = down * 0.7 + front * 0.7 + inward * 0.2;
    finger(shape, root, (from, down), (0.095, 0.0125));
}

/// Adds a finger of three segments that bends from one direction towards another.
/// `size`: length and radius.
fn finger(shape: &mut Shape, root: Vec3, bend: (Vec3, Vec3), size: (f32, f32)) {
    let (mut start, mut radius) = (root, size.1);
    for (fraction, bent) in [(0.45, 0.1), (0.31, 0.3), (0.24, 0.5)] {
        let end = start + bend.0.lerp(bend.1, bent).normalize() * (size.0 * fraction);
        capsule(shape, (start, radius), (end, radius * 0.88), 12);
        (start, radius) = (end, radius * 0.88);
    }
}

fn shirt() -> Shape {
    let (mut torso, mut shirt) = (Shape::default(), Shape::default());
    let (waist, chest) = (Vec3::new(0.0, 0.98, 0.0), Vec3::new(0.0, 1.3, 0.0));
    capsule(&mut torso, (waist, 0.125), (chest, 0.155), 48);
    shirt.add(&torso, Transform::from_scale(Vec3::new(1.0, 1.0, 0.68)));
    let across = Vec3::new(0.15, 1.385, -0.01);
    capsule(&mut shirt, (on(-1.0, across), 0.06), (across, 0.06), 32);
    for side in [-1.0, 1.0] {
        let sleeve = SHOULDER.lerp(ELBOW, 0.55);
        let (top, end) = (on(side, SHOULDER), on(side, sleeve));
        capsule(&mut shirt, (top, 0.065), (end, 0.057), 32);
    }
    let collar = [(0.075, 1.4), (0.068, 1.475), (0.061, 1.475), (0.061, 1.43)];
    let place = Transform::from_xyz(0.0, 0.0, -0.01);
    shirt.add(&revolve(&turned(&collar), 40), place);
    shirt
}

fn trousers() -> Shape {
    let mut trousers = Shape::default();
    let hips = Transform::from_xyz(0.0, 0.93, 0.0).with_scale(Vec3::new(0.16, 0.11, 0.108));
    ball(&mut trousers, hips, 40);
    for side in [-1.0, 1.0] {
        let [hip, knee, ankle] = [HIP, KNEE, ANKLE].map(|p| on(side, p));
        capsule(&mut trousers, (hip, 0.085), (knee, 0.065), 32);
        capsule(&mut trousers, (knee, 0.065), (ankle, 0.055), 32);
    }
    trousers
}

fn shoes() -> Shape {
    let mut shoes = Shape::default();
    for side in [-1.0, 1.0] {
        let heel = on(side, Vec3::new(0.12, 0.045, -0.04));
        let toe = on(side, Vec3::new(0.145, 0.035, 0.13));
        capsule(&mut shoes, (heel, 0.045), (toe, 0.035), 24);
        let sole = Transform::from_translation(on(side, Vec3::new(0.133, 0.012, 0.045)))
            .with_rotation(Quat::from_rotation_y(side * 0.146))
            .with_scale(Vec3::new(0.05, 0.015, 0.135));
        ball(&mut shoes, sole, 32);
    }
    shoes
}

/// A cap about the head. Below the hairline it is inside the head.
fn hair() -> Shape {
    sculpt(30, |direction| {
        let cover = smoothstep(-0.02, 0.12, 0.75 * direction.y - 0.65 * direction.z);
        let strands = noise3(direction * Vec3::new(9.0, 3.0, 9.0)).abs();
        let radius = 0.8 + cover * (0.28 + 0.05 * strands);
        HEAD + HEAD_RADII * direction * radius
    })
}
