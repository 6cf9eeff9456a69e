//! Meshes that are one object: `OutlineGroup`, and the primitives of a glTF node.

use std::fs;

use bevy::world_serialization::WorldAssetRoot;
use serde_json::json;

use crate::{
    ids::{cube, material, put_two_cubes, seam, skinned_and_morphed, total, two_cubes},
    outlines::ink,
    prelude::*,
};

/// The width of the pictures.
const WIDTH: usize = 120;

/// The weakest row of the strongest ink near a column.
fn edge(ink: &[f32], column: usize) -> f32 {
    (25..35)
        .map(|y| {
            let row = &ink[y * WIDTH..][column - 3..column + 3];
            row.iter().copied().fold(0.0, f32::max)
        })
        .fold(1.0, f32::min)
}

/// The strongest ink between the cubes, away from their outlines.
fn inside(ink: &[f32]) -> f32 {
    (25..35)
        .flat_map(|y| ink[y * WIDTH..][54..66].iter().copied())
        .fold(0.0, f32::max)
}

fn lines(small: &mut Small) -> Vec<f32> {
    ink(small, Outlines::default())
}

/// The object's id at a pixel of the middle row.
fn id_at(small: &Small, x: usize) -> u32 {
    small.object_ids().expect("drawn").pixels[30 * WIDTH + x][0]
}

fn group(small: &mut Small, members: &[Entity]) -> Entity {
    let root = small
        .world()
        .spawn((OutlineGroup, Transform::default(), Visibility::default()))
        .id();
    small.world().entity_mut(root).add_children(members);
    root
}

#[test]
fn a_group_has_no_object_edge_inside_and_one_against_others() {
    let (mut small, _) = two_cubes();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let [left, right] = put_two_cubes(&mut small, msaa);
        let plain = material(&mut small, |_| {});
        let other = cube(&mut small, plain, Transform::from_xyz(1.5, 0.0, 0.0));
        assert!(seam(&lines(&mut small)) > 0.9, "without a group");

        let root = group(&mut small, &[left, right]);
        let grouped = lines(&mut small);
        assert!(inside(&grouped) < 0.02, "{msaa:?}: {}", inside(&grouped));
        // The third cube begins at x = 1: 42.6 pixels right of the middle.
        assert!(edge(&grouped, 103) > 0.9, "against an object outside");
        let id = u32::from(object_id(root));
        assert_eq!([id_at(&small, 50), id_at(&small, 70)], [id; 2]);
        assert_eq!(id_at(&small, 110), u32::from(object_id(other)));

        // Two groups are two objects.
        group(&mut small, &[other]);
        assert!(edge(&lines(&mut small), 103) > 0.9, "against another group");
        assert_eq!(small.errors(), 0);
    }
}

#[test]
fn a_group_follows_changes_of_the_hierarchy() {
    let (mut small, [left, right]) = two_cubes();
    let root = group(&mut small, &[left, right]);
    assert!(inside(&lines(&mut small)) < 0.02, "grouped");
    small.world().entity_mut(root).remove::<OutlineGroup>();
    assert!(seam(&lines(&mut small)) > 0.9, "removed");
    small.world().entity_mut(root).insert(OutlineGroup);
    assert!(inside(&lines(&mut small)) < 0.02, "inserted again");

    let second = group(&mut small, &[right]);
    assert!(seam(&lines(&mut small)) > 0.9, "in two groups");
    assert_eq!(id_at(&small, 70), u32::from(object_id(second)));

    // Two levels down, below an entity that is no mesh.
    let between = small
        .world()
        .spawn((
            ChildOf(root),
            Transform::default(),
            Visibility::default(),
            children![],
        ))
        .id();
    small.world().entity_mut(right).insert(ChildOf(between));
    assert!(inside(&lines(&mut small)) < 0.02, "below a descendant");
    small.world().entity_mut(right).insert(OutlineGroup);
    assert!(seam(&lines(&mut small)) > 0.9, "the nearest group counts");
    assert_eq!(id_at(&small, 70), u32::from(object_id(right)));
    small.world().entity_mut(right).remove::<OutlineGroup>();
    assert!(inside(&lines(&mut small)) < 0.02, "and back");

    // The whole branch leaves the group.
    small.world().entity_mut(between).remove::<ChildOf>();
    assert!(seam(&lines(&mut small)) > 0.9, "outside");
    assert_eq!(id_at(&small, 70), u32::from(object_id(right)));
    small.world().entity_mut(between).insert(ChildOf(root));
    assert!(inside(&lines(&mut small)) < 0.02, "inside");

    // The root goes, the cubes stay.
    small.world().entity_mut(root).detach_all_children();
    small.world().despawn(root);
    assert!(seam(&lines(&mut small)) > 0.9, "without a root");
    assert_eq!(id_at(&small, 50), u32::from(object_id(left)));

    // The root goes with everything below it.
    let last = group(&mut small, &[left, right]);
    assert!(inside(&lines(&mut small)) < 0.02);
    small.world().despawn(last);
    assert!(total(&lines(&mut small), 0..WIDTH) < 0.05);
    assert_eq!(small.errors(), 0);
}

