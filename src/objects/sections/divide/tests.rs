use bevy::{asset::RenderAssetUsages, mesh::Indices};

use super::*;

fn divided(mesh: &Mesh, angle: f32) -> Vec<u8> {
    divided_by(mesh, angle, Origin::Asked)
}

fn divided_by(mesh: &Mesh, angle: f32, origin: Origin) -> Vec<u8> {
    let surface = Surface::new(mesh, origin)
        .expect("readable")
        .expect("triangles");
    surface.divide(angle, origin)
}

fn found(mesh: &Mesh) -> Vec<u8> {
    divided_by(mesh, 50.0, Origin::Found)
}

fn kinds(numbers: &[u8]) -> usize {
    numbers.iter().collect::<HashSet<_>>().len()
}

/// Six faces of two triangles; a bend of 90 degrees divides them at 89, not at 91.
#[test]
fn a_cube_has_six_sections() {
    let cube = Mesh::from(Cuboid::from_length(2.0));
    let numbers = divided(&cube, 89.0);
    assert_eq!((numbers.len(), kinds(&numbers)), (12, 6));
    for face in numbers.chunks(2) {
        assert_eq!(face[0], face[1]);
    }
    assert_eq!(kinds(&divided(&cube, 91.0)), 1);
}

/// Smooth surfaces are one section; a cylinder has its side and two caps.
#[test]
fn round_things_are_not_divided() {
    assert_eq!(kinds(&divided(&Mesh::from(Sphere::new(1.0)), 30.0)), 1);
    assert_eq!(kinds(&divided(&Mesh::from(Torus::new(0.2, 1.0)), 30.0)), 1);
    let drum = Cylinder::new(1.0, 2.0).mesh().resolution(24).build();
    // 15 degrees between two facets of the side.
    assert_eq!(kinds(&divided(&drum, 50.0)), 3);
    assert_eq!(kinds(&divided(&drum, 14.0)), 26);
}

/// Every edge has the same angle on both scales, and at any place.
#[test]
fn sections_do_not_depend_on_scale_or_place() {
    let cube = Mesh::from(Cuboid::new(1.0, 2.0, 3.0));
    let want = divided(&cube, 50.0);
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let scaled = cube.clone().scaled_by(Vec3::splat(scale));
        assert_eq!(divided(&scaled, 50.0), want, "{scale}");
    }
    let far = cube.translated_by(Vec3::new(1000.0, -2000.0, 500.0));
    assert_eq!(divided(&far, 50.0), want);
}

fn bare(corners: &[[f32; 3]], indices: Option<Indices>) -> Mesh {
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    );
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, corners.to_vec());
    if let Some(indices) = indices {
        mesh.insert_indices(indices);
    }
    mesh
}

/// Two triangles in a plane are one section, whatever their windings are, and whether they
/// share vertices or only places.
#[test]
fn windings_and_shared_vertices_do_not_matter() {
    let [a, b, c, d] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    for corners in [[a, b, c, a, c, d], [a, b, c, a, d, c]] {
        assert_eq!(kinds(&divided(&bare(&corners, None), 20.0)), 1);
    }
    let shared = Indices::U16(vec![0, 1, 2, 0, 2, 3]);
    assert_eq!(kinds(&divided(&bare(&[a, b, c, d], Some(shared)), 20.0)), 1);
    // Folded by 90 degrees.
    let up = [0.0, 0.5, 1.0];
    assert_eq!(kinds(&divided(&bare(&[a, b, c, a, c, up], None), 20.0)), 2);
}

/// Meshes that cannot be drawn have sections all the same, or none, but nothing panics.
#[test]
fn broken_meshes_do_no_harm() {
    let nan = [f32::NAN; 3];
    let all = |corners: &[[f32; 3]], indices| divided(&bare(corners, indices), 50.0);
    assert_eq!(all(&[nan, nan, nan], None).len(), 1);
    assert_eq!(all(&[[0.0; 3]; 6], None).len(), 2);
    assert_eq!(all(&[[1.0; 3]], Some(Indices::U32(vec![0, 7, 9]))).len(), 1);
    assert!(all(&[], None).is_empty());
    assert!(all(&[[f32::INFINITY; 3], [0.0; 3], [1.0, 0.0, 0.0]], None).len() == 1);
    let points = Mesh::new(PrimitiveTopology::PointList, RenderAssetUsages::default());
    assert!(
        Surface::new(&points, Origin::Asked)
            .expect("readable")
            .is_none()
    );
}

