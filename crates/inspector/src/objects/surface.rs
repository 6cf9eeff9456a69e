//! The triangles of a mesh where they are drawn.

use bevy::{
    math::{Mat4, Vec3},
    mesh::{Mesh, PrimitiveTopology, VertexAttributeValues},
};

use super::ray::{Ray, Sides};

/// The triangles of a mesh.
pub struct Surface {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    /// Whether the winding of all triangles is known.
    has_sides: bool,
}

/// What the main world knows of a mesh.
pub enum Known {
    Surface(Surface),
    /// The mesh has no triangles.
    Nothing,
    /// The mesh is only on the GPU.
    Bounds,
}

impl Known {
    /// `joints`: the matrices of a skinned mesh, from the mesh into the world. Morphed meshes
    /// count as they are at rest.
    pub fn of(mesh: &Mesh, joints: Option<&[Mat4]>) -> Self {
        let Ok(positions) = mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION) else {
            return Self::Bounds;
        };
        let Some(VertexAttributeValues::Float32x3(positions)) = positions else {
            return Self::Nothing;
        };
        let positions: Vec<Vec3> = positions.iter().copied().map(Vec3::from).collect();
        let indices: Vec<u32> = match mesh.try_indices_option() {
            Ok(Some(indices)) => indices.iter().map(|i| i as u32).collect(),
            Ok(None) => (0..positions.len() as u32).collect(),
            Err(_) => return Self::Bounds,
        };
        let (triangles, has_sides) = match mesh.primitive_topology() {
            PrimitiveTopology::TriangleList => (indices.as_chunks::<3>().0.to_vec(), true),
            PrimitiveTopology::TriangleStrip => (indices.array_windows().copied().collect(), false),
            _ => return Self::Nothing,
        };
        let positions = match joints {
            Some(joints) => skinned(mesh, positions, joints),
            None => positions,
        };
        Self::Surface(Surface {
            positions,
            triangles,
            has_sides,
        })
    }
}

/// The places of vertices by their joints. Vertices without joints stay where they are.
fn skinned(mesh: &Mesh, positions: Vec<Vec3>, joints: &[Mat4]) -> Vec<Vec3> {
    let (
        Ok(Some(VertexAttributeValues::Uint16x4(indices))),
        Ok(Some(VertexAttributeValues::Float32x4(weights))),
    ) = (
        mesh.try_attribute_option(Mesh::ATTRIBUTE_JOINT_INDEX),
        mesh.try_attribute_option(Mesh::ATTRIBUTE_JOINT_WEIGHT),
    )
    else {
        return positions;
    };
    let skin = indices.iter().zip(weights);
    let place = |(position, (indices, weights)): (&Vec3, (&[u16; 4], &[f32; 4]))| {
        let joint = |i: u16| {
            joints
                .get(usize::from(i))
                .copied()
                .unwrap_or(Mat4::IDENTITY)
        };
        indices
            .iter()
            .zip(weights)
            .map(|(i, weight)| *weight * joint(*i).transform_point3(*position))
            .sum()
    };
    positions.iter().zip(skin).map(place).collect()
}

impl Surface {
    /// The distance at which a ray in the space of the surface meets it first.
    pub fn meets(&self, ray: Ray, sides: Sides) -> Option<f64> {
        let sides = if self.has_sides { sides } else { Sides::Both };
        let corners = |t: &[u32; 3]| {
            let corner = |i: u32| self.positions.get(i as usize).copied();
            Some([corner(t[0])?, corner(t[1])?, corner(t[2])?])
        };
        self.triangles
            .iter()
            .filter_map(|t| ray.meets(corners(t)?, sides))
            .min_by(f64::total_cmp)
    }

    /// Center and half size of the box around all vertices.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let low = self.positions.iter().copied().reduce(Vec3::min)?;
        let high = self.positions.iter().copied().reduce(Vec3::max)?;
        Some((0.5 * (low + high), 0.5 * (high - low)))
    }
}
