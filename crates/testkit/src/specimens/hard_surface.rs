//! A machine part: a block with chamfers, grooves and a counterbored hole, on it bosses
//! and hex bolts.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::prelude::*;

use super::{
    Part,
    solid::{extrude, facing, revolve, turned},
};
use crate::scenes::shape::Shape;

/// Half the size of the block on each axis.
const HALF: [f32; 3] = [1.0, 0.45, 0.7];

/// Where the faces are cut on each axis. The ends are the inner edges of the chamfers;
/// neighboring faces share the cuts, so that no vertex is on the side of a triangle.
const CUTS: [&[f32]; 3] = [
    &[-0.95, -0.8, -0.76, 0.06, 0.1, 0.2, 0.8, 0.95],
    &[-0.4, -0.22, -0.18, 0.18, 0.22, 0.4],
    &[-0.65, -0.54, -0.5, -0.3, 0.3, 0.5, 0.54, 0.65],
];

/// The first and the last cell, on each axis, of the groove about the panel of a face.
const PANEL: [(usize, usize); 3] = [(1, 3), (1, 3), (1, 5)];

/// Depth of a groove: 1.5 % of the length of the block.
const GROOVE: f32 = 0.03;

/// The cell of the top face with the hole, on the z axis and on the x axis.
const HOLE: (usize, usize) = (3, 5);

/// A flange, a boss with a chamfer and a bore: radius and height.
const BOSS: [(f32, f32); 9] = [
    (0.36, -0.02),
    (0.36, 0.045),
    (0.345, 0.06),
    (0.22, 0.06),
    (0.22, 0.31),
    (0.19, 0.34),
    (0.12, 0.34),
    (0.12, 0.15),
    (0.0, 0.15),
];

pub(super) fn parts() -> Vec<Part> {
    let mut block = Shape::default();
    for axis in 0..3 {
        face(&mut block, axis, -1.0);
        face(&mut block, axis, 1.0);
        chamfers(&mut block, axis);
    }
    corners(&mut block);

    let boss = revolve(&turned(&BOSS), 48);
    let mut flange_bolts = Shape::default();
    for i in 0..6 {
        let (sin, cos) = (TAU * (i as f32 + 0.5) / 6.0).sin_cos();
        bolt(&mut flange_bolts, Vec3::new(0.29 * cos, 0.06, 0.29 * sin));
    }
    let small = |position: [f32; 3], turn: Quat| {
        let at = Transform::from_translation(position.into()).with_rotation(turn);
        at.with_scale(Vec3::splat(0.45))
    };
    let (about_x, about_z) = (Quat::from_rotation_x, Quat::from_rotation_z);
    let (mut bosses, mut bolts) = (Shape::default(), Shape::default());
    for place in [
        Transform::from_xyz(-0.35, HALF[1], 0.0),
        small([-0.35, 0.0, HALF[2]], about_x(FRAC_PI_2)),
        small([-0.35, 0.0, -HALF[2]], about_x(-FRAC_PI_2)),
        small([HALF[0], 0.0, 0.0], about_z(-FRAC_PI_2)),
    ] {
        bosses.add(&boss, place);
        bolts.add(&flange_bolts, place);
    }
    for (x, z) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        bolt(&mut bolts, Vec3::new(0.875 * x, HALF[1], 0.595 * z));
    }
    vec![(block, 0x6f8ba3), (bosses, 0x4b5560), (bolts, 0xc9a24b)]
}

/// Adds the head of a hex bolt on a horizontal plane.
fn bolt(shape: &mut Shape, foot: Vec3) {
    let outline: [Vec3; 6] = std::array::from_fn(|i| {
        let (sin, cos) = (TAU * i as f32 / 6.0).sin_cos();
        foot + Vec3::new(0.042 * cos, -0.01, 0.042 * sin)
    });
    extrude(shape, &outline, Vec3::Y * 0.055);
}

