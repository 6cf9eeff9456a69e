//! Object ids, and objects with lines of their own or none.

use bevy_comics::{lines::CreaseSource, objects::OutlineKinds};

use crate::{line_scenes::skinned, outlines::ink, prelude::*};

pub fn material(
    small: &mut Small,
    change: impl FnOnce(&mut StandardMaterial),
) -> Handle<StandardMaterial> {
    let mut material = unlit(Color::srgb(0.8, 0.75, 0.7));
    change(&mut material);
    small.world().resource_mut::<Assets<_>>().add(material)
}

pub fn cube(small: &mut Small, material: Handle<StandardMaterial>, at: Transform) -> Entity {
    small.put_shared(Cuboid::default(), MeshMaterial3d(material), at)
}

/// Two cubes side by side, flush in front, before the sky.
pub fn two_cubes() -> (Small, [Entity; 2]) {
    let mut small = Small::new(UVec2::new(120, 60), Msaa::Off);
    let cubes = put_two_cubes(&mut small, Msaa::Off);
    (small, cubes)
}

/// Starts over with the two cubes.
pub fn put_two_cubes(small: &mut Small, msaa: Msaa) -> [Entity; 2] {
    small.restart(msaa);
    small.clear();
    let plain = MeshMaterial3d(material(small, |_| {}));
    // One mesh and one material: the engine draws both as instances of one.
    let world = small.world();
    let mesh = Mesh3d(world.resource_mut::<Assets<Mesh>>().add(Cuboid::default()));
    let cubes = [-0.5, 0.5].map(|x| {
        let at = Transform::from_xyz(x, 0.0, 0.0);
        let parts = (Object, mesh.clone(), plain.clone(), at);
        world.spawn(parts).id()
    });
    small.insert(Transform::from_xyz(0.0, 0.0, 2.2).looking_at(Vec3::ZERO, Vec3::Y));
    cubes
}

/// The weakest row of the strongest ink in columns.
pub fn edge(ink: &[f32], columns: Range<usize>) -> f32 {
    let rows = (25..35).map(|y| &ink[y * 120..][columns.clone()]);
    rows.map(|row| row.iter().copied().fold(0.0, f32::max))
        .fold(1.0, f32::min)
}

/// The pixel column where the cubes meet, and rows within them.
pub fn seam(ink: &[f32]) -> f32 {
    edge(ink, 57..63)
}

pub fn total(ink: &[f32], columns: Range<usize>) -> f32 {
    let rows = (0..60).map(|y| &ink[y * 120..][columns.clone()]);
    rows.flatten().sum()
}

/// Outlines without edges between objects and without creases.
fn silhouettes_alone() -> Outlines {
    Outlines {
        objects: None,
        creases: None,
        ..default()
    }
}

#[test]
fn touching_objects_of_like_depth_and_normal_have_an_edge() {
    let (mut small, _) = two_cubes();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let [left, right] = put_two_cubes(&mut small, msaa);
        let with = ink(&mut small, Outlines::default());
        assert!(seam(&with) > 0.9, "{msaa:?}");
        let ids = small.ids();
        let found = [ids[30 * 120 + 50], ids[30 * 120 + 70], ids[0]];
        let sky = 0;
        assert_eq!(found, [small.id_of(left), small.id_of(right), sky]);
        let creases = Creases {
            source: CreaseSource::Normals,
            ..default()
        };
        let no_objects = Outlines {
            creases: Some(creases),
            objects: None,
            ..default()
        };
        let without = seam(&ink(&mut small, no_objects));
        assert!(without < 0.02, "neither silhouette nor crease");
        assert!(small.object_ids().is_none(), "nothing needs the ids");
    }
}

