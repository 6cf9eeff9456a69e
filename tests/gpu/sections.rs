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
    small.style(&ComicStyle::new().with(outlines));
    small.settle();
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y)));
    black_ink(&small.picture(), pixels)
}

/// A cube whose normals are those of a ball: shading shows no edge.
fn soft_cube(length: f32) -> Mesh {
    let mut mesh = Mesh::from(Cuboid::from_length(length));
    let positions = mesh
        .attribute(Mesh::ATTRIBUTE_POSITION)
        .and_then(|values| values.as_float3())
        .expect("positions")
        .to_vec();
    let normals: Vec<[f32; 3]> = positions
        .iter()
        .map(|p| Vec3::from(*p).normalize().to_array())
        .collect();
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

#[test]
fn borders_of_sections_are_creases_of_known_length() {
    let (mut small, cube) = corner(soft_cube(36.0));
    // Without sections, the normals show no crease.
    assert!(ink(&mut small, creases()) < 1.0);
    small
        .world()
        .entity_mut(cube)
        .insert(MeshSections::default());
    wait(&mut small, |ids| !none_has_sections(ids));
    let edges = 3.0 * 36.0 * (2.0f64 / 3.0).sqrt();
    for width in [1.0, 2.0, 4.0] {
        let found = ink(&mut small, Outlines { width, ..creases() });
        let length = found / f64::from(width);
        // Whether the sides join is seen two pixels around an edge: each of the three may end
        // so far from the rim.
        assert!(
            (edges - 6.0..edges + 1.0).contains(&length),
            "{width}: {length}, {edges}"
        );
    }
    small.world().entity_mut(cube).remove::<MeshSections>();
    assert!(ink(&mut small, creases()) < 1.0);
}

/// The angle, and a change of it, decide; a mesh that changes is divided again.
#[test]
fn sections_follow_the_angle_and_the_mesh() {
    let (mut small, cube) = corner(soft_cube(24.0));
    small
        .world()
        .entity_mut(cube)
        .insert(MeshSections { angle: 100.0 });
    ink(&mut small, creases());
    wait(&mut small, |ids| !none_has_sections(ids));
    assert!(
        ink(&mut small, creases()) < 1.0,
        "90 degrees are one section"
    );
    small
        .world()
        .entity_mut(cube)
        .insert(MeshSections { angle: 80.0 });
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
        small.world().entity_mut(right).insert(at);
        let together = (Transform::default(), Visibility::default(), Object);
        let world = small.world();
        let group = world.spawn((MeshSections::default(), together)).id();
        world.entity_mut(group).add_children(&[left, right]);
        if grouped {
            world.entity_mut(group).insert(OutlineGroup);
        }
        // What normals find is left out: 20 degrees are no crease.
        ink(small, creases());
        // Both walls are one section; in a group, their numbers are shifted.
        wait(small, |ids| kinds(ids) == 1 + usize::from(grouped));
        ink(small, creases())
    };
    assert!(lines(0.0, true) < 0.5, "a floor goes on");
    let fold = lines(20.0, true);
    assert!((fold / 80.0 - 1.0).abs() < 0.05, "{fold}");
    assert!(
        lines(20.0, false) < 0.5,
        "two objects: no crease, but an object edge"
    );
}

/// The author's section 0 has no creases at all; styles of objects keep their slots.
#[test]
fn authors_silence_creases_and_styles_stay() {
    let mut mesh = Mesh::from(Cuboid::from_length(24.0));
    mesh.insert_attribute(ATTRIBUTE_MESH_SECTION, vec![0u32; 24]);
    let (mut small, cube) = corner(mesh);
    assert!(ink(&mut small, creases()) > 50.0, "normals show the edges");
    small
        .world()
        .entity_mut(cube)
        .insert(MeshSections::default());
    wait(&mut small, |ids| !none_has_sections(ids));
    assert!(ink(&mut small, creases()) < 0.5);

    let cube = put_corner(&mut small, soft_cube(24.0));
    small.world().entity_mut(cube).insert((
        MeshSections::default(),
        OutlineStyle {
            width: Some(4.0),
            ..default()
        },
    ));
    ink(&mut small, creases());
    wait(&mut small, |ids| !none_has_sections(ids));
    let wide = ink(&mut small, creases());
    let bare = OutlineStyle {
        kinds: OutlineKinds {
            creases: false,
            ..default()
        },
        ..default()
    };
    let want = 3.0 * 24.0 * (2.0f64 / 3.0).sqrt() * 4.0;
    assert!((wide / want - 1.0).abs() < 0.06, "{wide}, {want}");
    small.world().entity_mut(cube).insert(bare);
    assert!(ink(&mut small, creases()) < 0.5);
}

/// Lines of one kind, all lines, and wide ones.
fn settings() -> [Outlines; 3] {
    let wide = Outlines {
        width: 5.0,
        ..default()
    };
    [creases(), default(), wide]
}

/// Every pixel of the small scene.
fn assert_divided_as_reference(msaa: Msaa, settings: &[Outlines]) {
    let mut small = Small::new(SIZE, msaa);
    small.style(&outlined(creases()));
    let world = small.world();
    let mut objects = world.query_filtered::<Entity, With<Object>>();
    for object in objects.iter(world).collect::<Vec<_>>() {
        world
            .entity_mut(object)
            .insert(MeshSections { angle: 30.0 });
    }
    wait(&mut small, |ids| !none_has_sections(ids));
    for &outlines in settings {
        let what = format!("{msaa:?}, {} px", outlines.width);
        assert_pass_matches_the_reference(&mut small, &outlined(outlines), None, &what);
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn multisampled_pictures_with_sections_match_the_reference() {
    let [creases, ..] = settings();
    assert_divided_as_reference(Msaa::Sample4, &[creases]);
}

#[test]
#[ignore = "long: more kinds of lines"]
fn all_lines_beside_sections_match_the_reference() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        assert_divided_as_reference(msaa, &settings());
    }
}

/// Every pixel of skinned and morphed meshes.
#[test]
fn pictures_with_sections_match_the_reference() {
    let (mut small, bent) = skinned_and_morphed();
    for entity in bent {
        small
            .world()
            .entity_mut(entity)
            .insert(MeshSections::default());
    }
    small.style(&outlined(creases()));
    wait(&mut small, |ids| !none_has_sections(ids));
    assert_pass_matches_the_reference(
        &mut small,
        &outlined(creases()),
        None,
        "skinned and morphed",
    );
    assert_eq!(small.errors(), 0);
}
