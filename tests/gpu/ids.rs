//! Object ids, and objects with lines of their own or none.

use bevy::camera::primitives::MeshAabb;
use bevy_comics::objects::OutlineKinds;

use crate::{outlines::ink, prelude::*};

pub fn material(
    small: &mut Small,
    change: impl FnOnce(&mut StandardMaterial),
) -> Handle<StandardMaterial> {
    let mut material = unlit(Color::srgb(0.8, 0.75, 0.7));
    change(&mut material);
    small
        .world()
        .resource_mut::<Assets<StandardMaterial>>()
        .add(material)
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
    let plain = material(small, |_| {});
    // One mesh and one material: the engine draws both as instances of one.
    let world = small.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let cubes = [-0.5, 0.5].map(|x| {
        let at = Transform::from_xyz(x, 0.0, 0.0);
        let parts = (
            Object,
            Mesh3d(mesh.clone()),
            MeshMaterial3d(plain.clone()),
            at,
        );
        world.spawn(parts).id()
    });
    small.insert(Transform::from_xyz(0.0, 0.0, 2.2).looking_at(Vec3::ZERO, Vec3::Y));
    cubes
}

fn at(ink: &[f32], x: usize, y: usize) -> f32 {
    ink[y * 120 + x]
}

/// The pixel column where the cubes meet, and rows within them.
pub fn seam(ink: &[f32]) -> f32 {
    (25..35)
        .map(|y| (57..63).map(|x| at(ink, x, y)).fold(0.0, f32::max))
        .fold(1.0, f32::min)
}

pub fn total(ink: &[f32], columns: Range<usize>) -> f32 {
    (0..60)
        .flat_map(|y| columns.clone().map(move |x| (x, y)))
        .map(|(x, y)| at(ink, x, y))
        .sum()
}

#[test]
fn touching_objects_of_like_depth_and_normal_have_an_edge() {
    let (mut small, _) = two_cubes();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let [left, right] = put_two_cubes(&mut small, msaa);
        let with = ink(&mut small, Outlines::default());
        assert!(seam(&with) > 0.9, "{msaa:?}");
        let ids = small.object_ids().expect("drawn");
        assert_eq!(ids.pixels[30 * 120 + 50][0], u32::from(object_id(left)));
        assert_eq!(ids.pixels[30 * 120 + 70][0], u32::from(object_id(right)));
        assert_eq!(ids.pixels[0][0], 0, "the sky is no object");
        let without = ink(
            &mut small,
            Outlines {
                objects: None,
                ..default()
            },
        );
        assert!(
            seam(&without) < 0.02,
            "flush faces have neither silhouette nor crease"
        );
        assert!(
            small.object_ids().is_none(),
            "nothing needs the ids any more"
        );
        assert_eq!(small.errors(), 0);
    }
}

#[test]
fn an_object_without_contours_has_none_and_its_neighbour_keeps_its_own() {
    let (mut small, [left, right]) = two_cubes();
    let both = ink(&mut small, Outlines::default());
    small.world().entity_mut(left).insert(NoOutlines::default());
    let one = ink(&mut small, Outlines::default());
    assert!(total(&one, 0..56) < 0.05, "the left cube is bare");
    assert!(seam(&one) > 0.9, "the seam is the right cube's");
    assert!((total(&one, 64..120) - total(&both, 64..120)).abs() < 0.5);
    small
        .world()
        .entity_mut(right)
        .insert(NoOutlines::default());
    let none = ink(&mut small, Outlines::default());
    assert!(none.iter().all(|i| *i < 0.02), "nobody draws the seam");
    for cube in [left, right] {
        small.world().entity_mut(cube).remove::<NoOutlines>();
    }
    assert_eq!(ink(&mut small, Outlines::default()), both, "and back");
}

#[test]
fn a_bare_object_in_front_hides_and_one_behind_is_outlined_over() {
    let (mut small, [left, right]) = two_cubes();
    // The right cube stands half before the left one.
    small
        .world()
        .entity_mut(right)
        .insert(Transform::from_xyz(0.1, 0.0, 0.4));
    small
        .world()
        .entity_mut(right)
        .insert(NoOutlines::default());
    let bare_front = ink(
        &mut small,
        Outlines {
            creases: None,
            ..default()
        },
    );
    let front_edge = |ink: &[f32]| {
        (25..35)
            .map(|y| (34..42).map(|x| at(ink, x, y)).fold(0.0, f32::max))
            .fold(1.0, f32::min)
    };
    assert!(front_edge(&bare_front) < 0.02, "the nearer one decides");
    small.world().entity_mut(right).remove::<NoOutlines>();
    small.world().entity_mut(left).insert(NoOutlines::default());
    let bare_back = ink(
        &mut small,
        Outlines {
            creases: None,
            ..default()
        },
    );
    assert!(front_edge(&bare_back) > 0.9);
}

