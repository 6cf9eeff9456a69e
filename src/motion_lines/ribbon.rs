//! The ribbons of an object.

use bevy::{
    asset::RenderAssetUsages,
    math::{Vec3, Vec3A},
    mesh::{Indices, Mesh, PrimitiveTopology},
};

use super::{MotionLines, seeds::Seed, trail::Trail};

/// The vertices of the ribbons, relative to an origin. Each place of a path has two, one for each
/// side.
#[derive(Default)]
pub(super) struct Ribbons {
    places: Vec<[f32; 3]>,
    /// Direction of the path.
    along: Vec<[f32; 3]>,
    /// The side, -1 or 1, and the width as a fraction of the widest one.
    sides: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Width of a line, by the fraction of its length from the tail (0) to the head (1).
pub(super) fn taper(t: f32) -> f32 {
    let tail = t.clamp(0.0, 1.0).powf(0.8);
    tail * (1.0 - smoothstep(0.85, 1.0, t)).max(0.12)
}

/// How wide the line of a point is by its speed, and by the cosine between the normal and the
/// movement: at the back it is -1.
pub(super) fn strength(speed: f32, min_speed: f32, facing: f32) -> f32 {
    smoothstep(0.8, 1.2, speed / min_speed) * smoothstep(0.05, 0.35, -facing)
}

impl Ribbons {
    /// The ribbons of this moment. `origin`: what their places are relative to.
    pub fn new(lines: &MotionLines, trail: &Trail, origin: Vec3) -> Self {
        let mut ribbons = Self::default();
        for seed in &trail.seeds {
            ribbons.add(lines, trail, seed, origin.into());
        }
        ribbons
    }

    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    fn add(&mut self, lines: &MotionLines, trail: &Trail, seed: &Seed, origin: Vec3A) {
        let Some(now) = trail.poses().back() else {
            return;
        };
        let duration = f64::from(lines.duration);
        let tail = now.time - duration * f64::from(1.0 - lines.variation * seed.chance);
        let head = now.time - duration * f64::from(lines.gap);
        let path = trail.path(seed, tail, head);
        let lengths = lengths(&path);
        let Some(&length) = lengths.last() else {
            return;
        };
        let normal = normal_in_world(now.world_from_mesh.matrix3, seed.normal);
        let facing = normal.dot(trail.last_step(seed).normalize_or_zero());
        let speed = length / (head - tail) as f32;
        let strength = strength(speed, lines.min_speed, facing);
        if length.is_nan() || length <= 0.0 || strength <= 0.0 {
            return;
        }
        let first = self.places.len() as u32;
        for (k, place) in path.iter().enumerate() {
            let before = path[k.saturating_sub(1)];
            let after = path[(k + 1).min(path.len() - 1)];
            let along = (after - before).normalize_or_zero();
            let width = strength * taper(lengths[k] / length);
            for side in [-1.0, 1.0] {
                self.places.push((*place - origin).to_array());
                self.along.push(along.to_array());
                self.sides.push([side, width]);
            }
        }
        for k in 0..path.len() as u32 - 1 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|corner| first + 2 * k + corner);
            self.indices.extend([a, b, c, b, d, c]);
        }
    }

    pub fn put_into(self, mesh: &mut Mesh) {
        mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, self.places);
        mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, self.along);
        mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, self.sides);
        mesh.insert_indices(Indices::U32(self.indices));
    }

    pub fn into_mesh(self) -> Mesh {
        let usage = RenderAssetUsages::default();
        let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, usage);
        self.put_into(&mut mesh);
        mesh
    }
}

/// Length of a path up to each of its places.
fn lengths(path: &[Vec3A]) -> Vec<f32> {
    let mut sum = 0.0;
    let mut before = path.first().copied();
    let length = |place: &Vec3A| {
        sum += before.map_or(0.0, |before| before.distance(*place));
        before = Some(*place);
        sum
    };
    path.iter().map(length).collect()
}

/// A normal in the world, also of objects with different scales along their axes.
fn normal_in_world(world_from_mesh: bevy::math::Mat3A, normal: Vec3) -> Vec3A {
    let columns = [
        world_from_mesh.x_axis,
        world_from_mesh.y_axis,
        world_from_mesh.z_axis,
    ];
    let [x, y, z] = columns;
    // The matrix of cofactors, which also exists for flat objects.
    let turned = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
    (turned * world_from_mesh.determinant().signum()).normalize_or_zero()
}
