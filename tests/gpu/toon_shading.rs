//! Shadings of the toon material as files: read, written, loaded, changed on disk, broken; and the
//! shadings of a scene by the names of its materials.

use std::fs;

use bevy::{
    asset::{AssetLoadFailedEvent, AssetPath},
    ecs::message::{MessageCursor, Messages},
    gltf::GltfMaterialName,
    world_serialization::WorldAssetRoot,
};
use bevy_comics::{
    ToonShadingHandle,
    toon::{MaterialName, ToonShadingError},
};

use crate::{
    models::gltf::{Gltf, Part, Shape},
    prelude::*,
    styles::Folder,
};

/// A light in which no field of any type has its default.
fn everything(axis: DetailAxis, form: ProxyShape, width: RimWidth) -> ToonLight {
    let stops = vec![
        RampStop::new(0.125, Color::srgb_u8(12, 34, 56)).soft(0.25),
        RampStop::new(0.5, Color::srgba(0.123_456_7, 0.5, 0.75, 1.0)),
    ];
    ToonLight {
        shadow_threshold: 0.25,
        form_shadows: false,
        cast_shadows: false,
        shadow_strength: 0.5,
        highlight: 2.0,
        highlight_edge: 0.75,
        falloff: 0.5,
        flat_environment: 0.25,
        vertex_threshold: true,
        ramp: Some(Ramp {
            stops: stops.clone(),
            mode: RampMode::Brightest,
            blend: RampBlend::Absolute,
            keep_intensity: 0.75,
            detail: Some(RampDetail { plain: stops, axis }),
        }),
        stylized_highlight: Some(StylizedHighlight {
            shape: HighlightShape::Star,
            frame: HighlightFrame::World,
            size: 2.0,
            offset: Vec2::new(-1.0, 0.5),
            rotation: 30.0,
            scale: Vec2::new(1.5, 0.5),
            split: Vec2::new(0.0, 1.5),
            square: 0.5,
            bar: 0.125,
            points: 7,
            sharpness: 3,
            softness: 2.0,
        }),
        proxy: Some(ShadingProxy {
            shape: form,
            amount: 0.5,
            amount_at_far: 0.25,
            from: 3.0,
            ratio: 7.0,
        }),
        rim: Some(Rim {
            width,
            color: Color::srgb_u8(250, 240, 10),
            strength: 0.5,
            lit_side: 0.25,
        }),
        hatching: Some(Hatching {
            spacing: 5.0,
            layers: 3,
            ink: Color::srgb_u8(1, 2, 3),
            ..default()
        }),
        ramp_map: RampMap::at("ramps/skin.png"),
        // Files have none of these images.
        threshold_map: None,
        art_map: None,
        art_map_repeat: 2.5,
        ..default()
    }
}

/// Shadings that together have every variant of every enum.
pub fn all_kinds() -> Vec<ToonShading> {
    let (center, half_size) = (Vec3::new(0.5, -1.0, 2.0), Vec3::new(1.0, 2.0, 3.0));
    let axes = [
        DetailAxis::Depth {
            from: 2.0,
            ratio: 5.0,
        },
        DetailAxis::Focus {
            distance: 4.0,
            clear: 0.5,
            ratio: 6.0,
        },
        DetailAxis::Rim { power: 2.0 },
        DetailAxis::Highlight { power: 50.0 },
        DetailAxis::Constant(0.25),
        DetailAxis::VisibleRange,
    ];
    let forms = [
        ProxyShape::Up,
        ProxyShape::Ellipsoid { center, half_size },
        ProxyShape::Cylinder { center, half_size },
        ProxyShape::Smoothed { rounds: 7 },
    ];
    let widths = [
        RimWidth::Pixels(3.0),
        RimWidth::Facing {
            fraction: 0.5,
            softness: 0.125,
        },
    ];
    let mut shadings = vec![ToonShading::default()];
    for (k, axis) in axes.into_iter().enumerate() {
        let light = everything(axis, forms[k % forms.len()], widths[k % 2]);
        let name = format!("\"{k}\"\n(ramp)");
        let is_in_range = light == light.clone().sanitized();
        assert!(is_in_range, "every number is in its range");
        shadings.push(ToonShading { name, light });
    }
    shadings
}

