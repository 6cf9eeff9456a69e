//! One component gives a camera a whole style.

use bevy::ecs::system::RunSystemOnce;
use bevy_comics::toon::StyleScene;
use bevy_comics_testkit::{
    scenes::{ScenePart, Stage},
    studio::reserve_entities,
};

use crate::prelude::*;

/// The small scene under a sun.
fn lit_scene() -> Small {
    let mut small = Small::new(UVec2::new(160, 90), Msaa::Off);
    let world = small.world();
    for (_, material) in world.resource_mut::<Assets<StandardMaterial>>().iter_mut() {
        material.unlit = false;
    }
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    let at = Transform::from_xyz(2.0, 4.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y);
    world.spawn((Object, sun, at));
    small
}

fn objects(small: &mut Small) -> Vec<Entity> {
    let world = small.world();
    let mut objects = world.query_filtered::<Entity, With<Object>>();
    objects.iter(world).collect()
}

#[test]
fn a_comic_draws_what_its_parts_draw_and_leaves_nothing_behind() {
    let mut small = lit_scene();
    small.insert(DebandDither::Enabled);
    let plain = small.settle().picture();
    let light = ToonLight {
        shadow_strength: 0.8,
        ..default()
    };
    let style = ComicStyle::new()
        .with(ToneBands::default())
        .with(Outlines::default());
    for object in objects(&mut small) {
        let scene = ToonScene::new(light.clone());
        small.world().entity_mut(object).insert(scene);
    }
    small.insert(DebandDither::Disabled);
    let by_hand = small.shot(&style);
    for object in objects(&mut small) {
        small.world().entity_mut(object).remove::<ToonScene>();
    }
    let without = small.shot(&style);
    assert!(changed(&without, &by_hand, 0) > 0.01, "the scene shows");
    let camera = small.camera;
    let world = small.world();
    ComicStyle::remove_from(&mut world.commands().entity(camera));
    world.flush();
    small.insert(DebandDither::Enabled);
    assert!(small.settle().picture() == plain, "and taken away by hand");

    let style = style.with_scene(StyleScene::new(light));
    let mut styles = small.world().resource_mut::<Assets<ComicStyle>>();
    let handle = styles.add(style);
    small.insert(Comic(handle));
    let whole = small.settle().picture();
    assert!(whole == by_hand, "{}", changed(&whole, &by_hand, 0));
    small.camera_mut().remove::<Comic>();
    assert!(small.settle().picture() == plain, "without it");
}

/// A scene in an app that knows of styles the plugin alone.
fn bare(scene: BuiltIn, size: UVec2, comic: impl FnOnce(&mut World) -> Comic) -> image::RgbaImage {
    let mut headless = Headless::new(HeadlessOptions { size, ..default() }, ComicsPlugin);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    reserve_entities(world);
    let vantage = world
        .run_system_once(move |mut stage: Stage| stage.spawn(scene))
        .expect("the stage is there");
    let comic = comic(world);
    world
        .spawn((vantage.camera(), target, Msaa::Off, comic))
        .insert(Tonemapping::default());
    headless.step(4);
    headless.picture()
}

#[ignore = "long: a scene of its own; quick test whole_style::a_comic_draws_what_its_parts_draw_and_leaves_nothing_behind"]
#[test]
fn the_printed_line_draws_the_picture_of_the_gallery() {
    let (scene, size, preset) = (BuiltIn::Theatre, UVec2::new(160, 90), presets::MANGA_PAGE);
    let mut studio = Studio::new(scene, size, Msaa::Off);
    let gallery = studio.shoot(Some(&preset.style()));
    let whole = bare(scene, size, |_| preset.comic());
    assert_eq!(changed(&whole, &gallery, 0), 0.0);

    // All of it by hand, and dots that follow objects.
    let mut followed = preset.style();
    let dots = followed.get_mut::<Halftone>().expect("dots");
    dots.anchor = ScreenAnchor::Object;
    let by_hand = ComicStyle {
        scene: None,
        ..followed.clone()
    };
    let world = studio.headless.app.world_mut();
    let mut parts = world.query_filtered::<Entity, (With<ScenePart>, Without<ChildOf>)>();
    for part in parts.iter(world).collect::<Vec<_>>() {
        world.entity_mut(part).insert(PatternAnchor::default());
    }
    let by_hand = studio.shoot(Some(&by_hand));
    assert!(changed(&by_hand, &gallery, 16) > 0.01, "the dots move");
    followed.scene = followed.scene.map(|scene| StyleScene {
        screens: true,
        ..scene
    });
    let whole = bare(scene, size, |world| {
        Comic(world.resource_mut::<Assets<ComicStyle>>().add(followed))
    });
    assert_eq!(changed(&whole, &by_hand, 0), 0.0);
}
