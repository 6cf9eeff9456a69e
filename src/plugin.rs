//! The plugin: one frame, top to bottom.

use bevy::{
    prelude::*,
    render::{Render, RenderApp, RenderSystems},
};

use crate::{
    animation::AnimationPlugin,
    camera::CameraPlugin,
    composite::CompositePlugin,
    depth::plugin::DepthPlugin,
    diagnostics::{ComicsDiagnostics, StageLedger, publish_ledger, read_ledger},
    effects,
    fused::FusedPlugin,
    lines,
    objects::ObjectsPlugin,
    style::StylePlugin,
    tones,
};

/// Adds comics stylization: every [`Camera3d`] with an
/// effect is drawn as a comic.
///
/// It may be added before or after Bevy's `DefaultPlugins`.
///
/// In an app without a renderer the plugin registers its types and plans what
/// cameras would draw; nothing is drawn.
#[derive(Default)]
pub struct ComicsPlugin;

impl Plugin for ComicsPlugin {
    fn build(&self, app: &mut App) {
        // The main world: effects on cameras, styles, and what a camera asks for.
        app.register_type::<ComicsDiagnostics>()
            .init_resource::<ComicsDiagnostics>();
        effects::add(app);
        app.add_plugins((
            StylePlugin,
            AnimationPlugin,
            CameraPlugin,
            DepthPlugin,
            ObjectsPlugin,
            CompositePlugin,
            FusedPlugin,
        ));
        #[cfg(any(feature = "objects", feature = "toon"))]
        app.add_plugins(crate::motion_lines::MotionLinesPlugin);
        #[cfg(feature = "toon")]
        app.add_plugins(crate::toon::ToonPlugin);
        build_engine_parts(app);
    }

    /// If the engine's plugins were added after this one, they are there now.
    fn finish(&self, app: &mut App) {
        build_engine_parts(app);
    }
}

/// The engine parts that are built. Each is built once: in `build` if the
/// engine's plugin came before [`ComicsPlugin`], otherwise in `finish`.
#[derive(Resource, Clone, Copy, Default)]
struct EngineParts {
    assets: bool,
    render: bool,
}

fn build_engine_parts(app: &mut App) {
    let built = *app.world_mut().get_resource_or_init::<EngineParts>();
    let parts = EngineParts {
        assets: app.world().contains_resource::<AssetServer>(),
        render: app.get_sub_app(RenderApp).is_some(),
    };
    if parts.assets && !built.assets {
        StylePlugin::build_assets(app);
        #[cfg(feature = "toon")]
        crate::toon::ToonPlugin::build_assets(app);
    }
    if parts.render && !built.render {
        build_render(app);
    }
    app.insert_resource(parts);
}

/// The render world: what is asked of depth, objects, lines and tones, and the pass
/// that draws with it.
fn build_render(app: &mut App) {
    #[cfg(any(feature = "objects", feature = "toon"))]
    AnimationPlugin::build_render(app);
    crate::bind_groups::build_render(app);
    CameraPlugin::build_render(app);
    DepthPlugin::build_render(app);
    ObjectsPlugin::build_render(app);
    lines::build_render(app);
    tones::build_render(app);
    CompositePlugin::build_render(app);
    FusedPlugin::build_render(app);
    #[cfg(any(feature = "objects", feature = "toon"))]
    crate::motion_lines::MotionLinesPlugin::build_render(app);
    #[cfg(feature = "toon")]
    crate::toon::ToonPlugin::build_render(app);
    // Back to the main world: what ran.
    let ledger = StageLedger::default();
    let reader = ledger.reader();
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app
            .insert_resource(ledger)
            .add_systems(Render, publish_ledger.in_set(RenderSystems::Cleanup));
        app.insert_resource(reader)
            .add_systems(PreUpdate, read_ledger);
    }
}
