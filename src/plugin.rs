//! The plugin: one frame, top to bottom.

use bevy::{
    app::{App, Plugin, PreUpdate},
    ecs::schedule::IntoScheduleConfigs,
    render::{Render, RenderApp, RenderSystems},
};

use crate::{
    depth::plugin::DepthPlugin,
    diagnostics::{ComicsDiagnostics, StageLedger, publish_ledger, read_ledger},
    effect::FusedPlugin,
    effects,
    finish::FinishPlugin,
    lines::LinesPlugin,
    objects::ObjectsPlugin,
    style::StylePlugin,
    view::ViewPlugin,
};

/// Adds comics stylization: every [`Camera3d`](bevy::camera::Camera3d) with an
/// effect is drawn as a comic.
///
/// In an app without a renderer the plugin registers its types and plans what
/// cameras would draw; nothing is drawn.
#[derive(Default)]
pub struct ComicsPlugin;

impl Plugin for ComicsPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ComicsDiagnostics>()
            .init_resource::<ComicsDiagnostics>();
        // The main world: effects on cameras, styles, and what a camera asks for.
        effects::add(app);
        app.add_plugins((StylePlugin, ViewPlugin));
        // The render world: what is asked of depth, objects and lines, and the
        // pass that draws with it.
        app.add_plugins((
            DepthPlugin,
            ObjectsPlugin,
            LinesPlugin,
            FinishPlugin,
            FusedPlugin,
        ));
        #[cfg(feature = "cartoon")]
        app.add_plugins(crate::cartoon::CartoonPlugin);
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
}
