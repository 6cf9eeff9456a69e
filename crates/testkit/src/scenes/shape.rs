//! Meshes from colored primitives.

use bevy::{
    asset::RenderAssetUsages,
    math::Affine3A,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

/// A color in linear RGBA, or an sRGB code.
pub trait Tint {
    fn rgba(self) -> [f32; 4];
}

impl Tint for [f32; 4] {
    fn rgba(self) -> [f32; 4] {
        self
    }
}

impl Tint for u32 {
    fn rgba(self) -> [f32; 4] {
        rgb(self)
    }
}

/// A growing triangle mesh with a color for every vertex.
#[derive(Clone, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    pub colors: Vec<[f32; 4]>,
    pub indices: Vec<u32>,
}

/// Linear RGBA of an sRGB code such as `0xc8413a`.
pub fn rgb(hex: u32) -> [f32; 4] {
    let [_, r, g, b] = hex.to_be_bytes();
    Color::srgb_u8(r, g, b).to_linear().to_f32_array()
}

/// A color times a factor; alpha stays.
pub fn shade(color: [f32; 4], factor: f32) -> [f32; 4] {
    let [r, g, b, a] = color;
    [r * factor, g * factor, b * factor, a]
}

pub fn blend(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t.clamp(0.0, 1.0))
}

