//! `ComicsPlugin` before the engine's plugins does what it does after them.

use crate::{prelude::*, small::camera};

/// A scene that uses every part of the plugin: a style asset, the depth range,
/// outlines, one object's own lines, the toon material.
fn picture(mut headless: Headless) -> (image::RgbaImage, image::RgbaImage) {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(Cuboid::default());
    let material = StandardMaterial::from(Color::srgb(0.9, 0.5, 0.2));
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(material);
    for x in [-1.0, 1.0] {
        world.spawn((
            Mesh3d(mesh.clone()),
            MeshMaterial3d(material.clone()),
            Transform::from_xyz(x, 0.5, 0.0),
            ToonScene::default(),
            OutlineStyle {
                color: (x > 0.0).then_some(Color::WHITE),
                ..default()
            },
        ));
    }
    world.spawn((
        DirectionalLight::default(),
        Transform::from_xyz(2.0, 4.0, 3.0),
    ));
    let camera = world.spawn(camera(target, Msaa::Off)).id();
    headless.step(3);
    let original = headless.picture();
    let world = headless.app.world_mut();
    let style = world
        .resource::<AssetServer>()
        .load(presets::GRAPHIC_NOVEL.path());
    let own_map = DepthMap {
        smoothing: None,
        ..default()
    };
    world
        .entity_mut(camera)
        .insert((Comic(style.clone()), own_map));
    // The file is read on another thread.
    for _ in 0..500 {
        headless.step(1);
        if headless.app.world().get::<Outlines>(camera).is_some() {
            break;
        }
        std::thread::yield_now();
    }
    assert!(
        headless.app.world().get::<Outlines>(camera).is_some(),
        "the preset did not load"
    );
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
    let apart = |a: &image::RgbaImage, b: &image::RgbaImage| {
        a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
    };
    assert_eq!(
        apart(&original, &same_original),
        0,
        "pixels of the originals differ"
    );
    assert!(
        before == after,
        "the order of the plugins changes the picture"
    );
}
