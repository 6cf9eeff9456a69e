//! The solids that the specimens are made of. Their fronts are outside.

use std::f32::consts::{FRAC_PI_2, TAU};

use bevy::{mesh::VertexAttributeValues, prelude::*};

use crate::scenes::shape::Shape;

/// The color of every vertex: a specimen leaves it to the material.
pub const PLAIN: [f32; 4] = [1.0; 4];

/// Adds a flat convex polygon whose front is on the side of `outward`.
pub fn facing(shape: &mut Shape, corners: &[Vec3], outward: Vec3) {
    let normal = (corners[1] - corners[0]).cross(corners[corners.len() - 1] - corners[0]);
    if normal.dot(outward) >= 0.0 {
        shape.polygon(corners, PLAIN);
    } else {
        let reversed: Vec<_> = corners.iter().rev().copied().collect();
        shape.polygon(&reversed, PLAIN);
    }
}

/// Adds a prism: a flat convex outline, moved by `along`.
pub fn extrude(shape: &mut Shape, outline: &[Vec3], along: Vec3) {
    let center = outline.iter().sum::<Vec3>() / outline.len() as f32;
    let far: Vec<_> = outline.iter().map(|p| *p + along).collect();
    facing(shape, outline, -along);
    facing(shape, &far, along);
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let outward = (*a + b) / 2.0 - center;
        facing(shape, &[*a, b, b + along, *a + along], outward);
    }
}

/// Adds a square bar between two points.
pub fn beam(shape: &mut Shape, from: Vec3, to: Vec3, width: f32) {
    let along = to - from;
    let (u, v) = along.normalize().any_orthonormal_pair();
    let (p, q) = ((u + v) * (width / 2.0), (u - v) * (width / 2.0));
    extrude(shape, &[from + p, from + q, from - p, from - q], along);
}

/// A ring of a surface of revolution about the y axis. Both vectors: the part away from
/// the axis, then the part along the axis.
#[derive(Clone, Copy)]
pub struct Ring {
    at: Vec2,
    normal: Vec2,
}

/// Rings on an arc from one latitude to another, radians, about a point of the axis.
fn arc(latitudes: (f32, f32), radius: f32, height: f32, steps: u32) -> impl Iterator<Item = Ring> {
    (0..=steps).map(move |i| {
        let t = i as f32 / steps as f32;
        let normal = Vec2::from_angle(latitudes.0 + (latitudes.1 - latitudes.0) * t);
        Ring {
            at: normal * radius + Vec2::Y * height,
            normal,
        }
    })
}

/// The rings of a turned part with a sharp edge at each corner of its profile. A corner
/// is a radius and a height; the profile runs upwards on the outside.
pub fn turned(profile: &[(f32, f32)]) -> Vec<Ring> {
    let rings = profile.windows(2).flat_map(|ends| {
        let (a, b) = (Vec2::from(ends[0]), Vec2::from(ends[1]));
        let normal = -(b - a).perp().normalize();
        [Ring { at: a, normal }, Ring { at: b, normal }]
    });
    rings.collect()
}

/// A surface of revolution about the y axis.
pub fn revolve(rings: &[Ring], sides: u32) -> Shape {
    let mut shape = Shape::default();
    for ring in rings {
        for i in 0..sides {
            let (sin, cos) = (TAU * i as f32 / sides as f32).sin_cos();
            let turn = |v: Vec2| Vec3::new(v.x * cos, v.y, v.x * sin);
            shape.vertex(turn(ring.at), turn(ring.normal), PLAIN);
        }
    }
    // A ring on the axis is a point, up to rounding.
    let is_wide = |ring: Ring| ring.at.x > 1e-6;
    for (k, pair) in rings.windows(2).enumerate() {
        if pair[0].at == pair[1].at {
            continue;
        }
        let at = |ring: usize, i: u32| (k + ring) as u32 * sides + i % sides;
        for i in 0..sides {
            let (a, b) = (at(0, i), at(0, i + 1));
            let (d, c) = (at(1, i), at(1, i + 1));
            if is_wide(pair[0]) {
                shape.indices.extend([a, c, b]);
            }
            if is_wide(pair[1]) {
                shape.indices.extend([a, d, c]);
            }
        }
    }
    shape
}

