//! Lines behind what moves fast: ribbons along the paths that points of a surface took (Lake et al.
//! 2000).

mod draw;
mod ink;
mod ribbon;
mod seeds;
mod settings;
#[cfg(test)]
mod tests;
mod trail;

use bevy::{
    asset::embedded_asset, camera::visibility::VisibilitySystems, pbr::PbrPlugin, prelude::*,
    render::erased_render_asset::ErasedRenderAssetPlugin, shader::load_shader_library,
};

pub use settings::MotionLines;

use ink::MotionInk;

/// Registers the component and, if the app has [`PbrPlugin`], the material of the ribbons.
pub(crate) struct MotionLinesPlugin;

impl Plugin for MotionLinesPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<MotionLines>()
            .add_observer(draw::forget_at_cut)
            .add_observer(draw::remove_ribbons);
        add_material(app);
    }

    /// Adds the material if [`PbrPlugin`] was added after this plugin.
    fn finish(&self, app: &mut App) {
        if add_material(app) {
            // The engine finishes only the plugins that were added before the first `finish`.
            ErasedRenderAssetPlugin::<MeshMaterial3d<MotionInk>>::default().finish(app);
        }
    }
}

impl MotionLinesPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "ribbon.wgsl");
        embedded_asset!(app, "ink.wgsl");
    }
}

/// Adds the material, if the app can draw it and does not have it yet. Returns whether it did.
fn add_material(app: &mut App) -> bool {
    if !app.is_plugin_added::<PbrPlugin>() || app.is_plugin_added::<MaterialPlugin<MotionInk>>() {
        return false;
    }
    app.add_plugins(MaterialPlugin::<MotionInk>::default())
        .add_systems(
            PostUpdate,
            (draw::follow, draw::draw)
                .chain()
                .after(TransformSystems::Propagate)
                .before(VisibilitySystems::VisibilityPropagate),
        );
    true
}
