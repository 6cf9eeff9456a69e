//! The service of objects: components that change or remove the lines of single
//! objects, a texture of object ids, in which lines find where objects meet, and transparent
//! meshes that take part in lines and effects.
#![cfg_attr(
    not(feature = "objects"),
    allow(dead_code, reason = "only the feature `objects` draws ids")
)]

#[cfg(feature = "objects")]
mod anchors;
#[cfg(feature = "objects")]
mod backdrop;
#[cfg(feature = "objects")]
mod bindings;
#[cfg(feature = "objects")]
mod depth_test;
#[cfg(feature = "objects")]
mod depths;
#[cfg(feature = "objects")]
mod draw;
#[cfg(feature = "objects")]
mod groups;
#[cfg(feature = "objects")]
mod highlights;
#[cfg(feature = "objects")]
mod ids;
#[cfg(feature = "objects")]
mod inherit;
#[cfg(feature = "objects")]
mod instances;
#[cfg(feature = "objects")]
mod items;
#[cfg(feature = "objects")]
mod layer;
#[cfg(feature = "objects")]
mod levels;
#[cfg(feature = "objects")]
mod lightmaps;
#[cfg(feature = "objects")]
mod line_widths;
mod object_depths;
#[cfg(feature = "objects")]
mod object_ids;
#[cfg(feature = "objects")]
mod phase;
#[cfg(feature = "objects")]
mod pipeline;
#[cfg(feature = "objects")]
mod plugin;
#[cfg(feature = "objects")]
mod ranged;
#[cfg(feature = "objects")]
mod sections;
mod shared;
#[cfg(feature = "objects")]
mod simplification;
mod table;
#[cfg(feature = "objects")]
mod transparent;
mod widths;
#[cfg(feature = "objects")]
mod work;

#[cfg(feature = "objects")]
mod changes;
#[cfg(feature = "objects")]
mod components;

#[cfg(feature = "objects")]
pub use self::{
    anchors::PatternAnchor,
    backdrop::Backdrop,
    components::{NoOutlines, NoStyle, OutlineKinds, OutlineStyle},
    depth_test::ObjectIdDepthTest,
    groups::{OutlineGroup, SplitPrimitives},
    highlights::{SelectionOutline, XRayOutline},
    line_widths::LineWidths,
    object_ids::ObjectIds,
    sections::{ATTRIBUTE_MESH_SECTION, MeshSections, MeshTasks},
    simplification::ObjectSimplification,
    transparent::DepthWrite,
    work::ObjectWork,
};
pub use widths::ViewLineWidths;

#[cfg(feature = "objects")]
pub(crate) use self::{
    backdrop::{BackdropBoxes, Backdrops, nearest_backdrop},
    highlights::HighlightedObjects,
    layer::{LayerRequest, ViewLayer},
    levels::{FadingMeshes, LevelPlaces, Levels},
    sections::AllMeshes,
    transparent::DepthWrites,
};
pub(crate) use object_depths::{
    OBJECT_DEPTHS_BINDING, ObjectDepthRequest, ObjectDepths, ObjectEye, object_depths_entry,
};
pub(crate) use table::{ObjectChanges, ObjectStyleBuffer, ObjectStyles};
pub(crate) use widths::{LARGEST_FACTOR, Pressure, WIDTH_FORMAT, widths_entry};

use bevy::{
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp,
        render_resource::{
            BindGroupLayoutEntry, ShaderStages, ShaderType, Texture, TextureSampleType,
            TextureView, binding_types::storage_buffer_read_only_sized,
        },
        renderer::{RenderDevice, RenderQueue},
    },
    shader::load_shader_library,
};

use crate::{gpu::sampled, schedule::PrepareComics};

/// Format of the texture of object ids: id; style slot and section.
pub(crate) const ID_FORMAT: bevy::render::render_resource::TextureFormat =
    bevy::render::render_resource::TextureFormat::Rg16Uint;

/// On a view in the render world: what the plan of its camera reads.
#[derive(Component, Clone, Copy, Default)]
pub(crate) struct IdsWanted {
    /// Object ids.
    pub ids: bool,
    /// The layer of highlighted objects.
    pub layer: bool,
    /// The widths of lines, see [`ViewLineWidths`].
    pub widths: bool,
}

/// On a view in the render world: the plan of its camera reads depth, and there are meshes with
/// [`DepthWrite`](crate::objects::DepthWrite).
#[derive(Component)]
pub(crate) struct DepthWanted {
    pub camera: Entity,
    /// The plan reads normals too.
    pub normals: bool,
}

