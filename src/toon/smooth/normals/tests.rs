use bevy::{
    asset::RenderAssetUsages,
    math::primitives::{Cuboid, Sphere},
    mesh::{Indices, MeshBuilder, Meshable, PlaneMeshBuilder},
};

use super::*;

/// A cube from -1 to 1 whose faces have `n` squares along each edge and vertices of their own.
fn cube(n: u32) -> Mesh {
    let face = |axis: usize, sign: f32| {
        let mut mesh = PlaneMeshBuilder::default()
            .size(2.0, 2.0)
            .subdivisions(n - 1)
            .build()
            .translated_by(Vec3::Y);
        let turn = bevy::math::Quat::from_rotation_arc(
            Vec3::Y,
            Vec3::from_array(std::array::from_fn(|k| if k == axis { sign } else { 0.0 })),
        );
        mesh.rotate_by(turn);
        mesh
    };
    let mut whole = face(0, 1.0);
    for (axis, sign) in [(0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
        whole.merge(&face(axis, sign)).expect("equal attributes");
    }
    whole
}

fn faces(mesh: &Mesh) -> Faces {
    Faces::of(mesh).expect("a mesh with normals")
}

fn positions(mesh: &Mesh) -> Vec<Vec3> {
    let faces = faces(mesh);
    faces.positions.into_iter().map(Vec3::from_array).collect()
}

/// Sum over the triangles of what normals differ along their edges.
fn roughness(faces: &Faces, normals: &[Vec3]) -> f64 {
    let edge = |a: u32, b: u32| {
        let far = normals[a as usize] - normals[b as usize];
        f64::from(far.length_squared())
    };
    let all = faces.triangles.iter();
    all.map(|[a, b, c]| edge(*a, *b) + edge(*b, *c) + edge(*c, *a))
        .sum()
}

/// Truth: a cube becomes a ball. With each round its normals vary less from vertex to vertex, and
/// they come nearer to those of a ball, until they are.
#[test]
fn cubes_become_rounder_with_each_round() {
    let mesh = cube(8);
    let faces = faces(&mesh);
    let ball: Vec<Vec3> = positions(&mesh).iter().map(|p| p.normalize()).collect();
    let off = |normals: &[Vec3]| {
        let pairs = normals.iter().zip(&ball);
        let all = pairs.map(|(n, b)| f64::from((*n - *b).length_squared()));
        all.sum::<f64>() / ball.len() as f64
    };
    let mut last = [f64::INFINITY; 2];
    for rounds in 0..=10 {
        let normals = faces.smoothed(rounds);
        let found = [roughness(&faces, &normals), off(&normals)];
        println!("{rounds} rounds: {found:?}");
        assert!(
            found[0] < last[0] && found[1] < last[1],
            "{rounds}: {found:?}, {last:?}"
        );
        last = found;
    }
}

/// Truth: a ball is as smooth as it can be.
#[test]
fn balls_keep_their_normals() {
    let ball = Sphere::new(3.0).mesh();
    for mesh in [ball.ico(24).expect("few enough"), ball.uv(96, 48)] {
        let faces = faces(&mesh);
        for rounds in [0, 1, 5, 20] {
            let pairs = faces.smoothed(rounds).into_iter().zip(positions(&mesh));
            let off = pairs.map(|(n, p)| (n - p.normalize()).length());
            let most = off.fold(0.0, f32::max);
            println!(
                "{} vertices, {rounds} rounds: {most}",
                faces.positions.len()
            );
            assert!(most < 1e-3, "{rounds} rounds: {most}");
        }
    }
}

/// Truth: without rounds, a normal is the mean of those of all triangles at its place, weighted by
/// their angles there, found by comparing all vertices with all triangles.
#[test]
fn without_rounds_normals_are_weighted_by_angles() {
    let ball = Sphere::new(1.0).mesh().uv(9, 5);
    let stretched = ball.scaled_by(Vec3::new(1.0, 3.0, 0.5));
    for mesh in [cube(2), stretched, Cuboid::new(1.0, 2.0, 3.0).into()] {
        let faces = faces(&mesh);
        let p = positions(&mesh);
        let normals = faces.smoothed(0);
        for (vertex, at) in p.iter().enumerate() {
            let mut sum = Vec3::ZERO;
            for triangle in &faces.triangles {
                let [a, b, c] = triangle.map(|v| p[v as usize]);
                for [here, x, y] in [[a, b, c], [b, c, a], [c, a, b]] {
                    let normal = (x - here).cross(y - here);
                    if here.distance(*at) < 1e-4 && normal.length() > 1e-9 {
                        let [x, y] = [x - here, y - here].map(Vec3::normalize);
                        sum += normal.normalize() * x.dot(y).clamp(-1.0, 1.0).acos();
                    }
                }
            }
            let off = (sum.normalize() - normals[vertex]).length();
            // The arc cosine of a sum of three products in single precision, up to seven times.
            assert!(off < 1e-4, "{at}: {}, not {sum}", normals[vertex]);
        }
    }
}

/// Truth: nothing tells the two sides of a seam apart, also if they are not quite at one place.
#[test]
fn seams_are_closed() {
    let ball = Sphere::new(1.0).mesh().uv(24, 12);
    let mut torn = cube(4);
    if let Some(VertexAttributeValues::Float32x3(at)) = torn.attribute_mut(Mesh::ATTRIBUTE_POSITION)
    {
        for (k, p) in at.iter_mut().enumerate() {
            // A sixth of what counts as one place: two of it apart at most.
            p[k % 3] += 5e-6 * ((k % 7) as f32 / 3.0 - 1.0);
        }
    }
    for mesh in [ball, torn] {
        for rounds in [0, 1, 8] {
            let normals = faces(&mesh).smoothed(rounds);
            let p = positions(&mesh);
            let mut pairs = 0;
            for a in 0..p.len() {
                for b in 0..a {
                    if p[a].distance(p[b]) < 2e-5 {
                        pairs += 1;
                        assert!(
                            (normals[a] - normals[b]).length() < 1e-6,
                            "{}, {}",
                            p[a],
                            p[b]
                        );
                    }
                }
            }
            assert!(pairs > 20, "{pairs}");
        }
    }
}

fn assert_alike(found: &[Vec3], wanted: &[Vec3]) {
    assert_eq!(found.len(), wanted.len());
    for (a, b) in found.iter().zip(wanted) {
        assert!((*a - *b).length() < 1e-6, "{a}, not {b}");
    }
}

/// Normals do not depend on the size of a mesh, nor on which way its triangles are wound.
#[test]
fn size_and_winding_do_not_matter() {
    let mesh = cube(3);
    let wanted = faces(&mesh).smoothed(3);
    for scale in [1e-12, 1e12] {
        let found = faces(&mesh.clone().scaled_by(Vec3::splat(scale))).smoothed(3);
        assert_alike(&found, &wanted);
    }
    let mut turned = faces(&mesh);
    for triangle in &mut turned.triangles {
        triangle.swap(0, 1);
    }
    assert_alike(&turned.smoothed(3), &wanted);
}

/// Strips and meshes without indices are the same as those with.
#[test]
fn all_kinds_of_triangles_are_read() {
    let mut flat = cube(2);
    let wanted = faces(&flat).smoothed(2);
    let Some(Indices::U32(corners)) = flat.indices().cloned() else {
        panic!("32-bit indices");
    };
    flat.duplicate_vertices();
    let found = faces(&flat).smoothed(2);
    assert_eq!(found.len(), corners.len());
    for (normal, corner) in found.iter().zip(&corners) {
        assert!((*normal - wanted[*corner as usize]).length() < 1e-6);
    }
    let strip = |topology| {
        let at = vec![
            [0.0f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [1.0, 1.0, 1.0],
        ];
        Mesh::new(topology, RenderAssetUsages::all())
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![[0.0f32, 0.0, 1.0]; 4])
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, at)
    };
    let list = strip(PrimitiveTopology::TriangleList)
        .with_inserted_indices(Indices::U16(vec![0, 1, 2, 2, 1, 3]));
    let strip_faces = faces(&strip(PrimitiveTopology::TriangleStrip));
    assert_alike(&strip_faces.smoothed(4), &faces(&list).smoothed(4));
    let lines = Faces::of(&strip(PrimitiveTopology::LineList));
    assert_eq!(lines.err(), Some(Unsmoothed::NoTriangles));
}

