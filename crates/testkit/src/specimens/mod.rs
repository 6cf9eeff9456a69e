//! Models that resemble real assets, for tests of lines. Each fits into the unit sphere
//! about the origin.

mod figure;
mod foliage;
mod hard_surface;
mod organic;
pub(crate) mod solid;
mod stairs;
mod wires;

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

use crate::scenes::shape::Shape;

/// The models, all made by code. The same model has the same vertices in every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Specimen {
    /// The smooth body of an animal with a few deep folds: one closed mesh.
    Organic,
    /// A machined block with chamfers, grooves, a counterbored hole, bosses and bolts.
    HardSurface,
    /// A bush of 400 folded leaves. A leaf has a front on both sides.
    Foliage,
    /// A standing person.
    Figure,
    /// A flight of twelve steps with railings.
    Stairs,
    /// A lattice mast, cables, a coil and a fence.
    Wires,
}

/// The triangles of a part of a specimen and its color as an sRGB code.
type Part = (Shape, u32);

impl Specimen {
    pub const ALL: [Self; 6] = [
        Self::Organic,
        Self::HardSurface,
        Self::Foliage,
        Self::Figure,
        Self::Stairs,
        Self::Wires,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Self::Organic => "organic",
            Self::HardSurface => "hard-surface",
            Self::Foliage => "foliage",
            Self::Figure => "figure",
            Self::Stairs => "stairs",
            Self::Wires => "wires",
        }
    }

    /// The parts: a mesh and its base color. Each becomes an entity at the origin.
    pub fn parts(self) -> Vec<(Mesh, Color)> {
        let mut parts = match self {
            Self::Organic => organic::parts(),
            Self::HardSurface => hard_surface::parts(),
            Self::Foliage => foliage::parts(),
            Self::Figure => figure::parts(),
            Self::Stairs => stairs::parts(),
            Self::Wires => wires::parts(),
        };
        fit(&mut parts);
        let finished = parts.into_iter().map(|(shape, code)| {
            let [_, r, g, b] = code.to_be_bytes();
            (mesh(shape), Color::srgb_u8(r, g, b))
        });
        finished.collect()
    }
}

fn points(parts: &[Part]) -> impl Iterator<Item = Vec3> {
    let positions = parts.iter().flat_map(|(shape, _)| &shape.positions);
    positions.map(|p| Vec3::from(*p))
}

/// Moves the center of the bounding box to the origin and the farthest vertex onto the
/// unit sphere.
fn fit(parts: &mut [Part]) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for point in points(parts) {
        low = low.min(point);
        high = high.max(point);
    }
    let center = (low + high) / 2.0;
    let radius = points(parts)
        .map(|point| point.distance(center))
        .fold(0.0, f32::max);
    for (shape, _) in parts {
        for position in &mut shape.positions {
            *position = ((Vec3::from(*position) - center) / radius).to_array();
        }
    }
}

/// A mesh without the vertex colors of the shape: the color is the material's.
fn mesh(shape: Shape) -> Mesh {
    let uvs = vec![[0.0f32; 2]; shape.positions.len()];
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, shape.positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, shape.normals)
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    .with_inserted_indices(Indices::U32(shape.indices))
}
