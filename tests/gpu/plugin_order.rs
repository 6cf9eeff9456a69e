//! `ComicsPlugin` before the engine's plugins does what it does after them.

use crate::{prelude::*, small::camera};

/// A scene that uses every part of the plugin: a style asset, the depth range,
/// outlines, one object's own lines, the toon material.
fn picture(mut headless: Headless) -> (image::RgbaImage, image::RgbaImage) {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let material = StandardMaterial::from(Color::srgb(0.9, 0.5, 0.2));
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    let material = materials.add(material);
    for (x, color) in [(-1.0, None), (1.0, Some(Color::WHITE))] {
        let at = Transform::from_xyz(x, 0.5, 0.0);
        let own = OutlineStyle { color, ..default() };
        let object = (Mesh3d(mesh.clone()), MeshMaterial3d(material.clone()));
        world.spawn((object, at, ToonScene::default(), own));
    }
    let light = Transform::from_xyz(2.0, 4.0, 3.0);
    world.spawn((DirectionalLight::default(), light));
    let camera = world.spawn(camera(target, Msaa::Off)).id();
    headless.step(3);
    let original = headless.picture();
    let world = headless.app.world_mut();
    let style = world
        .resource::<AssetServer>()
        .load(presets::SATURDAY_MORNING.path());
    let own_map = DepthMap {
        smoothing: None,
        ..default()
    };
    world.entity_mut(camera).insert((Comic(style), own_map));
    let has_loaded = |headless: &Headless| headless.app.world().get::<Outlines>(camera).is_some();
    // The file is read on another thread.
    for _ in 0..500 {
        headless.step(1);
        if has_loaded(&headless) {
            break;
        }
        std::thread::yield_now();
    }
    assert!(has_loaded(&headless), "the preset did not load");
    assert_eq!(headless.app.world().get::<DepthMap>(camera), Some(&own_map));
    headless.step(4);
    (original, headless.picture())
}

#[test]
fn before_or_after_the_engines_plugins() {
    let options = options(UVec2::new(48, 32));
    let (original, after) = picture(Headless::new(options.clone(), ComicsPlugin));
    let first = Headless::with_plugins_first(options, ComicsPlugin);
    let (same_original, before) = picture(first);
    assert_ne!(original, after, "nothing was drawn");
    assert!(original == same_original, "the originals differ");
    assert!(
        before == after,
        "the order of the plugins changes the picture"
    );
}
