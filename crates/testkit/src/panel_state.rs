//! What the inspector shows of some cameras, as JSON: for tests, in the same process or in another.

use bevy::{diagnostic::FrameCount, prelude::*};
use bevy_comics::{
    ComicStyle, ComicsDiagnostics, OutlineStyle, SplitView, StyleTransition, StyleWeight,
    ToonMaterial, diagnostics::DebugView, effect::EffectRegistry, toon::ToonShading,
};
use bevy_comics_inspector::ComicsInspector;
use serde_json::{Value, json};

/// The state of the panel, and of these cameras.
pub fn panel_state(world: &mut World, cameras: &[Entity]) -> Value {
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let effects = world.resource::<EffectRegistry>();
    let cameras = cameras.iter().map(|&camera| {
        let entity = world.entity(camera);
        json!({
            "name": entity.get::<Name>().map(|name| name.to_string()),
            "style": ComicStyle::of(entity, effects).to_ron().unwrap_or_default(),
            "compiling": diagnostics.is_compiling(camera),
            "weight": entity.get::<StyleWeight>().map(|weight| weight.0),
            "split": entity.get::<SplitView>().map(|split| split.at),
            "view": entity.get::<DebugView>().map(|view| format!("{view:?}")),
            "fading": entity.contains::<StyleTransition>(),
        })
    });
    let cameras: Vec<Value> = cameras.collect();
    // The panel's camera is the only 2D camera where this is used.
    let panel_cameras = world
        .query_filtered::<(), With<Camera2d>>()
        .iter(world)
        .count();
    let inspector = world.get_resource::<ComicsInspector>();
    json!({
        "frame": world.resource::<FrameCount>().0,
        "open": inspector.map(|inspector| inspector.open),
        "wants_pointer": inspector.map(|inspector| inspector.wants_pointer),
        "picking": inspector.map(|inspector| inspector.picking),
        "picked": picked(world),
        "focused": inspector.and_then(|inspector| inspector.focused.as_ref()),
        "widgets": inspector.map(|inspector| &inspector.widgets),
        "panel_cameras": panel_cameras,
        "cameras": cameras,
    })
}

/// What the panel edits of the picked object.
fn picked(world: &World) -> Option<Value> {
    let picked = world.get_resource::<ComicsInspector>()?.picked?;
    let object = world.get_entity(picked).ok()?;
    let at = object.get::<GlobalTransform>().map(|at| at.translation());
    let light = object
        .get::<MeshMaterial3d<ToonMaterial>>()
        .and_then(|own| world.resource::<Assets<ToonMaterial>>().get(&own.0))
        .and_then(|material| ToonShading::new(material.extension.clone()).to_ron().ok());
    Some(json!({
        "at": at.map(|at| at.to_array()),
        "light": light,
        "is_standard": object.contains::<MeshMaterial3d<StandardMaterial>>(),
        "has_style": object.contains::<OutlineStyle>(),
    }))
}
