//! Meshes that are one object: `OutlineGroup`, and the primitives of a glTF node.

use std::fs;

use bevy::world_serialization::WorldAssetRoot;
use bevy_comics::objects::SplitPrimitives;
use serde_json::json;

use crate::{
    ids::{cube, edge, material, put_two_cubes, seam, total, two_cubes},
    outlines::ink,
    prelude::*,
};

/// The width of the pictures.
const WIDTH: usize = 120;

/// The strongest ink between the cubes, away from their outlines.
fn inside(ink: &[f32]) -> f32 {
    let row = |y: usize| ink[y * WIDTH..][54..66].iter().copied();
    (25..35).flat_map(row).fold(0.0, f32::max)
}

fn lines(small: &mut Small) -> Vec<f32> {
    ink(small, Outlines::default())
}

/// The cubes, or quads, are one object.
fn assert_one(small: &mut Small, what: &str) {
    let ink = inside(&lines(small));
    assert!(ink < 0.02, "{what}: {ink}");
}

/// They are two objects.
fn assert_two(small: &mut Small, what: &str) {
    let ink = seam(&lines(small));
    assert!(ink > 0.9, "{what}: {ink}");
}

/// The object's id at a pixel of the middle row.
fn id_at(small: &Small, x: usize) -> u32 {
    small.ids()[30 * WIDTH + x]
}

fn group(small: &mut Small, members: &[Entity]) -> Entity {
    let parts = (OutlineGroup, Transform::default(), Visibility::default());
    small.world().spawn(parts).add_children(members).id()
}

#[test]
fn a_group_has_no_object_edge_inside_and_one_against_others() {
    let (mut small, _) = two_cubes();
    for msaa in [Msaa::Off, Msaa::Sample4] {
        let [left, right] = put_two_cubes(&mut small, msaa);
        let plain = material(&mut small, |_| {});
        let other = cube(&mut small, plain, Transform::from_xyz(1.5, 0.0, 0.0));
        assert_two(&mut small, "without a group");

        let root = group(&mut small, &[left, right]);
        assert_one(&mut small, "grouped");
        // The third cube begins at x = 1: 42.6 pixels right of the middle.
        let grouped = lines(&mut small);
        assert!(edge(&grouped, 100..106) > 0.9, "against an object outside");
        let found = [50, 70, 110].map(|x| id_at(&small, x));
        assert_eq!(
            found,
            [root, root, other].map(|object| small.id_of(object)),
            "{msaa:?}"
        );

        // Two groups are two objects.
        group(&mut small, &[other]);
        assert!(
            edge(&lines(&mut small), 100..106) > 0.9,
            "against another group"
        );
    }
}

#[test]
fn a_group_follows_changes_of_the_hierarchy() {
    let (mut small, [left, right]) = two_cubes();
    let root = group(&mut small, &[left, right]);
    assert_one(&mut small, "grouped");
    small.on(root).remove::<OutlineGroup>();
    assert_two(&mut small, "removed");
    small.on(root).insert(OutlineGroup);
    assert_one(&mut small, "inserted again");

    let second = group(&mut small, &[right]);
    assert_two(&mut small, "in two groups");
    assert_eq!(id_at(&small, 70), small.id_of(second));

    // Two levels down, below an entity that is no mesh.
    let parts = (ChildOf(root), Transform::default(), Visibility::default());
    let between = small.world().spawn(parts).id();
    small.on(right).insert(ChildOf(between));
    assert_one(&mut small, "below a descendant");
    small.on(right).insert(OutlineGroup);
    assert_two(&mut small, "the nearest group counts");
    assert_eq!(id_at(&small, 70), small.id_of(right));
    small.on(right).remove::<OutlineGroup>();
    assert_one(&mut small, "and back");

    // The whole branch leaves the group.
    small.on(between).remove::<ChildOf>();
    assert_two(&mut small, "outside");
    assert_eq!(id_at(&small, 70), small.id_of(right));
    small.on(between).insert(ChildOf(root));
    assert_one(&mut small, "inside");

    // The root goes, the cubes stay.
    small.on(root).detach_all_children();
    small.world().despawn(root);
    assert_two(&mut small, "without a root");
    assert_eq!(id_at(&small, 50), small.id_of(left));

    // The root goes with everything below it.
    let last = group(&mut small, &[left, right]);
    assert_one(&mut small, "with a new root");
    small.world().despawn(last);
    assert!(total(&lines(&mut small), 0..WIDTH) < 0.05);
}

