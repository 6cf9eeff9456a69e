//! What single objects ask of the lines: no lines, or lines of their own. And
//! the ids by which lines know where one object ends and another begins.

#[cfg(feature = "objects")]
mod ids;
#[cfg(feature = "objects")]
mod items;
#[cfg(feature = "objects")]
mod phase;
mod table;

#[cfg(feature = "objects")]
mod components;
#[cfg(feature = "objects")]
pub use components::{NoOutlines, OutlineKinds, OutlineStyle};
#[cfg(feature = "objects")]
pub use ids::object_id;

pub(crate) use table::{ObjectStyleBuffer, ObjectStyles};

use bevy::{
    app::{App, Plugin},
    ecs::{
        component::Component,
        entity::Entity,
        schedule::IntoScheduleConfigs,
        system::{Res, ResMut},
    },
    math::UVec2,
    render::{
        GpuResourceAppExt, Render, RenderApp,
        render_resource::{
            BindGroupLayoutEntry, ShaderStages, ShaderType, Texture, TextureSampleType,
            TextureView,
            binding_types::{storage_buffer_read_only_sized, texture_2d, texture_2d_multisampled},
        },
        renderer::{RenderDevice, RenderQueue},
    },
    shader::load_shader_library,
};

use crate::schedule::PrepareComics;

/// The ids' texture: (id, style slot).
#[cfg(feature = "objects")]
pub(crate) const ID_FORMAT: bevy::render::render_resource::TextureFormat =
    bevy::render::render_resource::TextureFormat::Rg16Uint;

/// On a view in the render world: the wanted plan reads object ids.
#[derive(Component)]
pub(crate) struct IdsWanted;

/// On a view in the render world: the ids of its objects are to be drawn in this
/// frame.
#[derive(Component)]
#[cfg_attr(
    not(feature = "objects"),
    allow(dead_code, reason = "only the feature `objects` draws ids")
)]
pub(crate) struct IdRequest {
    pub camera: Entity,
    /// Size and samples of the depth texture.
    pub size: UVec2,
    pub samples: u32,
}

/// In the render world, on a view whose object ids are drawn: which object is
/// seen at each pixel. As large as the depth texture, with as many samples. The
/// texture may be another one in every frame.
#[derive(Component, Clone, Debug)]
#[cfg_attr(
    not(feature = "objects"),
    allow(dead_code, reason = "only the feature `objects` draws ids")
)]
pub struct ViewObjectIds {
    /// `Rg16Uint`: the [`object_id`](crate::object_id) (0: none) and the slot of
    /// its contour style (0: none of its own).
    pub texture: Texture,
    pub(crate) view: TextureView,
}

/// The layout entry of the ids.
pub(crate) fn ids_entry(multisampled: bool) -> BindGroupLayoutEntry {
    let texture = if multisampled {
        texture_2d_multisampled(TextureSampleType::Uint)
    } else {
        texture_2d(TextureSampleType::Uint)
    };
    texture.build(8, ShaderStages::FRAGMENT)
}

/// The layout entry of the objects' styles.
pub(crate) fn object_styles_entry() -> BindGroupLayoutEntry {
    let size = table::ObjectStyleUniform::min_size();
    storage_buffer_read_only_sized(false, Some(size)).build(6, ShaderStages::FRAGMENT)
}

fn update_object_styles(
    mut buffer: ResMut<ObjectStyleBuffer>,
    styles: Res<ObjectStyles>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    buffer.update(&styles, &device, &queue);
}

/// Ids of objects and lines of their own, for the views that ask for them.
pub(crate) struct ObjectsPlugin;

impl Plugin for ObjectsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ObjectStyles>();
        #[cfg(feature = "objects")]
        app.register_type::<OutlineStyle>()
            .register_type::<NoOutlines>()
            .add_systems(bevy::app::PostUpdate, components::assign_object_styles);
    }

    fn finish(&self, app: &mut App) {
        // Ids are drawn with the engine's own mesh pipelines.
        #[cfg(feature = "objects")]
        if app.is_plugin_added::<bevy::pbr::PbrPlugin>() {
            ids::build(app);
        }
        #[cfg(not(feature = "objects"))]
        let _ = app;
    }
}

impl ObjectsPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "objects.wgsl");
        #[cfg(feature = "objects")]
        bevy::asset::embedded_asset!(app, "ids.wgsl");
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .init_gpu_resource::<ObjectStyleBuffer>()
            .init_resource::<ObjectStyles>()
            .add_systems(Render, update_object_styles.in_set(PrepareComics::Services));
    }
}