/// Whatever a mesh has, its normals have unit length. Where nothing else is known, they are its
/// own.
#[test]
fn strange_meshes_have_normals() {
    let up = [0.0, 1.0, 0.0];
    let down = [0.0, -1.0, 0.0];
    let corner = |x: f32, z: f32| [x, 0.0, z];
    // Both sides of a leaf, a triangle without area, one that is not finite, one that does not
    // exist, and a vertex alone.
    let leaf = Faces {
        positions: vec![
            corner(0.0, 0.0),
            corner(0.0, 1.0),
            corner(1.0, 0.0),
            corner(0.0, 0.0),
            corner(0.0, 1.0),
            corner(1.0, 0.0),
            corner(5.0, 5.0),
            corner(f32::NAN, f32::INFINITY),
        ],
        normals: vec![up, up, up, down, down, down, [0.0; 3], [f32::NAN; 3]],
        triangles: vec![[0, 1, 2], [3, 5, 4], [0, 0, 1], [0, 1, 7], [0, 1, 99]],
    };
    for rounds in [0, 3] {
        let found = leaf.smoothed(rounds);
        assert!(
            found.iter().all(|n| (n.length() - 1.0).abs() < 1e-6),
            "{found:?}"
        );
        assert!(found[..3].iter().all(|n| *n == Vec3::Y));
        assert!(found[3..6].iter().all(|n| *n == Vec3::NEG_Y));
    }
    let none = Faces {
        positions: vec![],
        normals: vec![],
        triangles: vec![[0, 1, 2]],
    };
    assert!(none.smoothed(5).is_empty());
    let bare = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::all());
    assert_eq!(Faces::of(&bare).err(), Some(Unsmoothed::NoNormals));
}

