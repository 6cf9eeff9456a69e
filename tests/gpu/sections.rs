//! Creases at the borders of the sections of meshes.

use bevy::mesh::MeshBuilder;
use bevy_comics::objects::{ATTRIBUTE_MESH_SECTION, OutlineKinds};

use crate::{
    ids::skinned_and_morphed,
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, towards_the_sky_again, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

fn creases() -> Outlines {
    Outlines {
        silhouettes: None,
        creases: Some(Creases::default()),
        objects: None,
        ..default()
    }
}

fn section(marks: u32) -> u32 {
    marks >> 8
}

/// Steps until the sections of all visible objects are as they should be.
pub fn wait(small: &mut Small, are_there: impl Fn(&IdImage) -> bool) {
    for _ in 0..200 {
        small.headless.step(2);
        if small.object_ids().is_some_and(|ids| are_there(&ids)) {
            small.settle();
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("the sections did not arrive");
}

/// How many sections are visible.
fn kinds(ids: &IdImage) -> usize {
    let marks = ids.pixels.iter().map(|[_, marks]| section(*marks));
    let found: HashSet<u32> = marks.filter(|section| *section != 0).collect();
    found.len()
}

pub fn none_has_sections(ids: &IdImage) -> bool {
    ids.pixels.iter().all(|[_, marks]| section(*marks) == 0)
}

/// All ink of the picture, which is white without lines.
fn ink(small: &mut Small, outlines: Outlines) -> f64 {
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    black_ink(&small.outlined(outlines), pixels)
}

/// A cube whose normals are those of a ball: shading shows no edge.
fn soft_cube(length: f32) -> Mesh {
    let mut mesh = Mesh::from(Cuboid::from_length(length));
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let positions = positions.and_then(|values| values.as_float3());
    let normals = positions.expect("positions").iter();
    let normals = normals.map(|p| Vec3::from(*p).normalize().to_array());
    let normals: Vec<[f32; 3]> = normals.collect();
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, normals);
    mesh
}

/// The cube seen along its diagonal before a white wall: three edges meet in the middle,
/// each as long as the edge of the cube times the square root of 2/3.
fn corner(mesh: Mesh) -> (Small, Entity) {
    let mut small = towards_the_sky(SIZE);
    let cube = put_corner(&mut small, mesh);
    (small, cube)
}

fn put_corner(small: &mut Small, mesh: Mesh) -> Entity {
    towards_the_sky_again(small, Msaa::Off);
    wall(small, [-60.0, -40.0], [60.0, 40.0], 200.0);
    let diagonal = Quat::from_rotation_arc(Vec3::ONE.normalize(), Vec3::Z);
    let at = Transform::from_xyz(0.0, 0.0, -100.0).with_rotation(diagonal);
    small.put(mesh, unlit(Color::WHITE), at)
}

/// Draws creases until sections are as they should be.
fn wait_for_creases(small: &mut Small, are_there: impl Fn(&IdImage) -> bool) {
    small.style(&outlined(creases()));
    wait(small, are_there);
}

fn some_has_sections(ids: &IdImage) -> bool {
    !none_has_sections(ids)
}

#[test]
fn borders_of_sections_are_creases_of_known_length() {
    let (mut small, cube) = corner(soft_cube(36.0));
    // Without sections, the normals show no crease.
    assert!(ink(&mut small, creases()) < 1.0);
    small.on(cube).insert(MeshSections::default());
    wait(&mut small, some_has_sections);
    let edges = 3.0 * 36.0 * (2.0f64 / 3.0).sqrt();
    for width in [1.0, 2.0, 4.0] {
        let found = ink(&mut small, Outlines { width, ..creases() });
        let length = found / f64::from(width);
        // Whether the sides join is seen two pixels around an edge: each of the three may end
        // so far from the rim.
        let is_right = (edges - 6.0..edges + 1.0).contains(&length);
        assert!(is_right, "{width}: {length}, {edges}");
    }
    small.on(cube).remove::<MeshSections>();
    assert!(ink(&mut small, creases()) < 1.0);
}

/// The angle, and a change of it, decide; a mesh that changes is divided again.
#[test]
fn sections_follow_the_angle_and_the_mesh() {
    let (mut small, cube) = corner(soft_cube(24.0));
    small.on(cube).insert(MeshSections { angle: 100.0 });
    wait_for_creases(&mut small, some_has_sections);
    let one = ink(&mut small, creases());
    assert!(one < 1.0, "90 degrees are one section: {one}");
    small.on(cube).insert(MeshSections { angle: 80.0 });
    wait(&mut small, |ids| kinds(ids) == 3);
    assert!(ink(&mut small, creases()) > 50.0);
    let mesh = small.world().get::<Mesh3d>(cube).expect("a mesh").0.clone();
    let ball = Sphere::new(10.0).mesh().build();
    let mut meshes = small.world().resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).expect("loaded") = ball;
    wait(&mut small, |ids| kinds(ids) == 1);
    assert!(ink(&mut small, creases()) < 1.0, "a ball has one section");
}

/// Chunks of a floor in a group have no line between them, but folds have.
#[test]
fn groups_have_no_borders_where_the_surface_goes_on() {
    let mut small = towards_the_sky(SIZE);
    let mut lines = |folded: f32, grouped: bool| {
        let small = &mut small;
        towards_the_sky_again(small, Msaa::Off);
        wall(small, [-60.0, -40.0], [60.0, 40.0], 200.0);
        let left = wall(small, [-30.0, -20.0], [0.0, 20.0], 100.0);
        let right = wall(small, [0.0, -20.0], [30.0, 20.0], 100.0);
        let turned = Quat::from_rotation_y(folded.to_radians());
        let mut at = Transform::from_xyz(15.0, 0.0, -100.0);
        at.rotate_around(Vec3::new(0.0, 0.0, -100.0), turned);
        small.on(right).insert(at);
        let together = (Transform::default(), Visibility::default(), Object);
        let mut group = small.world().spawn((MeshSections::default(), together));
        group.add_children(&[left, right]);
        if grouped {
            group.insert(OutlineGroup);
        }
        // What normals find is left out: 20 degrees are no crease. Both walls are one section; in
        // a group, their numbers are shifted.
        wait_for_creases(small, |ids| kinds(ids) == 1 + usize::from(grouped));
        ink(small, creases())
    };
    assert!(lines(0.0, true) < 0.5, "a floor goes on");
    let fold = lines(20.0, true);
    assert!((fold / 80.0 - 1.0).abs() < 0.05, "{fold}");
    let apart = lines(20.0, false);
    assert!(apart < 0.5, "an object edge instead of a crease: {apart}");
}

/// The author's section 0 has no creases at all; styles of objects keep their slots.
#[test]
fn authors_silence_creases_and_styles_stay() {
    let mut mesh = Mesh::from(Cuboid::from_length(24.0));
    mesh.insert_attribute(ATTRIBUTE_MESH_SECTION, vec![0u32; 24]);
    let (mut small, cube) = corner(mesh);
    assert!(ink(&mut small, creases()) > 50.0, "normals show the edges");
    small.on(cube).insert(MeshSections::default());
    wait(&mut small, some_has_sections);
    assert!(ink(&mut small, creases()) < 0.5);

    let cube = put_corner(&mut small, soft_cube(24.0));
    let style = OutlineStyle {
        width: Some(4.0),
        ..default()
    };
    small.on(cube).insert((MeshSections::default(), style));
    wait_for_creases(&mut small, some_has_sections);
    let wide = ink(&mut small, creases());
    let want = 3.0 * 24.0 * (2.0f64 / 3.0).sqrt() * 4.0;
    assert!((wide / want - 1.0).abs() < 0.06, "{wide}, {want}");
    let kinds = OutlineKinds {
        creases: false,
        ..default()
    };
    small.on(cube).insert(OutlineStyle { kinds, ..default() });
    assert!(ink(&mut small, creases()) < 0.5);
}

/// Every pixel of skinned and morphed meshes, and of four samples of the small scene.
#[test]
fn pictures_with_sections_match_the_reference() {
    let (mut small, bent) = skinned_and_morphed();
    assert_divided_as_reference(&mut small, &bent);
    small.restart(Msaa::Sample4);
    let mut objects = small.world().query_filtered::<Entity, With<Object>>();
    let objects: Vec<Entity> = objects.iter(small.world()).collect();
    assert_divided_as_reference(&mut small, &objects);
}

fn assert_divided_as_reference(small: &mut Small, objects: &[Entity]) {
    for object in objects {
        small.on(*object).insert(MeshSections::default());
    }
    wait_for_creases(small, some_has_sections);
    let what = format!("{} objects", objects.len());
    assert_pass_matches_the_reference(small, &outlined(creases()), None, &what);
    assert_eq!(small.errors(), 0);
}