#[test]
fn silhouettes_and_styles_inside_a_group_remain() {
    let (mut small, [left, right]) = two_cubes();
    group(&mut small, &[left, right]);
    let before = Transform::from_xyz(0.5, 0.0, 0.6);
    small.on(right).insert(before);
    let silhouettes = Outlines {
        creases: None,
        ..default()
    };
    let stepped = ink(&mut small, silhouettes);
    assert!(seam(&stepped) > 0.9, "one cube hides a part of the other");

    small.on(left).insert(OutlineStyle {
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

/// Writes a model of quads in one plane: a node with two primitives from x = -1 to 0 and
/// from 0 to 1, and a node with one primitive from 1 to 2. Nothing has a name.
fn write_quads(folder: &Path) {
    const CORNERS: [[f32; 2]; 6] = [[0., 0.], [1., 0.], [1., 1.], [0., 0.], [1., 1.], [0., 1.]];
    let lefts = [-1.0f32, 0.0, 1.0];
    let places = lefts.map(|left| CORNERS.map(|[x, y]| [left + x, y - 0.5, 0.5]));
    let values = places.as_flattened().as_flattened().iter();
    let bytes: Vec<u8> = values.flat_map(|value| value.to_le_bytes()).collect();
    let accessor = |i: usize| {
        let [min, max] = [places[i][0], places[i][2]];
        json!({"bufferView": 0, "byteOffset": 72 * i, "componentType": 5126, "count": 6,
            "type": "VEC3", "min": min, "max": max})
    };
    let primitive = |i: usize| json!({"attributes": {"POSITION": i}, "material": i % 2});
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
        "accessors": [accessor(0), accessor(1), accessor(2)],
        "bufferViews": [{"buffer": 0, "byteLength": bytes.len(), "target": 34962}],
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
    assert_one(&mut small, "primitives");
    let is_apart = |small: &mut Small| edge(&lines(small), 100..106) > 0.9;
    assert!(is_apart(&mut small), "another node is another object");
    let id = id_at(&small, 50);
    assert_eq!(id, id_at(&small, 70));
    let is_primitive = meshes.iter().any(|mesh| small.id_of(*mesh) == id);
    assert!(is_primitive, "the id of a primitive");

    // A primitive with a group of its own is an object of its own, whichever it is.
    let world = small.world();
    let nodes = meshes.iter().map(|mesh| {
        let node = world.get::<ChildOf>(*mesh).expect("a child").parent();
        world.get::<Children>(node).expect("primitives").to_vec()
    });
    let parts = nodes.max_by_key(Vec::len).expect("two nodes");
    assert_eq!(parts.len(), 2);
    for part in parts {
        small.on(part).insert(OutlineGroup);
        assert_two(&mut small, "separated");
        assert_ne!(id_at(&small, 50), id_at(&small, 70));
        small.on(part).remove::<OutlineGroup>();
        assert_one(&mut small, "together again");
    }

    small.on(root).insert(SplitPrimitives);
    assert_two(&mut small, "split");
    small.on(root).remove::<SplitPrimitives>();
    assert_one(&mut small, "no longer split");

    // A group on the root joins the nodes too.
    small.on(root).insert(OutlineGroup);
    assert_one(&mut small, "a group on the root");
    assert!(edge(&lines(&mut small), 100..106) < 0.02);
    small.on(root).remove::<OutlineGroup>();
    assert!(is_apart(&mut small));
}

/// Copies of one primitive below a parent of the game are objects of their own.
#[test]
fn copies_of_a_primitive_below_one_parent_are_several_objects() {
    let mut small = with_quads();
    let assets = small.world().resource::<AssetServer>().clone();
    let plain = material(&mut small, |_| {});
    let world = small.world();
    let parts = (Object, Transform::default(), Visibility::default());
    let parent = world.spawn(parts).id();
    for [primitive, x] in [[0, 0], [1, 0], [0, 1], [1, -1]] {
        let path = format!("quads.gltf#Mesh0/Primitive{primitive}");
        // The copies lie a little in front, where they hide their originals.
        let z = if x == 0 { 0.0 } else { 0.001 };
        let at = Transform::from_xyz(x as f32, 0.0, z);
        let mesh = Mesh3d(assets.load(path));
        world.spawn((ChildOf(parent), mesh, MeshMaterial3d(plain.clone()), at));
    }
    load(&mut small, 4);
    // The copy of primitive 0 lies over primitive 1, and that of primitive 1 over
    // primitive 0: the two copies are one object.
    assert_one(&mut small, "the copies");
    let world = small.world();
    let children = world.get::<Children>(parent).expect("four").to_vec();
    assert_eq!(id_at(&small, 50), small.id_of(children[2]));
    // Without one copy, its original is seen next to the other copy.
    small.world().despawn(children[3]);
    assert_two(&mut small, "an original and a copy");
    let found = [50, 70].map(|x| id_at(&small, x));
    assert_eq!(
        found,
        [children[0], children[2]].map(|object| small.id_of(object))
    );
}
