//! The cartoon material: uniformly lit areas with hard shadows (\[CL\] 2.2, 2.3,
//! after Decaudin).

mod art_map;
mod art_strokes;
mod detail;
mod form;
#[cfg(test)]
mod fuzz;
mod glint;
mod hatch;
mod ignored;
mod look;
mod material;
mod name;
#[cfg(feature = "inspector")]
mod place;
mod ramp;
mod ramp_map;
mod ramp_sums;
mod rim;
mod rim_shader;
mod scene;
mod smooth;
mod uniform;
mod vertex;
mod view_range;

use bevy::{
    app::{App, Plugin, PostUpdate, Update},
    asset::{AssetApp, AssetEventSystems, Assets, embedded_asset, load_internal_asset},
    ecs::schedule::IntoScheduleConfigs,
    image::Image,
    pbr::{MaterialPlugin, MeshMaterial3d, PbrPlugin},
    render::erased_render_asset::ErasedRenderAssetPlugin,
    shader::{Shader, load_shader_library},
};

pub use art_map::TonalArtMap;
pub use detail::{DetailAxis, RampDetail};
pub use form::{FormShape, ShadedForm};
pub use glint::{Glint, GlintFrame, GlintShape};
pub use look::{ToonLook, ToonLookError, ToonLookHandle, ToonLookHandleTemplate};
pub use material::{CartoonLight, CartoonMaterial};
pub use name::MaterialName;
#[cfg(feature = "inspector")]
pub(crate) use place::{LightPlace, original_of};
pub use ramp::{Ramp, RampBlend, RampMode, RampStop};
pub use ramp_map::RampMap;
pub use rim::{Rim, RimWidth};
pub use scene::CartoonScene;

/// Registers types, shaders and, if the app has [`PbrPlugin`], the material.
pub(crate) struct CartoonPlugin;

impl Plugin for CartoonPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<CartoonLight>()
            .register_type::<CartoonScene>()
            .register_type::<TonalArtMap>()
            .register_type::<MaterialName>()
            .register_type::<ToonLookHandle>();
        add_material(app);
    }

    /// Adds the material if [`PbrPlugin`] was added after this plugin.
    fn finish(&self, app: &mut App) {
        if add_material(app) {
            // The engine finishes only the plugins that were added before the
            // first `finish`. This is the material's only plugin that has one.
            ErasedRenderAssetPlugin::<MeshMaterial3d<CartoonMaterial>>::default().finish(app);
        }
    }
}

impl CartoonPlugin {
    /// The part that needs the engine's assets.
    pub(crate) fn build_assets(app: &mut App) {
        app.init_asset::<ToonLook>()
            .register_asset_reflect::<ToonLook>()
            .init_asset_loader::<look::ToonLookLoader>();
    }

    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "art_map.wgsl");
        load_shader_library!(app, "bindings.wgsl");
        load_shader_library!(app, "brightest.wgsl");
        load_shader_library!(app, "contact.wgsl");
        load_shader_library!(app, "detail.wgsl");
        load_shader_library!(app, "form.wgsl");
        load_shader_library!(app, "glint.wgsl");
        load_shader_library!(app, "glint_light.wgsl");
        load_shader_library!(app, "hatch.wgsl");
        load_shader_library!(app, "hatch_light.wgsl");
        load_shader_library!(app, "indirect.wgsl");
        load_shader_library!(app, "lamp_shadow.wgsl");
        load_shader_library!(app, "lamps.wgsl");
        load_shader_library!(app, "light.wgsl");
        load_shader_library!(app, "light_rim.wgsl");
        load_shader_library!(app, "light_textures.wgsl");
        load_shader_library!(app, "octahedral.wgsl");
        load_shader_library!(app, "per_light.wgsl");
        load_shader_library!(app, "ramp.wgsl");
        load_shader_library!(app, "ramp_light.wgsl");
        load_shader_library!(app, "ramp_map.wgsl");
        load_shader_library!(app, "rect.wgsl");
        load_shader_library!(app, "reflect.wgsl");
        load_shader_library!(app, "shadow_texels.wgsl");
        load_shader_library!(app, "share.wgsl");
        load_shader_library!(app, "shine.wgsl");
        load_shader_library!(app, "stroke_level.wgsl");
        load_shader_library!(app, "surface.wgsl");
        load_shader_library!(app, "surroundings.wgsl");
        load_shader_library!(app, "two_shades.wgsl");
        load_shader_library!(app, "view_range.wgsl");
        load_shader_library!(app, "visible.wgsl");
        embedded_asset!(app, "cartoon.wgsl");
        load_internal_asset!(app, vertex::VERTEX, "vertex.wgsl", Shader::from_wgsl);
        rim_shader::build_render(app);
        view_range::build_render(app);
    }
}

/// Adds the material, if the app can draw it and does not have it yet. Returns
/// whether it did.
fn add_material(app: &mut App) -> bool {
    if !app.is_plugin_added::<PbrPlugin>()
        || app.is_plugin_added::<MaterialPlugin<CartoonMaterial>>()
    {
        return false;
    }
    if let Some(mut images) = app.world_mut().get_resource_mut::<Assets<Image>>() {
        view_range::add_texture(&mut images);
    }
    app.add_plugins(MaterialPlugin::<CartoonMaterial>::default())
        .register_asset_reflect::<CartoonMaterial>()
        .init_resource::<scene::Copies>()
        .init_resource::<ramp_sums::RampSums>()
        .init_resource::<smooth::SmoothMeshes>()
        .add_systems(
            Update,
            (
                (look::apply_looks, material::keep_forward).chain(),
                ignored::warn_of_ignored,
                ignored::warn_of_reflections,
                view_range::ask_for_range,
                (smooth::begin_smoothing, smooth::finish_smoothing).chain(),
            ),
        )
        .add_systems(
            PostUpdate,
            (
                scene::follow_materials,
                scene::restore,
                name::name_meshes,
                scene::choose_again,
                scene::convert,
                // Before the events of this frame: materials and sums arrive together.
                ramp_sums::sum_ramp_maps,
            )
                .chain()
                .before(AssetEventSystems),
        );
    true
}
