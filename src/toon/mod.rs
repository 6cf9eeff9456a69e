//! The toon material: uniformly lit areas with hard shadows (\[CL\] 2.2, 2.3,
//! after Decaudin).

mod art_map;
mod art_strokes;
mod detail;
#[cfg(test)]
mod fuzz;
mod gltf_name;
mod hatch;
mod ignored;
mod material;
mod name;
mod proxy;
mod ramp;
mod ramp_map;
mod ramp_stop;
mod ramp_sums;
mod rim;
mod rim_shader;
mod scene;
mod shading;
mod smooth;
mod style_scene;
mod stylized_highlight;
mod uniform;
mod vertex;
mod view_range;

use bevy::{
    asset::{AssetEventSystems, embedded_asset, load_internal_asset},
    pbr::PbrPlugin,
    prelude::*,
    render::erased_render_asset::ErasedRenderAssetPlugin,
    shader::load_shader_library,
};

pub use art_map::TonalArtMap;
pub use detail::{DetailAxis, RampDetail};
pub use material::{ToonLight, ToonMaterial};
pub use name::MaterialName;
pub use proxy::{ProxyShape, ShadingProxy};
pub use ramp::{Ramp, RampBlend, RampMode};
pub use ramp_map::RampMap;
pub use ramp_stop::RampStop;
pub use rim::{Rim, RimWidth};
#[cfg(feature = "objects")]
pub use scene::AddedByStyle;
pub(crate) use scene::CameraScene;
pub use scene::ToonScene;
pub use shading::{ToonShading, ToonShadingError, ToonShadingHandle, ToonShadingHandleTemplate};
pub use style_scene::{StylePart, StyleScene, StyleScope};
pub use stylized_highlight::{HighlightFrame, HighlightShape, StylizedHighlight};

/// Registers types, shaders and, if the app has [`PbrPlugin`], the material.
pub(crate) struct ToonPlugin;

impl Plugin for ToonPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ToonLight>()
            .register_type::<ToonScene>()
            .register_type::<StyleScene>()
            .register_type::<StyleScope>()
            .register_type::<TonalArtMap>()
            .register_type::<MaterialName>()
            .register_type::<ToonShadingHandle>();
        add_material(app);
    }

    /// Adds the material if [`PbrPlugin`] was added after this plugin.
    fn finish(&self, app: &mut App) {
        if add_material(app) {
            // The engine finishes only the plugins that were added before the
            // first `finish`. This is the material's only plugin that has one.
            ErasedRenderAssetPlugin::<MeshMaterial3d<ToonMaterial>>::default().finish(app);
        }
    }
}

impl ToonPlugin {
    /// The part that needs the engine's assets.
    pub(crate) fn build_assets(app: &mut App) {
        app.init_asset::<ToonShading>()
            .register_asset_reflect::<ToonShading>()
            .init_asset_loader::<shading::ToonShadingLoader>();
    }

    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "art_map.wgsl");
        load_shader_library!(app, "bindings.wgsl");
        load_shader_library!(app, "brightest.wgsl");
        load_shader_library!(app, "contact.wgsl");
        load_shader_library!(app, "detail.wgsl");
        load_shader_library!(app, "proxy.wgsl");
        load_shader_library!(app, "stylized_highlight.wgsl");
        load_shader_library!(app, "stylized_highlight_light.wgsl");
        load_shader_library!(app, "hatch.wgsl");
        load_shader_library!(app, "hatch_light.wgsl");
        load_shader_library!(app, "indirect.wgsl");
        load_shader_library!(app, "light_shadow.wgsl");
        load_shader_library!(app, "lights.wgsl");
        load_shader_library!(app, "light.wgsl");
        load_shader_library!(app, "rim.wgsl");
        load_shader_library!(app, "light_textures.wgsl");
        load_shader_library!(app, "octahedral.wgsl");
        load_shader_library!(app, "per_light.wgsl");
        load_shader_library!(app, "ramp.wgsl");
        load_shader_library!(app, "ramp_light.wgsl");
        load_shader_library!(app, "ramp_map.wgsl");
        load_shader_library!(app, "rect.wgsl");
        load_shader_library!(app, "reflect.wgsl");
        load_shader_library!(app, "shadow_texels.wgsl");
        load_shader_library!(app, "light_fraction.wgsl");
        load_shader_library!(app, "specular.wgsl");
        load_shader_library!(app, "stroke_level.wgsl");
        load_shader_library!(app, "surface.wgsl");
        load_shader_library!(app, "ambient.wgsl");
        load_shader_library!(app, "two_shades.wgsl");
        load_shader_library!(app, "view_range.wgsl");
        load_shader_library!(app, "visible.wgsl");
        embedded_asset!(app, "toon.wgsl");
        load_internal_asset!(app, vertex::VERTEX, "vertex.wgsl", Shader::from_wgsl);
        rim_shader::build_render(app);
        view_range::build_render(app);
    }
}

/// Adds the material, if the app can draw it and does not have it yet. Returns
/// whether it did.
fn add_material(app: &mut App) -> bool {
    if !app.is_plugin_added::<PbrPlugin>() || app.is_plugin_added::<MaterialPlugin<ToonMaterial>>()
    {
        return false;
    }
    if let Some(mut images) = app.world_mut().get_resource_mut::<Assets<Image>>() {
        view_range::add_texture(&mut images);
    }
    scene::build(app);
    #[cfg(feature = "objects")]
    app.register_type::<AddedByStyle>().add_systems(
        PostUpdate,
        // Before lines and patterns look for them.
        scene::add_components
            .after(scene::find_meshes)
            .before(scene::convert)
            .before(TransformSystems::Propagate),
    );
    app.add_plugins(MaterialPlugin::<ToonMaterial>::default())
        .register_asset_reflect::<ToonMaterial>()
        .init_resource::<ramp_sums::RampSums>()
        .init_resource::<smooth::SmoothMeshes>()
        .add_systems(
            Update,
            (
                (scene::apply_shadings, material::keep_forward).chain(),
                ignored::warn_of_ignored,
                ignored::warn_of_reflections,
                scene::warn_of_missing_shadows,
                view_range::ask_for_range,
                (smooth::begin_smoothing, smooth::finish_smoothing).chain(),
            ),
        )
        .add_systems(
            PostUpdate,
            (
                scene::find_meshes,
                scene::follow_materials,
                gltf_name::name_meshes,
                scene::convert,
                // Before the events of this frame: materials and sums arrive together.
                ramp_sums::sum_ramp_maps,
            )
                .chain()
                .before(AssetEventSystems),
        );
    true
}