/// Adds a unit ball, moved and scaled by `place`.
pub fn ball(shape: &mut Shape, place: Transform, sides: u32) {
    let rings: Vec<_> = arc((-FRAC_PI_2, FRAC_PI_2), 1.0, 0.0, sides / 2).collect();
    shape.add(&revolve(&rings, sides), place);
}

/// Adds two balls and the cone that touches both. An end is a center and a radius; the
/// centers differ.
pub fn capsule(shape: &mut Shape, from: (Vec3, f32), to: (Vec3, f32), sides: u32) {
    let along = to.0 - from.0;
    let length = along.length();
    // The latitude of the circles on which the cone touches the balls.
    let touch = ((from.1 - to.1) / length).clamp(-1.0, 1.0).asin();
    let steps = sides.div_ceil(4);
    let lower = arc((-FRAC_PI_2, touch), from.1, 0.0, steps);
    let upper = arc((touch, FRAC_PI_2), to.1, length, steps);
    let rings: Vec<_> = lower.chain(upper).collect();
    let turn = Quat::from_rotation_arc(Vec3::Y, along / length);
    let place = Transform::from_translation(from.0).with_rotation(turn);
    shape.add(&revolve(&rings, sides), place);
}

/// Adds a round tube along a path, closed at both ends.
pub fn tube(shape: &mut Shape, path: &[Vec3], radius: f32, sides: u32) {
    let first = shape.positions.len() as u32;
    let last = path.len() - 1;
    // The frame is carried along the path, so that the tube does not twist.
    let mut side = (path[1] - path[0]).normalize().any_orthonormal_vector();
    for (i, center) in path.iter().enumerate() {
        let along = (path[(i + 1).min(last)] - path[i.saturating_sub(1)]).normalize();
        side = side.reject_from_normalized(along).normalize();
        let up = along.cross(side);
        for k in 0..sides {
            let (sin, cos) = (TAU * k as f32 / sides as f32).sin_cos();
            let out = side * cos + up * sin;
            shape.vertex(*center + out * radius, out, PLAIN);
        }
    }
    let at = |i: u32, k: u32| first + i * sides + k % sides;
    for i in 0..last as u32 {
        for k in 0..sides {
            let (a, b) = (at(i, k), at(i, k + 1));
            let (d, c) = (at(i + 1, k), at(i + 1, k + 1));
            shape.indices.extend([a, b, c, a, c, d]);
        }
    }
    for (end, beside) in [(0, 1), (last, last - 1)] {
        let ring: Vec<_> = (0..sides)
            .map(|k| Vec3::from(shape.positions[at(end as u32, k) as usize]))
            .collect();
        facing(shape, &ring, path[end] - path[beside]);
    }
}

/// A closed smooth surface of `20 (subdivisions + 1)^2` triangles. `place`: the point of
/// the surface for each direction from its center.
pub fn sculpt(subdivisions: u32, place: impl Fn(Vec3) -> Vec3) -> Shape {
    let sphere = Sphere::new(1.0)
        .mesh()
        .ico(subdivisions)
        .expect("fewer than 80 subdivisions");
    let points: Vec<Vec3> = sphere
        .attribute(Mesh::ATTRIBUTE_POSITION)
        .and_then(VertexAttributeValues::as_float3)
        .expect("the sphere has positions")
        .iter()
        .map(|direction| place(Vec3::from(*direction).normalize()))
        .collect();
    let indices = sphere.indices().expect("the sphere is indexed");
    let corners: Vec<u32> = indices.iter().map(|i| i as u32).collect();
    let (triangles, _) = corners.as_chunks();
    let mut shape = Shape::default();
    shape.smooth(&points, triangles, PLAIN);
    shape
}