/// Adds a face of the block without its chamfers, cell by cell.
fn face(shape: &mut Shape, axis: usize, sign: f32) {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let out = Vec3::AXES[axis] * sign;
    let point = |a: f32, b: f32, depth: f32| {
        Vec3::AXES[u] * a + Vec3::AXES[v] * b + out * (HALF[axis] - depth)
    };
    let depth_of = |i: usize, j: usize| {
        let ((u0, u1), (v0, v1)) = (PANEL[u], PANEL[v]);
        let is_inside = (u0..=u1).contains(&i) && (v0..=v1).contains(&j);
        let is_rim = i == u0 || i == u1 || j == v0 || j == v1;
        if is_inside && is_rim { GROOVE } else { 0.0 }
    };
    for i in 0..CUTS[u].len() - 1 {
        for j in 0..CUTS[v].len() - 1 {
            let (a, b) = (&CUTS[u][i..i + 2], &CUTS[v][j..j + 2]);
            let depth = depth_of(i, j);
            let cell = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(k, l)| point(a[k], b[l], depth));
            if axis == 1 && sign > 0.0 && (i, j) == HOLE {
                counterbore(shape, cell, out);
            } else {
                facing(shape, &cell, out);
            }
            // Walls to the next cell on either axis.
            for (next, edge, along) in [
                (depth_of(i + 1, j), [(1, 0), (1, 1)], Vec3::AXES[u]),
                (depth_of(i, j + 1), [(0, 1), (1, 1)], Vec3::AXES[v]),
            ] {
                if next != depth {
                    let [p, q] = edge.map(|(k, l)| point(a[k], b[l], depth));
                    let [r, s] = edge.map(|(k, l)| point(a[k], b[l], next));
                    facing(shape, &[p, q, s, r], along * (next - depth));
                }
            }
        }
    }
}

/// Adds what fills a square cell with an octagonal recess, in its floor a deeper hole.
fn counterbore(shape: &mut Shape, cell: [Vec3; 4], out: Vec3) {
    let center = cell.iter().sum::<Vec3>() / 4.0;
    let right = (cell[1] - cell[0]).normalize();
    let up = (cell[3] - cell[0]).normalize();
    // Side k of the cell is opposite to the octagon's side from corner 2 k.
    let octagon = |radius: f32, depth: f32| -> [Vec3; 8] {
        std::array::from_fn(|n| {
            let (sin, cos) = (247.5 + 45.0 * n as f32).to_radians().sin_cos();
            center + (right * cos + up * sin) * radius - out * depth
        })
    };
    let rims = [(0.27, 0.0), (0.27, 0.14), (0.15, 0.14), (0.15, 0.5)]
        .map(|(radius, depth)| octagon(radius, depth));
    let rim = rims[0];
    for k in 0..4 {
        let (corner, next) = (cell[k], cell[(k + 1) % 4]);
        facing(shape, &[corner, next, rim[2 * k + 1], rim[2 * k]], out);
        facing(shape, &[next, rim[(2 * k + 2) % 8], rim[2 * k + 1]], out);
    }
    for n in 0..8 {
        let m = (n + 1) % 8;
        let inwards = center - (rim[n] + rim[m]) / 2.0;
        for (pair, front) in rims.windows(2).zip([inwards, out, inwards]) {
            let quad = [pair[0][n], pair[0][m], pair[1][m], pair[1][n]];
            facing(shape, &quad, front);
        }
    }
    facing(shape, &rims[3], out);
}

/// The place of the inner edge of a chamfer on an axis.
fn inset(axis: usize) -> f32 {
    CUTS[axis][CUTS[axis].len() - 1]
}

/// Adds the four chamfers along an axis.
fn chamfers(shape: &mut Shape, axis: usize) {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let (x, y) = (Vec3::AXES[u] * x, Vec3::AXES[v] * y);
        let (on_u, on_v) = (x * HALF[u] + y * inset(v), x * inset(u) + y * HALF[v]);
        for cut in CUTS[axis].windows(2) {
            let (low, high) = (Vec3::AXES[axis] * cut[0], Vec3::AXES[axis] * cut[1]);
            let quad = [on_u + low, on_u + high, on_v + high, on_v + low];
            facing(shape, &quad, x + y);
        }
    }
}

/// Adds the triangles between the chamfers.
fn corners(shape: &mut Shape) {
    for corner in 0..8u32 {
        let sign: [f32; 3] = [1, 2, 4].map(|bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 });
        let sign = Vec3::from_array(sign);
        let inner = Vec3::new(inset(0), inset(1), inset(2));
        let triangle = [0, 1, 2].map(|axis: usize| {
            let mut point = inner;
            point[axis] = HALF[axis];
            point * sign
        });
        facing(shape, &triangle, sign);
    }
}
