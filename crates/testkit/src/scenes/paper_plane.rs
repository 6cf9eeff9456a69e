//! A paper plane, which the game and the comic page share.

use bevy::{mesh::PrimitiveTopology, prelude::*};

/// A paper plane: two slightly raised wings, and between them a red keel, which makes the
/// plane easy to see in every style.
pub fn paper_plane() -> Mesh {
    const PAPER: [f32; 4] = [1.0, 0.98, 0.92, 1.0];
    const RED: [f32; 4] = [0.85, 0.08, 0.06, 1.0];
    let v = Vec3::new;
    let nose = v(0.0, 0.0, -1.9);
    let (left, right) = (v(-1.45, 0.5, 1.15), v(1.45, 0.5, 1.15));
    let (inner_left, inner_right) = (v(-0.16, 0.05, 1.3), v(0.16, 0.05, 1.3));
    let (tip_left, tip_right) = (v(-1.5, 0.85, 1.2), v(1.5, 0.85, 1.2));
    let keel = v(0.0, -0.65, 1.1);
    let triangles = [
        ([nose, left, inner_left], PAPER),
        ([nose, inner_right, right], PAPER),
        // The tips are folded up.
        ([nose.lerp(left, 0.55), tip_left, left], RED),
        ([nose.lerp(right, 0.55), right, tip_right], RED),
        ([nose, inner_left, keel], RED),
        ([nose, keel, inner_right], RED),
    ];
    let corners = |(triangle, color): &([Vec3; 3], [f32; 4])| triangle.map(|at| (at, *color));
    let (positions, colors): (Vec<[f32; 3]>, Vec<[f32; 4]>) = triangles
        .iter()
        .flat_map(corners)
        .map(|(at, color)| (at.to_array(), color))
        .unzip();
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors);
    mesh.compute_flat_normals();
    mesh
}