/// The vector of a code, by the plane of each of the eight sides of the octahedron.
fn decoded(code: [i16; 2]) -> DVec3 {
    let [x, y] = code.map(|c| f64::from(c) / 32767.0);
    let z = 1.0 - x.abs() - y.abs();
    let folded = if z < 0.0 {
        DVec3::new(
            x.signum() * (1.0 - y.abs()),
            y.signum() * (1.0 - x.abs()),
            z,
        )
    } else {
        DVec3::new(x, y, z)
    };
    folded.normalize()
}

/// Truth: a code is its vector within half a step of 1 / 32767 along both coordinates, times the
/// largest stretch of the octahedron, which is 3^0.5.
#[test]
fn codes_are_their_vectors() {
    let mut most = 0.0f64;
    for k in 0..20_000 {
        // A spiral over the ball, with the corners of the octahedron.
        let z = 1.0 - 2.0 * f64::from(k) / 19_999.0;
        let turn = 2.399_963_229_728_653 * f64::from(k);
        let flat = (1.0 - z * z).max(0.0).sqrt();
        let n = DVec3::new(flat * turn.cos(), flat * turn.sin(), z);
        most = most.max((decoded(octahedral(n.as_vec3())) - n).length());
    }
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for n in [axis, -axis] {
            let off = (decoded(octahedral(n)) - n.as_dvec3()).length();
            assert!(off < 1e-6, "{n}: {off}");
        }
    }
    println!("off by up to {most:e}");
    assert!(most < 1e-4, "{most}");
}
