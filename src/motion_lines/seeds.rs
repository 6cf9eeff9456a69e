//! Points on the surface of a mesh.

use bevy::{
    math::{Vec2, Vec3},
    mesh::{Mesh, PrimitiveTopology, VertexAttributeValues},
};

/// A point of a surface, in the space of its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seed {
    pub place: Vec3,
    /// The face's normal.
    pub normal: Vec3,
    /// A number of its own, 0 to 1.
    pub chance: f32,
}

/// Random numbers: the finaliser of `MurmurHash3`, of a counter.
struct Chance(u32);

impl Chance {
    /// Uniform in [0, 1).
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        let mut x = self.0;
        x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
        x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
        ((x ^ (x >> 16)) >> 8) as f32 / (1u32 << 24) as f32
    }
}

/// The triangles of a mesh, and the sum of the areas up to each.
struct Faces {
    corners: Vec<[Vec3; 3]>,
    sums: Vec<f64>,
}

impl Faces {
    /// `None` if the mesh has no faces with an area, or if it cannot be read.
    fn of(mesh: &Mesh) -> Option<Self> {
        if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
            return None;
        }
        let places = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()?;
        let VertexAttributeValues::Float32x3(places) = places else {
            return None;
        };
        let corner = |k: usize| places.get(k).copied().map(Vec3::from);
        let order: Vec<usize> = match mesh.try_indices_option().ok()? {
            Some(list) => list.iter().collect(),
            None => (0..places.len()).collect(),
        };
        let mut faces = Self {
            corners: Vec::new(),
            sums: Vec::new(),
        };
        let mut sum = 0.0;
        for face in order.chunks_exact(3) {
            let (Some(a), Some(b), Some(c)) = (corner(face[0]), corner(face[1]), corner(face[2]))
            else {
                continue;
            };
            let area = f64::from((b - a).cross(c - a).length());
            if area.is_finite() && area > 0.0 {
                sum += area;
                faces.corners.push([a, b, c]);
                faces.sums.push(sum);
            }
        }
        (sum.is_finite() && sum > 0.0).then_some(faces)
    }

    /// A random point, evenly by area.
    fn point(&self, chance: &mut Chance) -> Seed {
        // Two numbers for as many digits as large meshes need.
        let digits = f64::from(chance.next()) + f64::from(chance.next()) / f64::from(1u32 << 24);
        let at = digits * self.sums.last().copied().unwrap_or_default();
        let face = self.sums.partition_point(|sum| *sum <= at);
        let [a, b, c] = self.corners[face.min(self.corners.len() - 1)];
        let mut uv = Vec2::new(chance.next(), chance.next());
        if uv.x + uv.y > 1.0 {
            uv = 1.0 - uv;
        }
        let sides = [b - a, c - a];
        Seed {
            place: a + sides[0] * uv.x + sides[1] * uv.y,
            normal: sides[0].cross(sides[1]).normalize_or(Vec3::Y),
            chance: chance.next(),
        }
    }
}

/// Candidates for each point, of which the one is taken that is farthest from the others.
const CANDIDATES: usize = 12;

/// Points on the surface of a mesh, by area and apart from each other (Mitchell's best candidates).
/// None if the mesh has no triangles, or if it cannot be read.
pub(super) fn seeds_of(mesh: &Mesh, count: u32, seed: u32) -> Vec<Seed> {
    let Some(faces) = Faces::of(mesh) else {
        return Vec::new();
    };
    let mut chance = Chance(seed.wrapping_mul(0x0100_0193));
    let mut seeds: Vec<Seed> = Vec::with_capacity(count as usize);
    for _ in 0..count {
        let distance = |new: &Seed| {
            let all = seeds.iter();
            all.map(|old| old.place.distance_squared(new.place))
                .fold(f32::INFINITY, f32::min)
        };
        let mut best = faces.point(&mut chance);
        let mut farthest = distance(&best);
        for _ in 1..CANDIDATES {
            let new = faces.point(&mut chance);
            let from_others = distance(&new);
            if from_others > farthest {
                (best, farthest) = (new, from_others);
            }
        }
        seeds.push(best);
    }
    seeds
}