#[test]
fn silhouettes_and_styles_inside_a_group_remain() {
    let (mut small, [left, right]) = two_cubes();
    group(&mut small, &[left, right]);
    small
        .world()
        .entity_mut(right)
        .insert(Transform::from_xyz(0.5, 0.0, 0.6));
    let silhouettes = Outlines {
        creases: None,
        ..default()
    };
    let stepped = ink(&mut small, silhouettes);
    assert!(seam(&stepped) > 0.9, "one cube hides a part of the other");

    small.world().entity_mut(left).insert(OutlineStyle {
        color: Some(Color::srgb(1.0, 0.0, 0.0)),
        ..default()
    });
    ink(&mut small, silhouettes);
    let (_, output) = small.pass();
    let red = |columns: Range<usize>| {
        let pixels = output.pixels.iter().enumerate();
        let red = pixels.filter(|(_, p)| p[0] > 0.9 && p[1] < 0.05);
        red.filter(|(i, _)| columns.contains(&(i % WIDTH))).count()
    };
    assert!(red(0..56) > 50, "the style of the left cube");
    assert_eq!(red(64..WIDTH), 0, "the right cube has none");
}

#[test]
fn skinned_and_morphed_meshes_have_the_id_of_their_group() {
    let (mut small, [skinned, morphed]) = skinned_and_morphed();
    let root = group(&mut small, &[skinned, morphed]);
    lines(&mut small);
    let ids = small.object_ids().expect("drawn");
    let id = u32::from(object_id(root));
    let grouped = ids.pixels.iter().filter(|p| p[0] == id).count();
    let any = ids.pixels.iter().filter(|p| p[0] != 0).count();
    assert!(grouped > 200, "{grouped}");
    assert_eq!(grouped, any, "no other id is left");
    assert_eq!(small.errors(), 0);
}

/// Writes a model of quads in one plane: a node with two primitives from x = -1 to 0 and
/// from 0 to 1, and a node with one primitive from 1 to 2. Nothing has a name.
fn write_quads(folder: &Path) {
    let mut bytes = Vec::new();
    let mut push = |values: &[f32]| values.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    for x in [-1.0f32, 0.0, 1.0] {
        for [i, j] in [[0.0, -0.5], [1.0, -0.5], [1.0, 0.5], [0.0, 0.5]] {
            push(&[x + i, j, 0.5]);
        }
    }
    (0..4).for_each(|_| push(&[0.0, 0.0, 1.0]));
    for index in [0u16, 1, 2, 0, 2, 3] {
        bytes.extend(index.to_le_bytes());
    }
    let positions = (0..3).map(|i| {
        let (min, max) = ([f64::from(i) - 1.0, -0.5, 0.5], [f64::from(i), 0.5, 0.5]);
        json!({"bufferView": 0, "byteOffset": 48 * i, "componentType": 5126, "count": 4,
            "type": "VEC3", "min": min, "max": max})
    });
    let mut accessors: Vec<_> = positions.collect();
    accessors.push(
        json!({"bufferView": 0, "byteOffset": 144, "componentType": 5126,
        "count": 4, "type": "VEC3"}),
    );
    accessors.push(json!({"bufferView": 1, "componentType": 5123, "count": 6,
        "type": "SCALAR"}));
    let primitive = |i: usize| json!({"attributes": {"POSITION": i, "NORMAL": 3}, "indices": 4, "material": i % 2});
    let unlit = |color: f32| {
        json!({"pbrMetallicRoughness": {"baseColorFactor": [color, color, color, 1.0]},
            "extensions": {"KHR_materials_unlit": {}}})
    };
    let document = json!({
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"mesh": 1}],
        "meshes": [{"primitives": [primitive(0), primitive(1)]}, {"primitives": [primitive(2)]}],
        "materials": [unlit(0.6), unlit(0.7)],
        "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteLength": 192, "target": 34962},
            {"buffer": 0, "byteOffset": 192, "byteLength": 12, "target": 34963}],
        "buffers": [{"uri": "quads.bin", "byteLength": bytes.len()}],
    });
    fs::write(folder.join("quads.bin"), bytes).expect("written");
    fs::write(folder.join("quads.gltf"), document.to_string()).expect("written");
}