impl Shape {
    pub fn into_mesh(self) -> Mesh {
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, self.colors)
        .with_inserted_indices(Indices::U32(self.indices))
    }

    pub fn vertex(&mut self, position: Vec3, normal: Vec3, color: [f32; 4]) -> u32 {
        self.positions.push(position.to_array());
        self.normals.push(normal.to_array());
        self.colors.push(color);
        self.positions.len() as u32 - 1
    }

    /// A flat convex polygon, counter-clockwise as seen from outside.
    pub fn polygon(&mut self, corners: &[Vec3], color: [f32; 4]) {
        let normal = (corners[1] - corners[0])
            .cross(corners[corners.len() - 1] - corners[0])
            .normalize_or(Vec3::Y);
        let first = self.positions.len() as u32;
        for corner in corners {
            self.vertex(*corner, normal, color);
        }
        for i in 2..corners.len() as u32 {
            self.indices.extend([first, first + i - 1, first + i]);
        }
    }

    /// An axis-aligned box between two corners.
    pub fn cuboid(&mut self, low: impl Into<Vec3>, high: impl Into<Vec3>, color: impl Tint) {
        let (low, high, color) = (low.into(), high.into(), color.rgba());
        let p = |x, y, z| Vec3::select(BVec3::new(x, y, z), high, low);
        let (f, t) = (false, true);
        for quad in [
            [p(f, f, t), p(t, f, t), p(t, t, t), p(f, t, t)],
            [p(t, f, f), p(f, f, f), p(f, t, f), p(t, t, f)],
            [p(t, f, t), p(t, f, f), p(t, t, f), p(t, t, t)],
            [p(f, f, f), p(f, f, t), p(f, t, t), p(f, t, f)],
            [p(f, t, t), p(t, t, t), p(t, t, f), p(f, t, f)],
            [p(f, f, f), p(t, f, f), p(t, f, t), p(f, f, t)],
        ] {
            self.polygon(&quad, color);
        }
    }

    /// A box of which `side` (-1 left, 1 right) is where +x is: `low` and `high` are for the right
    /// side.
    pub fn beside(
        &mut self,
        side: f32,
        low: impl Into<Vec3>,
        high: impl Into<Vec3>,
        color: impl Tint,
    ) {
        let [a, b] = [low.into(), high.into()].map(|p| Vec3::new(side * p.x, p.y, p.z));
        self.cuboid(a.min(b), a.max(b), color);
    }

    /// A cone, a cylinder or a frustum that stands on `base`; `radii` at the bottom and
    /// at the top.
    pub fn frustum(
        &mut self,
        base: impl Into<Vec3>,
        height: f32,
        radii: (f32, f32),
        sides: u32,
        color: impl Tint,
    ) {
        let (base, color) = (base.into(), color.rgba());
        let slope = (radii.0 - radii.1) / height;
        let ring = |i: u32, radius: f32, y: f32| {
            let angle = std::f32::consts::TAU * i as f32 / sides as f32;
            base + Vec3::new(radius * angle.cos(), y, radius * angle.sin())
        };
        let normal = |i: f32| {
            let angle = std::f32::consts::TAU * i / sides as f32;
            Vec3::new(angle.cos(), slope, angle.sin()).normalize()
        };
        for i in 0..sides {
            let (n0, n1) = (normal(i as f32), normal(i as f32 + 1.0));
            let a = self.vertex(ring(i, radii.0, 0.0), n0, color);
            let b = self.vertex(ring(i + 1, radii.0, 0.0), n1, color);
            let c = self.vertex(ring(i + 1, radii.1, height), n1, color);
            let d = self.vertex(ring(i, radii.1, height), n0, color);
            self.indices.extend([a, d, c, a, c, b]);
        }
        if radii.1 > 0.0 {
            let top: Vec<_> = (0..sides).rev().map(|i| ring(i, radii.1, height)).collect();
            self.polygon(&top, color);
        }
    }

    /// A cylinder between two points.
    pub fn rod(&mut self, from: Vec3, to: Vec3, radius: f32, sides: u32, color: impl Tint) {
        let along = to - from;
        let mut rod = Shape::default();
        rod.frustum(Vec3::ZERO, along.length(), (radius, radius), sides, color);
        let turn = Quat::from_rotation_arc(Vec3::Y, along.normalize());
        self.add(&rod, Transform::from_translation(from).with_rotation(turn));
    }

    /// An ellipsoid whose radius is scaled by `1 + bump(direction)`.
    pub fn blob(
        &mut self,
        center: impl Into<Vec3>,
        radius: impl Into<Vec3>,
        rings: u32,
        color: impl Fn(Vec3) -> [f32; 4],
        bump: impl Fn(Vec3) -> f32,
    ) {
        let (center, radius) = (center.into(), radius.into());
        let sides = rings * 2;
        let direction = |i: u32, j: u32| {
            let polar = std::f32::consts::PI * i as f32 / rings as f32;
            let around = std::f32::consts::TAU * (j % sides) as f32 / sides as f32;
            let (sin, cos) = (polar.sin(), polar.cos());
            Vec3::new(sin * around.cos(), cos, sin * around.sin())
        };
        let first = self.positions.len() as u32;
        for i in 0..=rings {
            for j in 0..=sides {
                let d = direction(i, j);
                let normal = (d / radius).normalize_or(Vec3::Y);
                self.vertex(center + d * radius * (1.0 + bump(d)), normal, color(d));
            }
        }
        let at = |i: u32, j: u32| first + i * (sides + 1) + j;
        for i in 0..rings {
            for j in 0..sides {
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                self.indices.extend([a, b, c, a, c, d]);
            }
        }
    }

    pub fn ellipsoid(
        &mut self,
        center: impl Into<Vec3>,
        radius: impl Into<Vec3>,
        rings: u32,
        color: impl Tint,
    ) {
        let color = color.rgba();
        self.blob(center, radius, rings, |_| color, |_| 0.0);
    }

    /// The triangles of a grid of vertices from the first one on, with rows of some vertices.
    pub fn grid(&mut self, columns: u32, rows: u32) {
        for j in 0..rows - 1 {
            for i in 0..columns - 1 {
                let a = j * columns + i;
                let b = a + columns;
                self.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
            }
        }
    }

    /// Adds triangles with smooth normals: each vertex has the mean of its triangles, by their
    /// areas.
    pub fn smooth(&mut self, points: &[Vec3], triangles: &[[u32; 3]], color: [f32; 4]) {
        let mut normals = vec![Vec3::ZERO; points.len()];
        for corners in triangles {
            let [a, b, c] = corners.map(|k| points[k as usize]);
            for corner in corners {
                normals[*corner as usize] += (b - a).cross(c - a);
            }
        }
        let first = self.positions.len() as u32;
        for (point, normal) in points.iter().zip(normals) {
            self.vertex(*point, normal.normalize_or(Vec3::Y), color);
        }
        let corners = triangles.as_flattened();
        self.indices.extend(corners.iter().map(|k| first + k));
    }

    /// Adds a transformed copy of another shape.
    pub fn add(&mut self, other: &Shape, transform: Transform) {
        let affine: Affine3A = transform.compute_affine();
        let normals: Mat3A = affine.matrix3.inverse().transpose();
        let first = self.positions.len() as u32;
        let moved = |p: &[f32; 3]| affine.transform_point3(Vec3::from(*p)).to_array();
        let turned = |n: &[f32; 3]| (normals * Vec3::from(*n)).normalize_or(Vec3::Y).to_array();
        self.positions.extend(other.positions.iter().map(moved));
        self.normals.extend(other.normals.iter().map(turned));
        self.colors.extend(&other.colors);
        self.indices.extend(other.indices.iter().map(|i| first + i));
    }
}