#[test]
fn an_object_has_its_own_colour_width_and_kinds() {
    let (mut small, [left, _]) = two_cubes();
    let plain = ink(
        &mut small,
        Outlines {
            objects: None,
            creases: None,
            ..default()
        },
    );
    small.world().entity_mut(left).insert(OutlineStyle {
        color: Some(Color::srgb(1.0, 0.0, 0.0)),
        width: Some(6.0),
        ..default()
    });
    ink(
        &mut small,
        Outlines {
            objects: None,
            creases: None,
            ..default()
        },
    );
    let (_, output) = small.pass();
    let red = output
        .pixels
        .iter()
        .filter(|p| p[0] > 0.9 && p[1] < 0.05)
        .count();
    let black = output
        .pixels
        .iter()
        .filter(|p| p[0] < 0.05 && p[1] < 0.05)
        .count();
    let before = plain.iter().filter(|i| **i > 0.9).count();
    assert!(black < before, "the left cube's lines are no longer black");
    // Half of the lines, three times as wide.
    let ratio = red as f32 / (0.5 * before as f32);
    assert!((2.3..3.8).contains(&ratio), "{red} red, {before} before");
    small.world().entity_mut(left).insert(OutlineStyle {
        kinds: OutlineKinds {
            silhouettes: false,
            ..default()
        },
        ..default()
    });
    let some = ink(
        &mut small,
        Outlines {
            objects: None,
            creases: None,
            ..default()
        },
    );
    assert!(total(&some, 0..57) < 0.05);
}

/// An object's lines have the part of the ink that its opacity says; its neighbour's lines
/// keep theirs.
#[test]
fn an_object_has_its_own_opacity() {
    let (mut small, [left, _]) = two_cubes();
    let plain = ink(&mut small, Outlines::SILHOUETTES);
    let [own, others] = [total(&plain, 0..57), total(&plain, 62..96)];
    assert!(own > 5.0 && others > 5.0, "{own}, {others}");
    for opacity in [0.0, 0.25, 1.0, 7.0] {
        small.world().entity_mut(left).insert(OutlineStyle {
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
    let root = world
        .spawn((Transform::default(), Visibility::default()))
        .id();
    world.entity_mut(root).add_children(&[left, right]);
    world.entity_mut(root).insert(NoOutlines { inherit: false });
    let own = ink(&mut small, Outlines::default());
    assert!(own.iter().any(|i| *i > 0.9), "not asked, not inherited");
    small.world().entity_mut(root).insert(NoOutlines::default());
    let inherited = ink(&mut small, Outlines::default());
    assert!(inherited.iter().all(|i| *i < 0.02));
    small
        .world()
        .entity_mut(right)
        .insert(OutlineStyle::default());
    let nearest = ink(&mut small, Outlines::default());
    assert!(total(&nearest, 0..56) < 0.05 && total(&nearest, 64..120) > 10.0);
}

/// Transparent surfaces have no lines; those of what is behind them show.
#[test]
fn transparent_alpha_masked_and_unlit_meshes() {
    let (mut small, [_, right]) = two_cubes();
    let opaque = ink(&mut small, Outlines::default());
    let glass = material(&mut small, |m| {
        m.alpha_mode = AlphaMode::Blend;
        m.base_color = Color::srgba(0.5, 0.7, 0.9, 0.5);
    });
    let pane = cube(
        &mut small,
        glass,
        Transform::from_xyz(0.0, 0.0, 0.7).with_scale(Vec3::splat(0.3)),
    );
    let behind = ink(&mut small, Outlines::default());
    let ids = small.object_ids().expect("drawn");
    assert!(
        ids.pixels
            .iter()
            .all(|p| p[0] != u32::from(object_id(pane)))
    );
    let far_apart = opaque
        .iter()
        .zip(&behind)
        .filter(|(a, b)| (**a - **b).abs() > 0.3)
        .count();
    assert!(
        far_apart < 8,
        "the lines are those of the opaque scene: {far_apart}"
    );
    small.world().despawn(pane);

    // Alpha of zero everywhere: the masked cube is not there at all.
    let mask = material(&mut small, |m| {
        m.alpha_mode = AlphaMode::Mask(0.5);
        m.base_color = Color::srgba(1.0, 1.0, 1.0, 0.0);
    });
    small.world().entity_mut(right).insert(MeshMaterial3d(mask));
    let masked = ink(&mut small, Outlines::default());
    let ids = small.object_ids().expect("drawn");
    assert!(
        ids.pixels
            .iter()
            .all(|p| p[0] != u32::from(object_id(right)))
    );
    assert!(total(&masked, 66..120) < 0.05);
    // Alpha of one: as if opaque.
    let kept = material(&mut small, |m| m.alpha_mode = AlphaMode::Mask(0.5));
    small.world().entity_mut(right).insert(MeshMaterial3d(kept));
    assert_eq!(ink(&mut small, Outlines::default()), opaque);
    // Lit or not makes no difference to ids.
    let lit = material(&mut small, |m| m.unlit = false);
    small.world().entity_mut(right).insert(MeshMaterial3d(lit));
    small.settle();
    let ids = small.object_ids().expect("drawn");
    assert_eq!(ids.pixels[30 * 120 + 70][0], u32::from(object_id(right)));
    assert_eq!(small.errors(), 0);
}

/// A cube that its joint moves to the left, and one that its morph target moves down.
pub fn skinned_and_morphed() -> (Small, [Entity; 2]) {
    let mut small = Small::new(UVec2::new(120, 60), Msaa::Off);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 0.0, 4.0).looking_at(Vec3::ZERO, Vec3::Y));
    let plain = material(&mut small, |_| {});

    let mut mesh = Mesh::from(Cuboid::default());
    let count = mesh.count_vertices();
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_INDEX,
        VertexAttributeValues::Uint16x4(vec![[0; 4]; count]),
    );
    mesh.insert_attribute(
        Mesh::ATTRIBUTE_JOINT_WEIGHT,
        vec![[1.0, 0.0, 0.0, 0.0]; count],
    );
    let mut morphed = Mesh::from(Cuboid::default());
    morphed.set_morph_targets(vec![
        bevy::mesh::morph::MorphAttributes {
            position: Vec3::new(0.0, -0.6, 0.0),
            ..default()
        };
        count
    ]);
    assert!(mesh.compute_aabb().is_some());
    let world = small.world();
    let [skinned_mesh, morphed_mesh] =
        [mesh, morphed].map(|mesh| world.resource_mut::<Assets<Mesh>>().add(mesh));
    let poses = world
        .resource_mut::<Assets<SkinnedMeshInverseBindposes>>()
        .add(SkinnedMeshInverseBindposes::from(vec![Mat4::IDENTITY]));
    // The joint carries the mesh a unit to the left, whatever its own place.
    let joint = world.spawn(Transform::from_xyz(-1.2, 0.0, 0.0)).id();
    let skinned = world
        .spawn((
            Object,
            Mesh3d(skinned_mesh),
            MeshMaterial3d(plain.clone()),
            Transform::default(),
            SkinnedMesh {
                inverse_bindposes: poses,
                joints: vec![joint],
            },
        ))
        .id();
    let morphed = world
        .spawn((
            Object,
            Mesh3d(morphed_mesh),
            MeshMaterial3d(plain),
            Transform::from_xyz(1.2, 0.0, 0.0),
            MorphWeights::new(vec![1.0], None).expect("one weight"),
            MeshMorphWeights::Value { weights: vec![1.0] },
        ))
        .id();
    (small, [skinned, morphed])
}

