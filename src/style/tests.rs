//! Styles over a camera's own look.

mod grades;

use std::any::TypeId;

use bevy::{
    camera::visibility::RenderLayers,
    prelude::*,
    reflect::{
        TypeRegistry,
        serde::{ReflectDeserializer, ReflectSerializer},
    },
    tasks::tick_global_task_pools_on_main_thread,
};
use serde::de::DeserializeSeed;

use super::{Comic, ComicStyle, InStyleVolumes, StyleTransition, StyleVolume, presets};
use crate::{
    ComicsPlugin, Contours, DepthMap, DepthMapping, Desaturation, Outlines, Vignette,
    effect::EffectRegistry,
};

fn fixed() -> DepthMap {
    DepthMap {
        mapping: DepthMapping::Fixed {
            from: 2.0,
            to: 50.0,
        },
        ..DepthMap::default()
    }
}

fn outlines(width: f32) -> Outlines {
    Outlines {
        width,
        ..Outlines::default()
    }
}

fn contours(width: f32) -> Contours {
    Contours {
        width,
        ..Contours::default()
    }
}

/// A camera with outlines and a fixed range of its own, in an app without a
/// renderer.
fn app() -> (App, Entity) {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        AssetPlugin::default(),
        ComicsPlugin,
    ));
    let camera = (Camera3d::default(), outlines(1.0), fixed());
    let camera = app.world_mut().spawn(camera).id();
    (app, camera)
}

