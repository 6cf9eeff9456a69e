//! One component gives a camera a whole style.

use bevy_comics::toon::StyleScene;

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