/// Skinned and morphed meshes have the ids of where they are drawn.
#[test]
fn skinned_and_morphed_meshes_have_ids_where_they_are_seen() {
    let (mut small, [skinned, morphed]) = skinned_and_morphed();
    ink(
        &mut small,
        Outlines {
            objects: Some(ObjectEdges::default()),
            ..default()
        },
    );
    let ids = small.object_ids().expect("drawn");
    let seen = |entity: Entity| -> Vec<(usize, usize)> {
        let id = u32::from(object_id(entity));
        (0..120 * 60)
            .filter(|i| ids.pixels[*i][0] == id)
            .map(|i| (i % 120, i / 120))
            .collect()
    };
    let middle = |pixels: &[(usize, usize)]| -> (f32, f32) {
        let n = pixels.len().max(1) as f32;
        (
            pixels.iter().map(|p| p.0 as f32).sum::<f32>() / n,
            pixels.iter().map(|p| p.1 as f32).sum::<f32>() / n,
        )
    };
    let (skinned, morphed) = (seen(skinned), seen(morphed));
    assert!(
        skinned.len() > 100 && morphed.len() > 100,
        "{} {}",
        skinned.len(),
        morphed.len()
    );
    assert!(middle(&skinned).0 < 45.0, "{:?}", middle(&skinned));
    assert!(
        middle(&morphed).0 > 75.0 && middle(&morphed).1 > 35.0,
        "{:?}",
        middle(&morphed)
    );
    // Every pixel with depth has an object: nothing fell through the test for
    // equal depth.
    let depth = small.depth().expect("a prepass");
    for (i, pixel) in ids.pixels.iter().enumerate() {
        assert_eq!(
            pixel[0] != 0,
            f32::from_bits(depth.bits[i]) > 0.0,
            "pixel {i}"
        );
    }
    assert_eq!(small.errors(), 0);
}
