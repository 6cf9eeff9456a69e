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

/// The triangles of a part of a specimen and its colour as an sRGB code.
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

    /// The parts: a mesh and its base colour. Each becomes an entity at the origin.
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

/// Moves the centre of the bounding box to the origin and the farthest vertex onto the
/// unit sphere.
fn fit(parts: &mut [Part]) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for point in points(parts) {
        low = low.min(point);
        high = high.max(point);
    }
    let centre = (low + high) / 2.0;
    let radius = points(parts)
        .map(|point| point.distance(centre))
        .fold(0.0, f32::max);
    for (shape, _) in parts {
        for position in &mut shape.positions {
            *position = ((Vec3::from(*position) - centre) / radius).to_array();
        }
    }
}

/// A mesh without the vertex colours of the shape: the colour is the material's.
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

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use bevy::mesh::{MeshVertexAttribute, VertexAttributeValues};

    use super::*;

    fn vectors(mesh: &Mesh, attribute: MeshVertexAttribute) -> Vec<Vec3> {
        mesh.attribute(attribute)
            .and_then(VertexAttributeValues::as_float3)
            .expect("an attribute of three floats")
            .iter()
            .map(|v| Vec3::from(*v))
            .collect()
    }

    fn triangles(mesh: &Mesh) -> Vec<[usize; 3]> {
        let indices: Vec<_> = mesh.indices().expect("indices").iter().collect();
        assert_eq!(indices.len() % 3, 0);
        let corners = indices.chunks_exact(3);
        corners.map(|c| [c[0], c[1], c[2]]).collect()
    }

    fn all_meshes() -> impl Iterator<Item = (&'static str, Mesh)> {
        Specimen::ALL.into_iter().flat_map(|specimen| {
            let parts = specimen.parts().into_iter();
            parts.map(move |(mesh, _)| (specimen.name(), mesh))
        })
    }

    #[test]
    fn specimens_fit_into_the_unit_sphere() {
        // The subtraction, the division and the measured radius are each a few half
        // ulps off.
        let limit = 1.0 + 8.0 * f32::EPSILON;
        for (name, mesh) in all_meshes() {
            for position in vectors(&mesh, Mesh::ATTRIBUTE_POSITION) {
                assert!(position.is_finite(), "{name}: {position}");
                assert!(position.length() <= limit, "{name}: {position}");
            }
        }
    }

    #[test]
    fn normals_are_unit_vectors() {
        // A normal on a tube is the sum of two products of rounded unit vectors.
        let tolerance = 16.0 * f32::EPSILON;
        for (name, mesh) in all_meshes() {
            let normals = vectors(&mesh, Mesh::ATTRIBUTE_NORMAL);
            assert_eq!(normals.len(), mesh.count_vertices(), "{name}");
            for normal in normals {
                let error = (normal.length() - 1.0).abs();
                assert!(error <= tolerance, "{name}: {normal}");
            }
        }
    }

    #[test]
    fn indices_are_in_range() {
        for (name, mesh) in all_meshes() {
            let (count, triangles) = (mesh.count_vertices(), triangles(&mesh));
            assert!(!triangles.is_empty(), "{name}");
            assert!(triangles.iter().flatten().all(|i| *i < count), "{name}");
        }
    }

    #[test]
    fn fronts_are_on_the_side_of_the_normals() {
        for (name, mesh) in all_meshes() {
            let positions = vectors(&mesh, Mesh::ATTRIBUTE_POSITION);
            let normals = vectors(&mesh, Mesh::ATTRIBUTE_NORMAL);
            let triangles = triangles(&mesh);
            let agree = triangles.iter().filter(|corners| {
                let [a, b, c] = corners.map(|i| positions[i]);
                let normal: Vec3 = corners.iter().map(|i| normals[*i]).sum();
                (b - a).cross(c - a).dot(normal) > 0.0
            });
            let (agree, total) = (agree.count(), triangles.len());
            assert!(
                agree as f32 > 0.999 * total as f32,
                "{name}: {agree} of {total}"
            );
        }
    }

    #[test]
    fn the_organic_surface_is_closed() {
        for (mesh, _) in Specimen::Organic.parts() {
            let edges: HashSet<_> = triangles(&mesh)
                .into_iter()
                .flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)])
                .collect();
            assert!(edges.iter().all(|(a, b)| edges.contains(&(*b, *a))));
        }
    }

    #[test]
    fn a_specimen_is_the_same_every_time() {
        for (first, second) in all_meshes().zip(all_meshes()) {
            let [first, second] =
                [first.1, second.1].map(|mesh| vectors(&mesh, Mesh::ATTRIBUTE_POSITION));
            assert_eq!(first, second);
        }
    }
}