#[test]
fn an_object_without_contours_has_none_and_its_neighbor_keeps_its_own() {
    let (mut small, [left, right]) = two_cubes();
    let both = ink(&mut small, Outlines::default());
    small.on(left).insert(NoOutlines::default());
    let one = ink(&mut small, Outlines::default());
    assert!(total(&one, 0..56) < 0.05, "the left cube is bare");
    assert!(seam(&one) > 0.9, "the seam is the right cube's");
    assert!((total(&one, 64..120) - total(&both, 64..120)).abs() < 0.5);
    small.on(right).insert(NoOutlines::default());
    let none = ink(&mut small, Outlines::default());
    assert!(none.iter().all(|i| *i < 0.02), "nobody draws the seam");
    for cube in [left, right] {
        small.on(cube).remove::<NoOutlines>();
    }
    assert_eq!(ink(&mut small, Outlines::default()), both, "and back");
}

#[test]
fn a_bare_object_in_front_hides_and_one_behind_is_outlined_over() {
    let (mut small, [left, right]) = two_cubes();
    // The right cube stands half before the left one.
    let before = Transform::from_xyz(0.1, 0.0, 0.4);
    small.on(right).insert((before, NoOutlines::default()));
    let lines = Outlines {
        creases: None,
        ..default()
    };
    let bare = edge(&ink(&mut small, lines), 34..42);
    assert!(bare < 0.02, "the nearer one decides");
    small.on(right).remove::<NoOutlines>();
    small.on(left).insert(NoOutlines::default());
    assert!(edge(&ink(&mut small, lines), 34..42) > 0.9);
}

#[test]
fn an_object_has_its_own_color_width_and_kinds() {
    let (mut small, [left, _]) = two_cubes();
    let plain = ink(&mut small, silhouettes_alone());
    small.on(left).insert(OutlineStyle {
        color: Some(Color::srgb(1.0, 0.0, 0.0)),
        width: Some(6.0),
        ..default()
    });
    ink(&mut small, silhouettes_alone());
    let (_, output) = small.pass();
    let count = |is_it: fn(f32) -> bool| {
        let found = output.pixels.iter();
        found.filter(|p| is_it(p[0]) && p[1] < 0.05).count()
    };
    let [red, black] = [count(|red| red > 0.9), count(|red| red < 0.05)];
    let before = plain.iter().filter(|i| **i > 0.9).count();
    assert!(black < before, "the left cube's lines are no longer black");
    // Half of the lines, three times as wide.
    let ratio = red as f32 / (0.5 * before as f32);
    assert!((2.3..3.8).contains(&ratio), "{red} red, {before} before");
    let kinds = OutlineKinds {
        silhouettes: false,
        ..default()
    };
    small.on(left).insert(OutlineStyle { kinds, ..default() });
    let some = ink(&mut small, silhouettes_alone());
    assert!(total(&some, 0..57) < 0.05);
}

/// An object's lines have the part of the ink that its opacity says; its neighbor's lines
/// keep theirs.
#[test]
fn an_object_has_its_own_opacity() {
    let (mut small, [left, _]) = two_cubes();
    let plain = ink(&mut small, Outlines::SILHOUETTES);
    let [own, others] = [total(&plain, 0..57), total(&plain, 62..96)];
    assert!(own > 5.0 && others > 5.0, "{own}, {others}");
    for opacity in [0.0, 0.25, 1.0, 7.0] {
        small.on(left).insert(OutlineStyle {
            opacity: Some(opacity),
            ..default()
        });
        let faded = ink(&mut small, Outlines::SILHOUETTES);
        let ratio = total(&faded, 0..57) / own;
        let want = opacity.min(1.0);
        assert!((ratio - want).abs() < 0.02, "{opacity}: {ratio}");
        let kept = total(&faded, 62..96) / others;
        assert!((kept - 1.0).abs() < 0.02, "{opacity}: {kept}");
    }
}

#[test]
fn styles_are_inherited_where_asked() {
    let (mut small, [left, right]) = two_cubes();
    let world = small.world();
    let mut root = world.spawn((Transform::default(), Visibility::default()));
    root.insert(NoOutlines { inherit: false });
    let root = root.add_children(&[left, right]).id();
    let own = ink(&mut small, Outlines::default());
    assert!(own.iter().any(|i| *i > 0.9), "not asked, not inherited");
    small.on(root).insert(NoOutlines::default());
    let inherited = ink(&mut small, Outlines::default());
    assert!(inherited.iter().all(|i| *i < 0.02));
    small.on(right).insert(OutlineStyle::default());
    let nearest = ink(&mut small, Outlines::default());
    assert!(total(&nearest, 0..56) < 0.05 && total(&nearest, 64..120) > 10.0);
}