fn apply(app: &mut App, camera: Entity, style: &ComicStyle) {
    style.apply(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
}

fn take_off(app: &mut App, camera: Entity) {
    ComicStyle::remove_from(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
}

fn look(app: &App, camera: Entity) -> ComicStyle {
    let registry = app.world().resource::<EffectRegistry>();
    ComicStyle::of(app.world().entity(camera), registry)
}

#[test]
fn a_complete_style_decides_about_every_effect_but_keeps_the_depth_map() {
    let (mut app, camera) = app();
    let own = look(&app, camera);
    apply(&mut app, camera, &ComicStyle::new().with(contours(3.0)));
    let worn = look(&app, camera);
    assert_eq!(worn.get::<Outlines>(), None);
    assert_eq!(worn.get::<Contours>(), Some(&contours(3.0)));
    assert_eq!(worn.depth_map, Some(fixed()));
    // A style with a map, and another one without: the camera's own again.
    let mapped = ComicStyle::new().with_depth_map(DepthMap::default());
    apply(&mut app, camera, &mapped);
    assert_eq!(look(&app, camera).depth_map, Some(DepthMap::default()));
    apply(&mut app, camera, &ComicStyle::new());
    assert_eq!(look(&app, camera).depth_map, Some(fixed()));
    take_off(&mut app, camera);
    assert_eq!(look(&app, camera), own);
}

#[test]
fn a_partial_style_leaves_alone_what_it_does_not_mention() {
    let (mut app, camera) = app();
    let vignette = ComicStyle::new().partial().with(Vignette::default());
    apply(&mut app, camera, &vignette);
    let worn = look(&app, camera);
    assert_eq!(worn.get::<Outlines>(), Some(&outlines(1.0)));
    assert_eq!(worn.get::<Vignette>(), Some(&Vignette::default()));
    assert_eq!(worn.depth_map, Some(fixed()));

    // The next style takes its place: no vignette, and the outlines are off.
    let without = ComicStyle::new()
        .partial()
        .with(contours(3.0))
        .turn_off::<Outlines>();
    apply(&mut app, camera, &without);
    let worn = look(&app, camera);
    assert_eq!(worn.get::<Outlines>(), None);
    assert_eq!(worn.get::<Vignette>(), None);
    assert_eq!(worn.get::<Contours>(), Some(&contours(3.0)));

    // What the style changed comes back as it was.
    let wide = ComicStyle::new().partial().with(outlines(9.0));
    apply(&mut app, camera, &wide);
    assert_eq!(look(&app, camera).get(), Some(&outlines(9.0)));
    take_off(&mut app, camera);
    let own = look(&app, camera);
    assert_eq!(own.get::<Outlines>(), Some(&outlines(1.0)));
    assert_eq!(own.effects().count(), 1);
}

#[test]
fn what_the_game_changes_under_a_style_is_its_own() {
    let (mut app, camera) = app();
    let style = ComicStyle::new().partial().with(contours(3.0));
    apply(&mut app, camera, &style);
    // Effects that the style does not mention, and a new one, belong to the game.
    let mut entity = app.world_mut().entity_mut(camera);
    entity.insert((outlines(4.0), Desaturation::default(), contours(8.0)));
    entity.remove::<DepthMap>();
    take_off(&mut app, camera);
    let own = look(&app, camera);
    assert_eq!(own.get::<Outlines>(), Some(&outlines(4.0)));
    assert_eq!(own.get::<Desaturation>(), Some(&Desaturation::default()));
    assert_eq!(own.get::<Contours>(), None, "an edit of what the style set");
    assert_eq!(own.depth_map, None);
    // Nothing lies over the camera any more.
    app.world_mut().entity_mut(camera).insert(contours(2.0));
    take_off(&mut app, camera);
    assert_eq!(look(&app, camera).get(), Some(&contours(2.0)));
}

#[test]
fn a_style_can_become_the_cameras_own() {
    let (mut app, camera) = app();
    apply(&mut app, camera, &ComicStyle::new().with(contours(3.0)));
    let own = ComicStyle::new().with(Vignette::default());
    own.set_as_own(&mut app.world_mut().commands().entity(camera));
    app.world_mut().flush();
    take_off(&mut app, camera);
    assert_eq!(look(&app, camera), own);
}

#[test]
fn an_edit_of_an_applied_style_leaves_the_own_look_alone() {
    let (mut app, camera) = app();
    let own = look(&app, camera);
    let partial = ComicStyle::new().partial().with(contours(3.0));
    apply(&mut app, camera, &partial);
    let mut edited = look(&app, camera).with(contours(9.0));
    edited.depth_map = None;
    let edit = |app: &mut App, style: &ComicStyle| {
        style.edit(&mut app.world_mut().commands().entity(camera));
        app.world_mut().flush();
    };
    edit(&mut app, &edited);
    assert_eq!(look(&app, camera), edited);
    take_off(&mut app, camera);
    let without_map = ComicStyle {
        depth_map: None,
        ..own
    };
    assert_eq!(look(&app, camera), without_map);
    // Without an applied style, the camera's own style is edited.
    edit(&mut app, &edited);
    take_off(&mut app, camera);
    assert_eq!(look(&app, camera), edited);
}

#[test]
fn over_is_what_apply_does() {
    let base = ComicStyle::new()
        .with(outlines(1.0))
        .with_depth_map(fixed());
    let partial = ComicStyle::new().partial().with(contours(3.0));
    let both = partial.over(&base);
    assert_eq!(both.get::<Outlines>(), Some(&outlines(1.0)));
    assert_eq!(both.get::<Contours>(), Some(&contours(3.0)));
    assert!(!both.partial);
    let off = ComicStyle::new().partial().turn_off::<Outlines>();
    assert_eq!(off.over(&base).get::<Outlines>(), None);
    // Partial styles merge into a partial style that does the same.
    let merged = off.over(&partial);
    assert!(merged.partial);
    assert_eq!(merged.over(&base), off.over(&partial.over(&base)));
    let merged = partial.over(&off);
    assert_eq!(merged.over(&base), partial.over(&off.over(&base)));
    let complete = ComicStyle::new().with(contours(3.0));
    assert_eq!(complete.over(&base).get::<Outlines>(), None);
}

#[test]
fn a_transition_to_a_partial_style_keeps_the_cameras_own() {
    let (mut app, camera) = app();
    apply(
        &mut app,
        camera,
        &ComicStyle::new().partial().with(contours(3.0)),
    );
    let target = ComicStyle::new().partial().with(Vignette::default());
    let transition = StyleTransition::to(target, 0.0);
    app.world_mut().entity_mut(camera).insert(transition);
    app.update();
    app.update();
    let end = look(&app, camera);
    assert_eq!(end.get::<Outlines>(), Some(&outlines(1.0)));
    assert_eq!(end.get::<Vignette>(), Some(&Vignette::default()));
    assert_eq!(end.get::<Contours>(), None, "the last style's");
    assert_eq!(end.depth_map, Some(fixed()));
}

#[test]
fn a_transition_to_a_preset_takes_the_place_of_another() {
    let (mut app, camera) = app();
    let targets = [(presets::LIGNE_CLAIRE, 1.0), (presets::NOIR, 0.0)];
    for (preset, seconds) in targets {
        let transition = StyleTransition::to_asset(preset.handle(), seconds);
        app.world_mut().entity_mut(camera).insert(transition);
        app.update();
    }
    assert_eq!(look(&app, camera).effects, presets::NOIR.style().effects);
}

/// The width of a style's outlines, and how many effects it has.
fn lines_and_effects(look: &ComicStyle) -> (Option<f32>, usize) {
    let width = look.get::<Outlines>().map(|lines| lines.width);
    (width, look.effects.iter().count())
}

/// The style of a camera in an app with volumes, after it was moved to a place on the x axis.
fn look_at(app: &mut App, camera: Entity, x: f32) -> ComicStyle {
    let place = GlobalTransform::from_xyz(x, 0.0, 0.0);
    app.world_mut().entity_mut(camera).insert(place);
    app.update();
    look(app, camera)
}

#[test]
fn cameras_have_the_styles_of_the_volumes_that_they_are_in() {
    let (mut app, camera) = app();
    let place = GlobalTransform::from_scale(Vec3::splat(2.0));
    let mut volume = |style: ComicStyle, margin, priority| {
        let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
        let style = styles.add(style);
        let volume = StyleVolume {
            style,
            margin,
            priority,
        };
        let shown = InheritedVisibility::VISIBLE;
        app.world_mut().spawn((volume, place, shown)).id()
    };
    let wide = ComicStyle::new().with(outlines(3.0));
    let dark = ComicStyle::new().with(Vignette::default()).partial();
    let dark_volume = volume(dark.clone(), 1.0, 1);
    let wide_volume = volume(wide.clone(), 2.0, 0);
    let own = look_at(&mut app, camera, 0.5);
    assert_eq!(own.get(), Some(&outlines(1.0)), "not in volumes");
    app.world_mut().entity_mut(camera).insert(InStyleVolumes);

    // The one of the higher priority lies over the other; the depth map is the camera's own.
    let inside = look_at(&mut app, camera, 0.5);
    assert_eq!(inside.get(), Some(&outlines(3.0)));
    assert_eq!(inside.get(), Some(&Vignette::default()));
    assert_eq!(inside.depth_map, own.depth_map);
    let below = own.blend(&wide.over(&own), 0.75);
    let want = below.blend(&dark.over(&below), 0.5);
    assert_eq!(look_at(&mut app, camera, 1.5).effects, want.effects);
    assert_eq!(look_at(&mut app, camera, 9.0), own);
    look_at(&mut app, camera, 1.5);

    // Hidden, on another layer, and gone.
    *app.world_mut().get_mut(dark_volume).expect("a volume") = InheritedVisibility::HIDDEN;
    assert_eq!(look_at(&mut app, camera, 1.5).effects, below.effects);
    let layer = RenderLayers::layer(3);
    app.world_mut()
        .entity_mut(wide_volume)
        .insert(layer.clone());
    assert_eq!(look_at(&mut app, camera, 1.5), own);
    app.world_mut().entity_mut(camera).insert(layer);
    assert_eq!(look_at(&mut app, camera, 0.0).get(), Some(&outlines(3.0)));
    app.world_mut()
        .entity_mut(camera)
        .remove::<InStyleVolumes>();
    assert_eq!(look_at(&mut app, camera, 0.0), own);
}

#[test]
fn volumes_lie_over_the_style_that_was_applied_last() {
    let (mut app, camera) = app();
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let [first, second] = [5.0, 7.0].map(|width| ComicStyle::new().with(outlines(width)));
    let handle = styles.add(first.clone());
    let dark = ComicStyle::new().with(Vignette::default()).partial();
    let volume = StyleVolume {
        style: styles.add(dark),
        ..StyleVolume::default()
    };
    let shown = InheritedVisibility::VISIBLE;
    app.world_mut()
        .spawn((volume, GlobalTransform::IDENTITY, shown));
    let parts = (InStyleVolumes, Comic(handle.clone()));
    app.world_mut().entity_mut(camera).insert(parts);
    let inside = look_at(&mut app, camera, 0.0);
    assert_eq!(lines_and_effects(&inside), (Some(5.0), 2));

    // Its file changes.
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    *styles.get_mut(&handle).expect("a style") = second.clone();
    for _ in 0..2 {
        app.update();
    }
    let inside = look_at(&mut app, camera, 0.0);
    assert_eq!(lines_and_effects(&inside), (Some(7.0), 2));
    assert_eq!(look_at(&mut app, camera, 9.0).effects, second.effects);

    // A transition within the volume arrives, and the volume lies over it again.
    look_at(&mut app, camera, 0.0);
    app.world_mut()
        .entity_mut(camera)
        .insert(StyleTransition::to(first.clone(), 0.0));
    for _ in 0..3 {
        app.update();
    }
    let inside = look_at(&mut app, camera, 0.0);
    assert_eq!(lines_and_effects(&inside), (Some(5.0), 2));
    assert_eq!(look_at(&mut app, camera, 9.0).effects, first.effects);
    app.world_mut().entity_mut(camera).remove::<Comic>();
    assert_eq!(
        lines_and_effects(&look_at(&mut app, camera, 9.0)).0,
        Some(1.0)
    );
}

#[test]
fn what_volumes_say_nothing_about_belongs_to_the_game() {
    let (mut app, camera) = app();
    let mut styles = app.world_mut().resource_mut::<Assets<ComicStyle>>();
    let volume = StyleVolume {
        style: styles.add(ComicStyle::new().with(Vignette::default()).partial()),
        margin: 1.0,
        ..StyleVolume::default()
    };
    let wide = styles.add(ComicStyle::new().with(outlines(3.0)));
    let volume = (
        volume,
        GlobalTransform::IDENTITY,
        InheritedVisibility::VISIBLE,
    );
    let volume = app.world_mut().spawn(volume).id();
    app.world_mut().entity_mut(camera).insert(InStyleVolumes);
    look_at(&mut app, camera, 0.9);
    let added = (outlines(4.0), Desaturation::default());
    app.world_mut().entity_mut(camera).insert(added);
    let look = look_at(&mut app, camera, 0.8);
    assert_eq!(lines_and_effects(&look), (Some(4.0), 3));
    app.world_mut().entity_mut(camera).remove::<Desaturation>();
    let mut edited = look_at(&mut app, camera, 0.7);
    assert_eq!(lines_and_effects(&edited), (Some(4.0), 2));

    // A panel edits what it sees; the volume stays a volume.
    edited.insert(outlines(6.0));
    edited.edit(&mut app.world_mut().commands().entity(camera));
    let look = look_at(&mut app, camera, 0.9);
    let amount = look.get::<Vignette>().map(|corners| corners.amount);
    assert_eq!(lines_and_effects(&look), (Some(6.0), 2));
    assert!(amount < edited.get::<Vignette>().map(|corners| corners.amount));
    let outside = look_at(&mut app, camera, 9.0);
    assert_eq!(lines_and_effects(&outside), (Some(6.0), 1));

    look_at(&mut app, camera, 0.0);
    app.world_mut()
        .get_mut::<StyleVolume>(volume)
        .expect("a volume")
        .style = wide;
    assert_eq!(
        lines_and_effects(&look_at(&mut app, camera, 0.0)).0,
        Some(3.0)
    );
}

#[test]
fn partial_styles_are_files_too() {
    let text = "(version: 3, partial: true, contours: None, outlines: (width: 3.0))";
    let style = ComicStyle::from_ron(text).expect("readable");
    let made = ComicStyle::new()
        .partial()
        .with(outlines(3.0))
        .turn_off::<Contours>();
    let written = style.to_ron().expect("writable");
    assert_eq!(written, made.to_ron().expect("writable"));
    assert_eq!(style.off, made.off);
    // Colors come back in another space, so the text is compared.
    let again = ComicStyle::from_ron(&written).expect("readable");
    assert_eq!(again.to_ron().expect("writable"), written);
    // A complete style needs no entry for what is off.
    let complete = ComicStyle::from_ron("(version: 3, contours: None)").expect("readable");
    assert_eq!(complete, ComicStyle::new());
    // What a default style writes can be read.
    let text = ComicStyle::default().to_ron().expect("writable");
    assert_eq!(
        ComicStyle::from_ron(&text).expect("readable"),
        ComicStyle::new()
    );
}

/// Loads until the camera has the style, or fails.
fn load(app: &mut App, handle: &Handle<ComicStyle>) -> ComicStyle {
    for _ in 0..1000 {
        app.update();
        tick_global_task_pools_on_main_thread();
        let styles = app.world().resource::<Assets<ComicStyle>>();
        if let Some(style) = styles.get(handle) {
            return style.clone();
        }
        std::thread::yield_now();
    }
    panic!("{handle:?} does not load");
}

#[test]
fn every_preset_is_an_asset_that_a_template_can_name() {
    let (mut app, camera) = app();
    app.finish();
    app.cleanup();
    for preset in presets::ALL {
        let assets = app.world().resource::<AssetServer>().clone();
        let handle = assets.load(preset.path());
        assert_eq!(load(&mut app, &handle), preset.style(), "{preset}");
    }
    // As a scene in code does it: the template holds the path.
    let template = super::ComicTemplate(presets::NOIR.path().into());
    let mut entity = app.world_mut().entity_mut(camera);
    let handle = entity.build_template(&template).expect("a handle");
    entity.insert(handle.clone());
    load(&mut app, &handle.0);
    app.update();
    let noir = presets::NOIR.style();
    assert!(noir.effects().count() > 0);
    assert_eq!(look(&app, camera).effects, noir.effects);
    app.world_mut().entity_mut(camera).remove::<Comic>();
    app.update();
    assert_eq!(look(&app, camera).get::<Outlines>(), Some(&outlines(1.0)));
    let _: <Comic as FromTemplate>::Template = template;
}

#[test]
fn every_effect_and_style_serializes_by_reflection() {
    let (app, _) = app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let style = presets::WATERCOLOR.style();
    let text = ron::to_string(&ReflectSerializer::new(&style, &registry)).expect("written");
    let mut deserializer = ron::Deserializer::from_str(&text).expect("RON");
    let value = ReflectDeserializer::new(&registry).deserialize(&mut deserializer);
    let value = value.unwrap_or_else(|error| panic!("{error}: {text}"));
    let read = value.try_downcast_ref::<ComicStyle>().expect("a style");
    assert_eq!(read.to_ron().expect("text"), style.to_ron().expect("text"));
    for effect in app.world().resource::<EffectRegistry>().types() {
        let id = (effect.type_info)().type_id();
        assert_serializes(&registry, id, effect.name);
    }
    assert_serializes(&registry, TypeId::of::<DepthMap>(), "DepthMap");
}

fn assert_serializes(registry: &TypeRegistry, id: TypeId, name: &str) {
    let write = registry.get_type_data::<ReflectSerialize>(id);
    assert!(write.is_some(), "{name} does not reflect Serialize");
    let read = registry.get_type_data::<ReflectDeserialize>(id);
    assert!(read.is_some(), "{name} does not reflect Deserialize");
}
