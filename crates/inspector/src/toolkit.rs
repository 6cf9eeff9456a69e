//! `bevy_egui`, the toolkit that draws the panel, shared with the game's own
//! windows.

use bevy::{
    prelude::*,
    render::{RenderApp, renderer::RenderDevice},
};
use bevy_egui::{EguiContext, EguiGlobalSettings, EguiPlugin, EguiPrimaryContextPass};

use super::Helper;

/// The panel's plugin has added the toolkit's; whether that one is finished.
#[derive(Resource)]
struct AddedHere {
    is_finished: bool,
}

/// Adds the toolkit's plugin if no other plugin has. Called when every plugin is
/// built, so that the game may add it before or after the panel's.
///
/// The toolkit gives the app's first camera a context, which costs a pass in
/// every frame. Nobody draws with it here, so it is not created, unless there are
/// systems for it or settings of the game.
pub fn add(app: &mut App) {
    if app.is_plugin_added::<EguiPlugin>() {
        return;
    }
    let is_used = app.get_schedule(EguiPrimaryContextPass).is_some()
        || app.world().contains_resource::<EguiGlobalSettings>();
    app.add_plugins(EguiPlugin::default());
    app.insert_resource(AddedHere { is_finished: false });
    if !is_used && let Some(mut settings) = app.world_mut().get_resource_mut::<EguiGlobalSettings>()
    {
        settings.auto_create_primary_context = false;
    }
    finish(app);
}

/// Finishes the toolkit's plugin if it was added here and the engine's renderer
/// is there: the engine does not finish plugins that are added by others while
/// they finish. Called again from `cleanup`, because the renderer is created late
/// where its plugin was added after the panel's.
pub fn finish(app: &mut App) {
    let has_renderer = app
        .get_sub_app(RenderApp)
        .is_some_and(|app| app.world().contains_resource::<RenderDevice>());
    let Some(mut added) = app.world_mut().get_resource_mut::<AddedHere>() else {
        return;
    };
    if has_renderer && !added.is_finished {
        added.is_finished = true;
        EguiPlugin::default().finish(app);
    }
}

/// Whether the toolkit has had the time to choose the camera of the game's own
/// windows. It chooses the first camera that it sees, unless that has a context,
/// as the panel's has; so the panel's camera must not be the first.
pub fn has_chosen_camera(world: &mut World, had_camera: &mut bool) -> bool {
    let chooses = world
        .get_resource::<EguiGlobalSettings>()
        .is_some_and(|settings| settings.auto_create_primary_context);
    let has_context = world
        .query_filtered::<(), (With<EguiContext>, Without<Helper>)>()
        .iter(world)
        .next()
        .is_some();
    let has_camera = world
        .query_filtered::<(), (With<Camera>, Without<Helper>)>()
        .iter(world)
        .next()
        .is_some();
    let had_camera = std::mem::replace(had_camera, has_camera);
    // A camera is seen at the start of the frame after it was spawned.
    !chooses || has_context || (had_camera && has_camera)
}
