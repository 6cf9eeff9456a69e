//! The vertices of a spawned model in world space, skinned ones in their pose.

use bevy::{
    mesh::{
        MeshVertexAttribute, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};

/// Positions of all vertices that a triangle, line or point uses. Morph targets
/// are left out.
pub fn collect(
    entities: Query<(&Mesh3d, &GlobalTransform, Option<&SkinnedMesh>)>,
    joints: Query<&GlobalTransform>,
    meshes: Res<Assets<Mesh>>,
    inverse_bindposes: Res<Assets<SkinnedMeshInverseBindposes>>,
) -> Vec<Vec3> {
    let mut points = Vec::new();
    for (mesh, transform, skin) in &entities {
        let Some(mesh) = meshes.get(&mesh.0) else {
            continue;
        };
        let pose = skin.and_then(|skin| {
            let inverse = inverse_bindposes.get(&skin.inverse_bindposes)?;
            let matrices = skin.joints.iter().zip(inverse.iter());
            matrices
                .map(|(joint, inverse)| Some(joints.get(*joint).ok()?.to_matrix() * *inverse))
                .collect::<Option<Vec<Mat4>>>()
        });
        add(&mut points, mesh, &transform.to_matrix(), pose.as_deref());
    }
    points
}

fn add(points: &mut Vec<Vec3>, mesh: &Mesh, world_from_local: &Mat4, pose: Option<&[Mat4]>) {
    let attribute = |id: MeshVertexAttribute| mesh.try_attribute_option(id).ok().flatten();
    let Some(VertexAttributeValues::Float32x3(positions)) = attribute(Mesh::ATTRIBUTE_POSITION)
    else {
        return;
    };
    let skin = match (
        pose,
        attribute(Mesh::ATTRIBUTE_JOINT_INDEX),
        attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT),
    ) {
        (
            Some(pose),
            Some(VertexAttributeValues::Uint16x4(indices)),
            Some(VertexAttributeValues::Float32x4(weights)),
        ) => Some((pose, indices, weights)),
        _ => None,
    };
    let mut used = vec![false; positions.len()];
    match mesh.try_indices_option().ok().flatten() {
        Some(indices) => {
            for index in indices.iter().filter(|index| *index < positions.len()) {
                used[index] = true;
            }
        }
        None => used.fill(true),
    }
    for (vertex, _) in used.iter().enumerate().filter(|(_, used)| **used) {
        let position = Vec3::from(positions[vertex]);
        let posed = skin.as_ref().and_then(|(pose, indices, weights)| {
            let (indices, weights) = (indices.get(vertex)?, weights.get(vertex)?);
            let parts = indices.iter().zip(weights);
            parts
                .map(|(joint, weight)| {
                    let matrix = pose.get(usize::from(*joint))?;
                    Some(matrix.transform_point3(position) * *weight)
                })
                .sum::<Option<Vec3>>()
        });
        points.push(posed.unwrap_or_else(|| world_from_local.transform_point3(position)));
    }
}