/// What an alpha mask cuts away has neither lines nor ids; the rest is as if opaque, lit or not.
#[test]
fn alpha_masked_and_lit_meshes_have_ids_where_they_are_seen() {
    let (mut small, [_, right]) = two_cubes();
    let opaque = ink(&mut small, Outlines::default());
    let clear = material(&mut small, |m| {
        m.alpha_mode = AlphaMode::Mask(0.5);
        m.base_color = Color::srgba(1.0, 1.0, 1.0, 0.0);
    });
    small.on(right).insert(MeshMaterial3d(clear));
    let masked = ink(&mut small, Outlines::default());
    assert_eq!(small.pixels_of(right), 0);
    assert!(total(&masked, 66..120) < 0.05);
    let kept = material(&mut small, |m| m.alpha_mode = AlphaMode::Mask(0.5));
    small.on(right).insert(MeshMaterial3d(kept));
    assert_eq!(ink(&mut small, Outlines::default()), opaque);
    let lit = material(&mut small, |m| m.unlit = false);
    small.on(right).insert(MeshMaterial3d(lit));
    assert_eq!(small.settle().ids()[30 * 120 + 70], small.id_of(right));
}

/// A cube that its joint moves to the left, and one that its morph target moves down.
pub fn skinned_and_morphed() -> (Small, [Entity; 2]) {
    let mut small = Small::new(UVec2::new(120, 60), Msaa::Off);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 0.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y));
    let plain = MeshMaterial3d(material(&mut small, |_| {}));

    // The joint carries the mesh a unit to the left, whatever its own place.
    let joint = Transform::from_xyz(-1.2, 0.0, 0.0);
    let joint = small.world().spawn(joint).id();
    let skin = skinned(&mut small, Cuboid::default().into(), &[joint], |_| 0);
    let parts = (Object, skin, plain.clone(), Transform::default());
    let skinned = small.world().spawn(parts).id();

    let mut mesh = Mesh::from(Cuboid::default());
    let down = bevy::mesh::morph::MorphAttributes {
        position: Vec3::new(0.0, -0.6, 0.0),
        ..default()
    };
    mesh.set_morph_targets(vec![down; mesh.count_vertices()]);
    let at = Transform::from_xyz(1.2, 0.0, 0.0);
    let morphed = small.put_shared(mesh, plain, at);
    small.on(morphed).insert((
        MorphWeights::new(vec![1.0], None).expect("one weight"),
        MeshMorphWeights::Value { weights: vec![1.0] },
    ));
    (small, [skinned, morphed])
}

/// Skinned and morphed meshes have the ids of where they are drawn.
#[test]
fn skinned_and_morphed_meshes_have_ids_where_they_are_seen() {
    let (mut small, meshes) = skinned_and_morphed();
    ink(&mut small, Outlines::default());
    let ids = small.ids();
    let [skinned, morphed] = meshes.map(|mesh| {
        let own = (0..ids.len()).filter(|i| ids[*i] == small.id_of(mesh));
        let (count, sum) = own.fold((0.0, Vec2::ZERO), |(count, sum), i| {
            (
                count + 1.0,
                sum + Vec2::new((i % 120) as f32, (i / 120) as f32),
            )
        });
        assert!(count > 100.0, "{count}");
        sum / count
    });
    assert!(skinned.x < 45.0, "{skinned}");
    assert!(morphed.x > 75.0 && morphed.y > 35.0, "{morphed}");
    // Every pixel with depth has an object: nothing fell through the test for
    // equal depth.
    let depth = small.depth().expect("a prepass");
    for (i, id) in ids.into_iter().enumerate() {
        let is_covered = f32::from_bits(depth.bits[i]) > 0.0;
        assert_eq!(id != 0, is_covered, "pixel {i}");
    }
}
