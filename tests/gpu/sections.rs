//! Creases at the borders of the sections of meshes.

use bevy::{core_pipeline::prepass::NormalPrepass, mesh::MeshBuilder};
use bevy_comics::{
    lines::CreaseSource,
    objects::{ATTRIBUTE_MESH_SECTION, MeshTasks, OutlineKinds},
};

use crate::{
    ids::skinned_and_morphed,
    pictures::{assert_pass_matches_the_reference, outlined},
    prelude::*,
    walls::{towards_the_sky, towards_the_sky_again, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

fn creases_of(source: CreaseSource) -> Outlines {
    Outlines {
        silhouettes: None,
        creases: Some(Creases {
            source,
            ..default()
        }),
        objects: None,
        ..default()
    }
}

/// Creases of normals, and of meshes with `MeshSections`.
fn creases() -> Outlines {
    creases_of(CreaseSource::Normals)
}

fn section(slot_section: u32) -> u32 {
    slot_section >> 8
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
    let found = small.object_ids().map(|ids| kinds(&ids));
    panic!("the sections did not arrive: {found:?}");
}

/// How many sections are visible.
fn kinds(ids: &IdImage) -> usize {
    let sections = ids
        .pixels
        .iter()
        .map(|[_, slot_section]| section(*slot_section));
    let found: HashSet<u32> = sections.filter(|section| *section != 0).collect();
    found.len()
}

pub fn none_has_sections(ids: &IdImage) -> bool {
    ids.pixels
        .iter()
        .all(|[_, slot_section]| section(*slot_section) == 0)
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

pub fn some_has_sections(ids: &IdImage) -> bool {
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

/// The angle, and a change of it, decide; a mesh that changes is divided again, also in tasks.
#[test]
fn sections_follow_the_angle_and_the_mesh() {
    let (mut small, cube) = corner(soft_cube(24.0));
    small.world().insert_resource(MeshTasks::Background);
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
    small.world().insert_resource(MeshTasks::Immediate);
}

/// Two halves of a square, whose normals bend by 60 degrees and whose surface does not.
fn bent_by_normals() -> Mesh {
    let mut mesh = Mesh::from(Rectangle::new(12.0, 24.0)).translated_by(Vec3::NEG_X * 6.0);
    let right = mesh.clone().translated_by(Vec3::X * 12.0);
    mesh.merge(&right).expect("the same attributes");
    let normals = [-0.5, 0.5].map(|x| [[x, 0.0, 0.75f32.sqrt()]; 4]).concat();
    mesh.with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
}

#[test]
fn cameras_choose_what_creases_are_found_by() {
    use CreaseSource::{Both, Meshes, Normals};
    let mut small = towards_the_sky(SIZE);
    let edges = 3.0 * 24.0 * (2.0f64 / 3.0).sqrt() * 2.0;
    for source in [Normals, Meshes, Both] {
        put_corner(&mut small, Mesh::from(Cuboid::from_length(24.0)));
        let cube = ink(&mut small, creases_of(source));
        let is_right = (cube / edges - 1.0).abs() < 0.06;
        assert!(is_right, "{source:?}: {cube}, {edges}");
        let camera = small.camera;
        let reads_normals = small.world().get::<NormalPrepass>(camera).is_some();
        assert_eq!(reads_normals, source != Meshes, "{source:?}");

        towards_the_sky_again(&mut small, Msaa::Off);
        wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 200.0);
        let at = Transform::from_xyz(0.0, 0.0, -100.0);
        small.put(bent_by_normals(), unlit(Color::WHITE), at);
        let smooth = ink(&mut small, creases_of(source));
        assert!(smooth < 1.0, "{source:?}: {smooth}");
        let mut with_bumps = creases_of(source);
        with_bumps.creases.as_mut().expect("creases").normal_maps = true;
        let bent = ink(&mut small, with_bumps);
        assert_eq!(bent > 20.0, source != Meshes, "{source:?}: {bent}");
    }
    // Edges that one camera asks for are no creases of another one.
    small.empty_view(Msaa::Off, Color::WHITE);
    let turned = Quat::from_rotation_y(0.7);
    let at = Transform::from_xyz(0.3, 0.2, -6.0).with_rotation(turned);
    let house = small.put(facade(0.05), unlit(Color::WHITE), at);
    // A mesh with sections of its own, so that the pass of ids draws those of the house too.
    let aside = Transform::from_xyz(-3.5, -2.5, -6.0);
    let asked = small.put(Cuboid::from_length(0.5), unlit(Color::WHITE), aside);
    small.on(asked).insert(MeshSections::default());
    let alone = ink(&mut small, creases());
    let inactive = Camera {
        is_active: false,
        ..default()
    };
    let other = (Object, Camera3d::default(), inactive, everywhere());
    let other = small.world().spawn(other).id();
    assert_eq!(ink(&mut small, creases()), alone);
    let numbers = small.object_ids().expect("ids").pixels;
    let found = |[_, slot_section]: &[u32; 2]| (1..64).contains(&section(*slot_section));
    assert!(numbers.iter().any(found), "the house has sections");
    let both = ink(&mut small, creases_of(Both));
    assert!(both > alone + 10.0, "{both}, {alone}");
    // Triangles of which only parts are seen have no edges.
    let masked = StandardMaterial {
        alpha_mode: AlphaMode::Mask(0.5),
        ..unlit(Color::WHITE)
    };
    let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
    let masked = materials.add(masked);
    small.on(house).insert(MeshMaterial3d(masked));
    assert_eq!(ink(&mut small, creases_of(Both)), alone);
    small.world().despawn(other);
    // The samples of a pixel are resolved without normals too.
    small.empty_view(Msaa::Sample4, Color::WHITE);
    small.put(facade(0.05), unlit(Color::WHITE), at);
    let asked = small.put(Cuboid::from_length(0.5), unlit(Color::WHITE), aside);
    small.on(asked).insert(MeshSections::default());
    let sampled = ink(&mut small, creases_of(Meshes));
    assert!((sampled / both - 1.0).abs() < 0.1, "{sampled}, {both}");
    assert_eq!(small.errors(), 0);
}

/// Chunks of a floor in a group have no line between them, but folds have.
#[test]
fn groups_have_no_borders_where_the_surface_goes_on() {
    // In a new app, the two have neighboring numbers: those of entities, modulo 63.
    let mut small = Small::alone(options(SIZE), Msaa::Off);
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
    for object in objects {
        small.on(object).remove::<MeshSections>();
    }
    small.style(&outlined(everywhere()));
    wait(&mut small, |ids| {
        ids.pixels
            .iter()
            .any(|[_, m]| (1..64).contains(&section(*m)))
    });
    assert_pass_matches_the_reference(&mut small, &outlined(everywhere()), None, "all meshes");
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

const FACADE: UVec2 = UVec2::new(384, 256);
/// Half of the size of a frame in a wall, in meters.
const FRAME: Vec2 = Vec2::new(0.6, 0.8);

/// Thin creases in normals and at the edges of all meshes.
fn everywhere() -> Outlines {
    Outlines {
        width: 1.0,
        ..creases_of(CreaseSource::Both)
    }
}

/// A wall with a frame that stands proud of it, as one mesh.
fn facade(proud: f32) -> Mesh {
    let mut wall = Mesh::from(Cuboid::new(4.0, 3.0, 0.4)).translated_by(Vec3::NEG_Z * 0.2);
    let frame = Cuboid::new(2.0 * FRAME.x, 2.0 * FRAME.y, 2.0 * proud);
    wall.merge(&Mesh::from(frame)).expect("the same attributes");
    wall
}

/// Where a point is in the picture of a view that is 90 degrees high.
fn on_picture(p: Vec3) -> Vec2 {
    let half = 0.5 * FACADE.as_vec2();
    half + Vec2::new(p.x, -p.y) / -p.z * half.y
}

fn distance_to(p: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let along = ((p - a).dot(b - a) / (b - a).length_squared().max(1e-9)).clamp(0.0, 1.0);
    p.distance(a.lerp(b, along))
}

/// How much of the border of the frame's front has ink, and the part of all pixels that have ink away
/// from all edges. A pixel with a line along a border has its middle up to 1.2 pixels from it: it lies
/// up to 0.7 pixels from a place inside, and the line up to half a pixel beside the border. `aside`: how
/// much further the samples of a pixel may be.
fn compare(picture: &image::RgbaImage, at: &Transform, proud: f32, aside: f32) -> [f64; 2] {
    let corners = |half: Vec2, z: f32| {
        let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        signs.map(|sign| on_picture(*at * (half * Vec2::from(sign)).extend(z)))
    };
    let sides = |c: [Vec2; 4]| [0, 1, 2, 3].map(|i| [c[i], c[(i + 1) % 4]]);
    let edges = |[front, back]: [[Vec2; 4]; 2]| {
        let between = [0, 1, 2, 3].map(|i| [front[i], back[i]]);
        [sides(front), sides(back), between].concat()
    };
    let frame = [proud, 0.0].map(|z| corners(FRAME, z));
    let border = sides(frame[0]);
    let wall = [0.0, -0.4].map(|z| corners(Vec2::new(2.0, 1.5), z));
    let edges = [edges(frame), edges(wall)].concat();
    let inked = (0..FACADE.y).flat_map(|y| (0..FACADE.x).map(move |x| (x, y)));
    let inked: Vec<(Vec2, f64)> = inked
        .map(|(x, y)| {
            let place = Vec2::new(x as f32, y as f32) + 0.5;
            (place, 1.0 - linear(picture, x, y)[0])
        })
        .filter(|(_, ink)| *ink > 0.05)
        .collect();
    let away = |(p, ink): &&(Vec2, f64)| {
        *ink > 0.4 && edges.iter().all(|edge| distance_to(*p, *edge) > 1.5)
    };
    let wrong = inked.iter().filter(away).count() as f64;
    let (mut whole, mut all) = (0, 0);
    for [a, b] in border {
        let steps = (2.0 * a.distance(b)) as usize + 1;
        for step in 0..=steps {
            let p = a.lerp(b, step as f32 / steps as f32);
            let near = inked.iter().filter(|(at, _)| at.distance(p) <= 1.2 + aside);
            whole += usize::from(near.map(|(_, ink)| ink).sum::<f64>() > 0.5);
            all += 1;
        }
    }
    let pixels = f64::from(FACADE.x * FACADE.y);
    [
        f64::from(whole as u32) / f64::from(all as u32),
        wrong / pixels,
    ]
}

/// Frames that stand 1 to 8 cm proud of a wall, have whole borders, seen as in a picture of 720 rows and
/// 45 degrees from 20 to 60 m. `stands`: how far frames stand proud, and the distances.
fn check_frames(msaa: Msaa, stands: &[(f32, &[f32])], yaws: impl Iterator<Item = f32> + Clone) {
    let aside = if msaa == Msaa::Off { 0.0 } else { 0.4 };
    let lines = Outlines {
        silhouettes: Some(Silhouettes::default()),
        ..everywhere()
    };
    let mut small = Small::new(FACADE, msaa);
    let (mut found, mut count, mut most_wrong) = (0.0, 0.0, 0.0f64);
    let (mut by_normals, mut controls) = (0.0, 0.0);
    for &(proud, distances) in stands {
        small.empty_view(msaa, Color::WHITE);
        let wall = small.put(facade(proud), unlit(Color::WHITE), Transform::default());
        small.on(wall).insert(Transform::from_xyz(0.0, 0.0, -12.0));
        small.style(&outlined(lines));
        wait(&mut small, some_has_sections);
        for &distance in distances {
            for yaw in yaws.clone() {
                let turned = Quat::from_rotation_y(yaw.to_radians());
                let at = Transform::from_xyz(0.3, 0.2, -distance).with_rotation(turned);
                small.on(wall).insert(at);
                small.style(&outlined(lines));
                small.headless.step(2);
                let [whole, wrong] = compare(&small.picture(), &at, proud, aside);
                assert!(whole > 0.9, "{proud} m, {distance} m, {yaw}: {whole}");
                (found, count) = (found + whole, count + 1.0);
                most_wrong = most_wrong.max(wrong);
                if (proud, distance) == (0.05, 6.0) {
                    let normals = Outlines {
                        width: 1.0,
                        silhouettes: Some(Silhouettes::default()),
                        ..creases()
                    };
                    // Without sections.
                    small.on(wall).insert(MeshSections::NONE);
                    by_normals += compare(&small.shot(&outlined(normals)), &at, proud, aside)[0];
                    controls += 1.0;
                    small.on(wall).remove::<MeshSections>();
                    small.style(&outlined(lines));
                    wait(&mut small, some_has_sections);
                }
            }
        }
    }
    let found = found / count;
    let by_normals = by_normals / controls;
    println!("found {found}, by normals {by_normals}, away at most {most_wrong}");
    assert!(found >= 0.995, "{found}");
    assert!(most_wrong <= 3e-4, "{most_wrong}");
    assert!(by_normals < 0.7, "the test could not fail: {by_normals}");
}

#[test]
fn frames_of_walls_have_whole_borders() {
    let stands: [(f32, &[f32]); 3] = [(0.01, &[3.0, 9.0]), (0.05, &[6.0]), (0.08, &[9.0])];
    check_frames(Msaa::Off, &stands, [-65.0, 40.0].into_iter());
    check_frames(Msaa::Sample4, &stands, [25.0].into_iter());
}

#[test]
#[ignore = "long: 45 yaws, without and with samples"]
fn frames_of_walls_have_whole_borders_from_everywhere() {
    const DISTANCES: &[f32] = &[3.0, 6.0, 9.0];
    let stands = [0.01, 0.05, 0.08].map(|proud| (proud, DISTANCES));
    for msaa in [Msaa::Off, Msaa::Sample4] {
        check_frames(
            msaa,
            &stands,
            (0..45).map(|i| -70.0 + 140.0 * i as f32 / 44.0),
        );
    }
}

/// The triangles of a mesh whose middles are on one side of the ground.
fn half_of(mesh: &Mesh, above: bool) -> Mesh {
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let positions = positions
        .and_then(|values| values.as_float3())
        .expect("positions");
    let indices: Vec<u32> = mesh
        .indices()
        .expect("indices")
        .iter()
        .map(|i| i as u32)
        .collect();
    let kept = indices.chunks(3).filter(|t| {
        let height: f32 = t.iter().map(|i| positions[*i as usize][1]).sum();
        (height > 0.0) == above
    });
    let kept = kept.flatten().copied().collect();
    mesh.clone().with_inserted_indices(Indices::U32(kept))
}

/// Floors of tiles, halves of a ball, and posts have no ink when they are turned by these angles.
fn check_whole_surfaces(yaws: impl Iterator<Item = f32> + Clone) {
    let mut small = Small::new(SIZE, Msaa::Off);
    let tile = |x: f32, z: f32| {
        let tile = Mesh::from(Plane3d::default().mesh().size(2.0, 1.0));
        tile.translated_by(Vec3::new(x, -2.0, z))
    };
    let mut floor = tile(0.0, 18.5);
    for row in 0..40 {
        for column in -12..=12 {
            let x = 2.0 * column as f32 + 0.7 * (row % 3) as f32;
            let tile = tile(x, 19.5 - row as f32);
            floor.merge(&tile).expect("the same attributes");
        }
    }
    let mut ball = half_of(&Sphere::new(2.0).mesh().uv(32, 18), true);
    let below = half_of(&Sphere::new(2.0).mesh().uv(40, 22), false);
    ball.merge(&below).expect("the same attributes");
    let tilted = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(0.2);
    let away = Transform::from_xyz(0.0, 0.0, -6.0).with_rotation(tilted);
    let post = Cylinder::new(0.8, 40.0).mesh().resolution(6).build();
    for (mesh, at, least) in [
        (floor, Transform::from_xyz(0.0, 0.0, -22.0), 8),
        (ball, away, 2),
        (post, away, 1),
    ] {
        small.empty_view(Msaa::Off, Color::WHITE);
        let entity = small.put(mesh, unlit(Color::WHITE), at);
        small.style(&outlined(everywhere()));
        wait(&mut small, |ids| kinds(ids) >= least);
        for yaw in yaws.clone() {
            let turned = Quat::from_rotation_y(yaw.to_radians());
            let at = at.with_rotation(turned * at.rotation);
            small.on(entity).insert(at);
            let drawn = ink(&mut small, everywhere());
            assert!(drawn < 0.05, "{least} sections, {yaw} degrees: {drawn}");
        }
    }
}

/// Surfaces that go on where a mesh has no common edge, and edges that are shaded smoothly, have no
/// lines: floors of tiles, halves of a ball, and posts.
#[test]
fn surfaces_that_go_on_have_no_lines() {
    check_whole_surfaces([0.0].into_iter());
}

#[test]
#[ignore = "long: 60 yaws"]
fn surfaces_that_go_on_have_no_lines_from_everywhere() {
    check_whole_surfaces((0..60).map(|i| 6.0 * i as f32));
}
