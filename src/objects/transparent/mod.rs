//! Transparent meshes that take part in lines and effects: the component, and the meshes that
//! have it.

mod items;
mod pass;

use bevy::{
    asset::embedded_asset,
    core_pipeline::schedule::{Core3d, Core3dSystems},
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup,
        render_resource::{SpecializedMeshPipelines, SpecializedRenderPipelines},
        renderer::RenderAdapterInfo,
    },
};

use self::{
    items::{TransparentSpecializer, init_transparent_pipeline},
    pass::{NormalCopyPipeline, draw_transparent_depth, init_normal_copy, prepare_own_surfaces},
};
use super::{
    changes::{NoteChanges, follow},
    depth_test::count_ids,
    inherit::{Inherited, Values, register},
    instances::expand_instances,
};
use crate::{
    depth::surfaces::prepass_is_empty,
    schedule::{ComicsSystems, PrepareComics},
    settings::{FieldRange, impl_sanitized},
};

pub(super) use items::TransparentItems;

/// Lets a transparent mesh take part in lines and effects: it writes its depth, its normal and
/// its [id](crate::testing::ObjectIds) for the effects of this crate.
///
/// Then it has outlines of its own, hides the lines of what is behind it, and the color
/// effects use its own distance. The engine's depth and its picture do not change: what is
/// behind glass stays visible through it.
///
/// For meshes whose material has the alpha mode `Blend`, `Premultiplied`, `Add` or `Multiply`, or
/// transmission. On other meshes it has no effect: they are already in the engine's depth prepass.
/// Where several such meshes overlap, the nearest one is used.
///
/// | material | pixels that are written |
/// |---|---|
/// | [`StandardMaterial`], `ToonMaterial`, and extended materials with the prepass shader of the standard material | those with an alpha of at least [`alpha_cutoff`](Self::alpha_cutoff) |
/// | any other | the whole mesh; the log says so once |
/// | any whose `Material::enable_prepass` is `false` | none; the log says so once |
///
/// Creases follow the normals of the mesh without its normal map. `MeshSections` on it does
/// nothing. The motion vectors of its pixels are those of what is behind it.
///
/// While such a mesh is visible, a view with effects that read depth copies its depth, and its
/// normals if it reads them, and draws these meshes once more.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct DepthWrite {
    /// The least alpha of a pixel that is written: the alpha of the base color, times that of
    /// its texture, times that of the vertex colors. Range 0.01 to 1, default 0.5. A number
    /// that is not finite becomes the default.
    #[reflect(@FieldRange::linear(0.01, 1.0))]
    pub alpha_cutoff: f32,
    /// Applies to all descendants as well, except for those with a `DepthWrite` of their own
    /// and everything below them. Default: `true`.
    pub inherit: bool,
}

impl Default for DepthWrite {
    fn default() -> Self {
        Self {
            alpha_cutoff: 0.5,
            inherit: true,
        }
    }
}

impl_sanitized!(DepthWrite);

/// The least alpha that is drawn, of the transparent meshes that draw into the depth of effects.
pub(crate) type DepthWrites = Values<DepthWrite, f32>;

fn assign_depth_writes(mut asking: Inherited<DepthWrite>, mut writes: ResMut<DepthWrites>) {
    writes.update(&mut asking, |write| write.sanitized().alpha_cutoff);
}

/// The part in the main world.
pub(super) fn build(app: &mut App) {
    register::<DepthWrite>(app);
    app.init_resource::<DepthWrites>()
        .add_systems(PostUpdate, assign_depth_writes);
}

/// The shaders. Needs the engine's assets.
pub(super) fn build_shaders(app: &mut App) {
    embedded_asset!(app, "transparent.wgsl");
    embedded_asset!(app, "copy_normals.wgsl");
}

/// Adds the pass. Needs the engine's `PbrPlugin`.
pub(super) fn finish(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedMeshPipelines<TransparentSpecializer>>()
        .init_gpu_resource::<SpecializedRenderPipelines<NormalCopyPipeline>>()
        .init_resource::<DepthWrites>()
        .add_systems(
            RenderStartup,
            (
                init_transparent_pipeline.after(bevy::pbr::init_prepass_pipeline),
                init_normal_copy,
            ),
        )
        .add_systems(ExtractSchedule, follow::<DepthWrites>.in_set(NoteChanges))
        .add_systems(
            Render,
            // With OpenGL, no transparent mesh is drawn, and the depth is not copied.
            (prepare_own_surfaces.in_set(PrepareComics::Services))
                .run_if(|adapter: Res<RenderAdapterInfo>| !prepass_is_empty(&adapter)),
        )
        .add_systems(
            Core3d,
            draw_transparent_depth
                .after(count_ids)
                .after(expand_instances)
                .after(Core3dSystems::Prepass)
                .before(ComicsSystems::DepthRange)
                .before(Core3dSystems::MainPass),
        );
}