/// What is written reads back as it was.
#[test]
fn a_shading_that_was_written_reads_back_the_same() {
    for shading in all_kinds() {
        let text = shading.to_ron().expect("written");
        let again = ToonShading::from_ron(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert_eq!(again, shading, "{text}");
    }
    let short = ToonShading::from_ron("(version: 2)").expect("all else has defaults");
    assert_eq!(short, ToonShading::default());
}

#[test]
fn errors_of_shadings_name_the_line_and_what_is_wrong() {
    let unknown = "(\n    version: 2,\n    light: (\n        shadow_threshhold: 0.1,\n    ),\n)";
    let cases = [
        (unknown, "line 4"),
        (unknown, "shadow_threshhold"),
        ("(version: 2,\n light: (\n", "line 2"),
        (
            "(version: 2, light: (rim: (color: \"reddish\")))",
            "reddish",
        ),
        ("(version: 2, light: (), light: ())", "light"),
        ("(name: \"x\")", "version"),
    ];
    for (text, told) in cases {
        let error = ToonShading::from_ron(text).expect_err("must not read");
        assert!(error.to_string().contains(told), "{text}: {error}");
    }
    // A later version is named even where its entries are not known.
    assert!(matches!(
        ToonShading::from_ron("(version: 7, light: (), sparkle: 3)"),
        Err(ToonShadingError::Version { found: 7, .. })
    ));
}

pub fn watching(folder: &Folder) -> Small {
    let options = HeadlessOptions {
        assets: folder.0.to_string_lossy().into_owned(),
        watch: true,
        ..options(size())
    };
    Small::with(options, Msaa::Off)
}

/// Steps until something is so; false after `tries` times 25 ms.
pub fn wait(small: &mut Small, tries: usize, mut done: impl FnMut(&mut World) -> bool) -> bool {
    (0..tries).any(|_| {
        small.headless.step(1);
        let is_done = done(small.world());
        if !is_done {
            std::thread::sleep(Duration::from_millis(25));
        }
        is_done
    })
}

fn write(folder: &Folder, name: &str, threshold: f32) {
    let text = format!("(\n    version: 2,\n    light: (shadow_threshold: {threshold}),\n)\n");
    fs::write(folder.0.join(format!("{name}.toon.ron")), text).expect("written");
}

/// The threshold of the toon material of a mesh.
fn threshold(world: &World, mesh: Entity) -> Option<f32> {
    let handle = world.get::<MeshMaterial3d<ToonMaterial>>(mesh)?;
    let materials = world.resource::<Assets<ToonMaterial>>();
    Some(materials.get(&handle.0)?.extension.shadow_threshold)
}

pub fn load(small: &mut Small, path: impl Into<AssetPath<'static>>) -> Handle<ToonShading> {
    small.world().resource::<AssetServer>().load(path)
}

/// A mesh with a toon material of its own, that has this shading.
pub fn mesh_with_shading(small: &mut Small, shading: Handle<ToonShading>) -> Entity {
    let material = ToonMaterial {
        base: Color::WHITE.into(),
        extension: ToonLight::default(),
    };
    let mut materials = small.world().resource_mut::<Assets<ToonMaterial>>();
    let material = MeshMaterial3d(materials.add(material));
    let parts = (material, ToonShadingHandle(shading));
    small.put_shared(Cuboid::default(), parts, Transform::IDENTITY)
}

#[test]
fn a_shading_is_loaded_reloaded_and_survives_being_broken() {
    let folder = Folder::new("shadings");
    let file = folder.0.join("hero.toon.ron");
    write(&folder, "hero", 0.25);
    let mut small = watching(&folder);
    let shading = load(&mut small, "hero.toon.ron");
    let mesh = mesh_with_shading(&mut small, shading);
    let has = |x: f32| move |world: &mut World| threshold(world, mesh) == Some(x);
    assert!(wait(&mut small, 400, has(0.25)), "the shading did not load");
    write(&folder, "hero", 0.5);
    assert!(wait(&mut small, 400, has(0.5)), "the change did not arrive");

    // Broken: nothing changes, and what is logged names the line.
    let mut failures = MessageCursor::default();
    failures.clear(messages(small.world()));
    let broken = "(\n    version: 2,\n    light: (shadow_threshold: ,\n";
    fs::write(&file, broken).expect("written");
    let mut told = String::new();
    wait(&mut small, 400, |world| {
        let mut read = failures.read(messages(world));
        told = read
            .next()
            .map(|failure| failure.error.to_string())
            .unwrap_or_default();
        !told.is_empty()
    });
    let is_told = told.contains("line 3") && told.contains("hero.toon.ron");
    assert!(
        is_told,
        "the engine reports the failure, which it logs: {told}"
    );
    small.headless.step(3);
    assert!(has(0.5)(small.world()), "the last good shading is kept");

    write(&folder, "hero", 0.75);
    assert!(wait(&mut small, 400, has(0.75)), "mended, it is back");
    // Without the component the material stays.
    small.world().entity_mut(mesh).remove::<ToonShadingHandle>();
    small.headless.step(2);
    assert!(has(0.75)(small.world()));
}

pub fn messages(world: &World) -> &Messages<AssetLoadFailedEvent<ToonShading>> {
    world.resource()
}

/// Two balls, whose materials are called Skin and Coat, and a box whose material has no name.
fn named_model() -> Gltf {
    let parts = [
        (Shape::Ball, [-1.0, 0.0, 0.0]),
        (Shape::Ball, [1.0, 0.0, 0.0]),
        (Shape::Box, [0.0, 1.0, 0.0]),
    ];
    let parts = parts.map(|(shape, at)| Part::new(shape, at, [0.5; 3], [0.5; 3]));
    let mut model = Gltf::new(&parts, 1.0, [0.0; 3]);
    for (k, name) in ["Skin", "Coat"].into_iter().enumerate() {
        model.json["materials"][k]["name"] = name.into();
    }
    model
}

/// The meshes of the model: that of each name, and the one without a name.
fn model_meshes(world: &mut World) -> Option<[Entity; 3]> {
    let mut meshes = world.query_filtered::<(Entity, Option<&GltfMaterialName>), (
        With<MeshMaterial3d<ToonMaterial>>,
        With<ChildOf>,
    )>();
    let mut find = |name: Option<&str>| {
        meshes
            .iter(world)
            .find_map(|(entity, has)| (has.map(|has| has.0.as_str()) == name).then_some(entity))
    };
    Some([find(Some("Skin"))?, find(Some("Coat"))?, find(None)?])
}

#[test]
fn a_scene_has_a_shading_and_others_by_the_names_of_its_materials() {
    let folder = Folder::new("scene-shadings");
    for (name, threshold) in [("all", 0.125), ("skin", 0.25), ("own", 0.5)] {
        write(&folder, name, threshold);
    }
    named_model().write_glb(&folder.0.join("model.glb"));
    let mut small = watching(&folder);
    let [all, skin, own] =
        ["all.toon.ron", "skin.toon.ron", "own.toon.ron"].map(|path| load(&mut small, path));
    let scene = ToonScene::new(ToonLight {
        shadow_threshold: 0.0625,
        ..default()
    });
    let model = GltfAssetLabel::Scene(0).from_asset("model.glb");
    let model = small.world().resource::<AssetServer>().load(model);
    let root = (small.world().spawn((WorldAssetRoot(model), scene.clone()))).id();
    assert!(wait(&mut small, 400, |world| model_meshes(world).is_some()));
    let meshes = model_meshes(small.world()).expect("loaded");
    let all_are = |expected: [f32; 3]| {
        move |world: &mut World| meshes.map(|mesh| threshold(world, mesh)) == expected.map(Some)
    };
    // Only the scene's own light.
    assert!(wait(&mut small, 40, all_are([0.0625; 3])));
    // A shading for all; then another one for one material; then for one mesh.
    let looked = scene.clone().with_shading(all);
    small.world().entity_mut(root).insert(looked.clone());
    assert!(wait(&mut small, 400, all_are([0.125; 3])));
    let named = looked.clone().with_override("Skin", skin);
    small.world().entity_mut(root).insert(named);
    assert!(wait(&mut small, 400, all_are([0.25, 0.125, 0.125])));
    (small.world().entity_mut(meshes[1])).insert(ToonShadingHandle(own));
    assert!(wait(&mut small, 400, all_are([0.25, 0.5, 0.125])));
    // All follow their files.
    for (name, threshold) in [("all", 0.375), ("skin", 0.625), ("own", 0.875)] {
        write(&folder, name, threshold);
    }
    assert!(wait(&mut small, 400, all_are([0.625, 0.875, 0.375])));
    // And back, one after the other.
    let own = meshes[1];
    small.world().entity_mut(own).remove::<ToonShadingHandle>();
    assert!(wait(&mut small, 40, all_are([0.625, 0.375, 0.375])));
    small.world().entity_mut(root).insert(looked);
    assert!(wait(&mut small, 40, all_are([0.375; 3])));
    small.world().entity_mut(root).insert(scene);
    assert!(wait(&mut small, 40, all_are([0.0625; 3])));
    small.world().entity_mut(root).remove::<ToonScene>();
    small.headless.step(2);
    for mesh in meshes {
        let standard = small.world().get::<MeshMaterial3d<StandardMaterial>>(mesh);
        assert!(standard.is_some());
    }
}

/// A mesh that code made and named has its shading from the first frame on that the shading is
/// there, and meshes with the same material and shading share one copy.
#[test]
fn meshes_made_by_code_have_shadings_by_name_too() {
    let mut small = Small::new(size(), Msaa::Off);
    small.clear();
    let shading = |shadow_threshold: f32| {
        ToonShading::new(ToonLight {
            shadow_threshold,
            ..default()
        })
    };
    let mut shadings = small.world().resource_mut::<Assets<ToonShading>>();
    let handle = shadings.add(shading(0.25));
    let mut materials = small.world().resource_mut::<Assets<StandardMaterial>>();
    let shared = MeshMaterial3d(materials.add(Color::WHITE));
    let scene = ToonScene::default().with_override("Skin", handle.clone());
    let root = small
        .world()
        .spawn((scene, Transform::default(), Visibility::default()));
    let root = root.id();
    let named = ["Skin", "Coat", "Skin"].map(|name| {
        let parts = (shared.clone(), MaterialName::from(name), ChildOf(root));
        small.put_shared(Cuboid::default(), parts, Transform::IDENTITY)
    });
    small.headless.step(1);
    let default = ToonLight::default().shadow_threshold;
    let found = named.map(|mesh| threshold(small.world(), mesh));
    assert_eq!(found, [Some(0.25), Some(default), Some(0.25)]);
    let world = small.world();
    let copy = |mesh| world.get::<MeshMaterial3d<ToonMaterial>>(mesh);
    assert_eq!(copy(named[0]), copy(named[2]));
    assert_ne!(copy(named[0]), copy(named[1]));
    // A shading that is changed by code is followed as well.
    let mut shadings = small.world().resource_mut::<Assets<ToonShading>>();
    *shadings.get_mut(&handle).expect("it is there") = shading(0.5);
    small.headless.step(2);
    assert_eq!(threshold(small.world(), named[0]), Some(0.5));
    // Another name is another shading.
    (small.world().entity_mut(named[0])).insert(MaterialName::from("Coat"));
    small.headless.step(2);
    assert_eq!(threshold(small.world(), named[0]), Some(default));
}