/// On a view in the render world that shows meshes with [`DepthWrite`](crate::objects::DepthWrite):
/// what they are drawn into, besides its depth.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct QueuedDepth {
    pub ids: bool,
    pub normals: bool,
}

/// On a view in the render world: a request for object ids, written in every frame by
/// [`PrepareComics::Choose`].
#[derive(Component)]
pub(crate) struct IdRequest {
    pub camera: Entity,
    /// Size in pixels of the depth texture, and its samples per pixel.
    pub size: UVec2,
    pub samples: u32,
    /// The pressure of lines, if the widths of lines are requested too.
    pub pressure: Option<Pressure>,
}

/// On a view in the render world whose object ids are drawn: the object at each pixel.
///
/// The texture has the size and the number of samples of the depth texture. It can be
/// another texture in every frame.
#[derive(Component, Clone, Debug)]
pub struct ViewObjectIds {
    /// `Rg16Uint`: red is the id of the object ([`ObjectIds`]; 0: no object). The low byte of
    /// green is the slot of the mesh's outline style (0: it has none), the high byte the
    /// section of the mesh (0: it has none; see [`MeshSections`]).
    pub texture: Texture,
    pub(crate) view: TextureView,
}

/// The layout entry of the texture of object ids.
pub(crate) fn ids_entry(multisampled: bool) -> BindGroupLayoutEntry {
    sampled(multisampled, TextureSampleType::Uint).build(8, ShaderStages::FRAGMENT)
}

/// The layout entry of the table of outline styles.
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

/// The table of the lines of highlighted objects on the GPU.
#[derive(Resource, Default)]
pub(crate) struct HighlightStyleBuffer(pub ObjectStyleBuffer);

#[cfg(feature = "objects")]
fn update_highlight_styles(
    mut buffer: ResMut<HighlightStyleBuffer>,
    highlights: Res<HighlightedObjects>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    buffer.0.update(&highlights.styles, &device, &queue);
}

/// Draws object ids for the views that request them, and uploads the outline styles of
/// objects.
pub(crate) struct ObjectsPlugin;

impl Plugin for ObjectsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ObjectStyles>();
        #[cfg(feature = "objects")]
        {
            app.init_resource::<line_widths::WideMeshes>()
                .init_resource::<simplification::Simplifications>()
                .add_systems(
                    PostUpdate,
                    (
                        levels::find_levels,
                        components::assign_object_styles,
                        line_widths::find_wide_meshes,
                        simplification::assign_simplifications,
                    )
                        .chain()
                        .after(TransformSystems::Propagate),
                );
            inherit::build(app);
            backdrop::build(app);
            levels::build(app);
            inherit::register::<OutlineStyle>(app);
            inherit::register::<NoOutlines>(app);
            inherit::register::<NoStyle>(app);
            inherit::register::<PatternAnchor>(app);
            inherit::register::<ObjectSimplification>(app);
            inherit::register::<LineWidths>(app);
            depth_test::build(app);
            highlights::build(app);
            groups::build(app);
            sections::build(app);
            transparent::build(app);
        }
    }

    fn finish(&self, app: &mut App) {
        // Ids are drawn with the engine's mesh pipelines, so they need its `PbrPlugin`.
        #[cfg(feature = "objects")]
        if app.is_plugin_added::<bevy::pbr::PbrPlugin>() {
            plugin::build(app);
            sections::finish(app);
            transparent::finish(app);
        }
        #[cfg(not(feature = "objects"))]
        let _ = app;
    }
}

impl ObjectsPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        load_shader_library!(app, "objects.wgsl");
        load_shader_library!(app, "pressure.wgsl");
        #[cfg(feature = "objects")]
        {
            load_shader_library!(app, "widths.wgsl");
            bevy::asset::embedded_asset!(app, "depths.wgsl");
            bevy::asset::embedded_asset!(app, "ids.wgsl");
            bevy::asset::embedded_asset!(app, "sections.wgsl");
            depth_test::build_shaders(app);
            transparent::build_shaders(app);
        }
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .init_gpu_resource::<ObjectStyleBuffer>()
            .init_gpu_resource::<HighlightStyleBuffer>()
            .init_resource::<ObjectStyles>()
            .add_systems(Render, update_object_styles.in_set(PrepareComics::Services));
    }
}