/// The author's numbers: 0 is silent, others follow those that are found, and wrap around.
#[test]
fn the_author_decides() {
    let mut cube = Mesh::from(Cuboid::from_length(2.0));
    let own: Vec<u32> = (0..24)
        .map(|vertex| [0, 1, 64, 65, 5, 5][vertex / 4])
        .collect();
    cube.insert_attribute(ATTRIBUTE_MESH_SECTION, own);
    let numbers = divided(&cube, 50.0);
    let faces: Vec<u8> = numbers.chunks(2).map(|face| face[0]).collect();
    assert_eq!(faces, [SILENT, 64, 127, 64, 68, 68]);
}

/// With more parts than numbers, neighbors still differ.
#[test]
fn neighbors_have_different_numbers() {
    let stairs: Vec<[f32; 3]> = (0..400)
        .flat_map(|i| {
            let [x, y] = [((i + 1) / 2) as f32, (i / 2) as f32];
            let [x1, y1] = if i % 2 == 0 {
                [x + 1.0, y]
            } else {
                [x, y + 1.0]
            };
            let [a, b] = [[x, y, 0.0], [x1, y1, 0.0]];
            let [c, d] = [[x1, y1, 1.0], [x, y, 1.0]];
            [a, b, c, a, c, d]
        })
        .collect();
    let numbers = divided(&bare(&stairs, None), 50.0);
    assert_eq!(numbers.len(), 800);
    assert_eq!(kinds(&numbers), usize::from(NUMBERS - FOUND));
    for pair in numbers.chunks(2).collect::<Vec<_>>().windows(2) {
        assert_eq!(pair[0][0], pair[0][1]);
        assert_ne!(pair[0][0], pair[1][0]);
    }
}

/// Edges that are shaded smoothly are no edges, unless they were asked for.
#[test]
fn smooth_edges_are_not_found() {
    // 60 degrees between two facets of the side, whose normals are those of a round post.
    let post = Cylinder::new(1.0, 2.0).mesh().resolution(6).build();
    assert_eq!(kinds(&divided(&post, 50.0)), 8);
    assert_eq!(kinds(&found(&post)), 3);
    let hard = post.with_duplicated_vertices().with_computed_flat_normals();
    assert_eq!(kinds(&found(&hard)), 8);
    let cube = found(&Mesh::from(Cuboid::from_length(2.0)));
    assert_eq!(kinds(&cube), 6);
    assert!(cube.iter().all(|number| (1..=FOUND).contains(number)));
}

/// A patch of squares, each a section, on a floor.
fn squares(count: usize, floor: f32) -> Mesh {
    let square = |x: f32, y: f32, side: f32| {
        let [a, b] = [[x, y, 0.0], [x + side, y, 0.0]];
        let [c, d] = [[x + side, y + side, 0.0], [x, y + side, 0.0]];
        [a, b, c, a, c, d]
    };
    let small = (0..count).flat_map(|i| square((i % 64) as f32, (i / 64) as f32, 0.5));
    let corners: Vec<_> = small.chain(square(-floor, -floor, floor)).collect();
    bare(&corners, None)
}

/// Meshes of which many small parts make up half of the area are left out.
#[test]
fn crowds_are_not_divided() {
    assert!(found(&squares(3000, 1.0)).is_empty());
    assert_eq!(divided(&squares(3000, 1.0), 50.0).len(), 6002);
    assert_eq!(found(&squares(3000, 200.0)).len(), 6002);
    assert_eq!(found(&squares(900, 1.0)).len(), 1802);
}

/// Parts that touch without a common edge differ too.
#[test]
fn parts_that_touch_have_different_numbers() {
    let mut wall = Mesh::from(Cuboid::new(20.0, 10.0, 1.0));
    for i in 0..8 {
        let at = Vec3::new(2.0 * i as f32 - 7.0, 0.0, 0.5);
        let frame = Mesh::from(Cuboid::new(1.0, 2.0, 0.1)).translated_by(at);
        wall.merge(&frame).expect("the same attributes");
    }
    let numbers = found(&wall);
    let fronts: HashSet<u8> = numbers.chunks(12).skip(1).map(|frame| frame[0]).collect();
    assert_eq!(fronts.len(), 8);
    for front in fronts {
        assert!(!numbers[..12].contains(&front));
    }
}