/// An empty view like that of `two_cubes`, with the quads as `quads.gltf`.
fn with_quads() -> Small {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("groups");
    fs::create_dir_all(&folder).expect("a folder");
    write_quads(&folder);
    let mut options = options(UVec2::new(WIDTH as u32, 60));
    options.assets = folder.display().to_string();
    let mut small = Small::with(options, Msaa::Off);
    small.clear();
    small.insert(Transform::from_xyz(0.0, 0.0, 2.2).looking_at(Vec3::ZERO, Vec3::Y));
    small
}

/// Renders until so many meshes are there, loaded.
fn load(small: &mut Small, count: usize) -> Vec<Entity> {
    for _ in 0..500 {
        small.headless.step(1);
        let world = small.world();
        let mut query = world.query::<(Entity, &Mesh3d)>();
        let found: Vec<_> = query.iter(world).map(|(e, m)| (e, m.0.clone())).collect();
        let meshes = world.resource::<Assets<Mesh>>();
        if found.len() == count && found.iter().all(|(_, m)| meshes.contains(m)) {
            return found.into_iter().map(|(entity, _)| entity).collect();
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("the model did not load");
}

#[test]
fn the_primitives_of_a_gltf_node_are_one_object() {
    let mut small = with_quads();
    let assets = small.world().resource::<AssetServer>().clone();
    let scene = WorldAssetRoot(assets.load("quads.gltf#Scene0"));
    let root = small.world().spawn((Object, scene)).id();
    let meshes = load(&mut small, 3);
    let loaded = lines(&mut small);
    assert!(inside(&loaded) < 0.02, "primitives: {}", inside(&loaded));
    assert!(edge(&loaded, 103) > 0.9, "another node is another object");
    let id = id_at(&small, 50);
    assert_eq!(id, id_at(&small, 70));
    let ids = |entities: &[Entity]| -> Vec<u32> {
        let ids = entities.iter().map(|e| u32::from(object_id(*e)));
        ids.collect()
    };
    assert!(ids(&meshes).contains(&id), "the id of a primitive");

    // A primitive with a group of its own is an object of its own, whichever it is.
    let world = small.world();
    let nodes = meshes.iter().map(|mesh| {
        let node = world.get::<ChildOf>(*mesh).expect("a child").parent();
        world.get::<Children>(node).expect("primitives").to_vec()
    });
    let parts = nodes.max_by_key(Vec::len).expect("two nodes");
    assert_eq!(parts.len(), 2);
    for part in parts {
        small.world().entity_mut(part).insert(OutlineGroup);
        assert!(seam(&lines(&mut small)) > 0.9, "separated");
        assert_ne!(id_at(&small, 50), id_at(&small, 70));
        small.world().entity_mut(part).remove::<OutlineGroup>();
        assert!(inside(&lines(&mut small)) < 0.02, "together again");
    }

    // A group on the root joins the nodes too.
    small.world().entity_mut(root).insert(OutlineGroup);
    let whole = lines(&mut small);
    assert!(inside(&whole) < 0.02 && edge(&whole, 103) < 0.02);
    small.world().entity_mut(root).remove::<OutlineGroup>();
    assert!(edge(&lines(&mut small), 103) > 0.9);
    assert_eq!(small.errors(), 0);
}

/// Copies of one primitive below a parent of the game are objects of their own.
#[test]
fn copies_of_a_primitive_below_one_parent_are_several_objects() {
    let mut small = with_quads();
    let assets = small.world().resource::<AssetServer>().clone();
    let plain = material(&mut small, |_| {});
    let world = small.world();
    let parent = world
        .spawn((Object, Transform::default(), Visibility::default()))
        .id();
    for [primitive, x] in [[0, 0], [1, 0], [0, 1], [1, -1]] {
        world.spawn((
            ChildOf(parent),
            Mesh3d(assets.load(format!("quads.gltf#Mesh0/Primitive{primitive}"))),
            MeshMaterial3d(plain.clone()),
            // The copies lie a little in front, where they hide their originals.
            Transform::from_xyz(x as f32, 0.0, if x == 0 { 0.0 } else { 0.001 }),
        ));
    }
    load(&mut small, 4);
    let drawn = lines(&mut small);
    // The copy of primitive 0 lies over primitive 1, and that of primitive 1 over
    // primitive 0: the two copies are one object.
    assert!(inside(&drawn) < 0.02, "the copies are one object");
    let copies = id_at(&small, 50);
    let world = small.world();
    let children = world.get::<Children>(parent).expect("four").to_vec();
    assert_eq!(copies, u32::from(object_id(children[2])));
    // Without one copy, its original is seen next to the other copy.
    world.despawn(children[3]);
    assert!(seam(&lines(&mut small)) > 0.9, "an original and a copy");
    assert_eq!(id_at(&small, 50), u32::from(object_id(children[0])));
    assert_eq!(id_at(&small, 70), u32::from(object_id(children[2])));
    assert_eq!(small.errors(), 0);
}
