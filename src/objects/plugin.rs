//! Adds the passes that draw object ids.

use bevy::{
    core_pipeline::schedule::{Core3d, Core3dSystems},
    pbr::queue_prepass_material_meshes,
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup, RenderSystems,
        render_phase::{AddRenderCommand, DrawFunctions},
        render_resource::SpecializedMeshPipelines,
    },
};

use super::{
    ObjectDepths, ViewLineWidths,
    backdrop::{Backdrops, remove_backdrops},
    bindings::{IdBindings, prepare_id_bindings},
    changes::{self, NoteChanges, follow},
    depth_test::{self, IdCount, count_ids},
    depths::{self, ObjectDepthPass},
    draw::draw_object_ids,
    groups::ObjectGroups,
    highlights::HighlightedObjects,
    ids::{prepare_object_ids, queue_object_ids},
    instances::{bind_instances, expand_instances, place_instances},
    items::{DrawId, DrawIdWithMaterial},
    layer::prepare_layers,
    levels::Levels,
    lightmaps::{Lightmapped, extract_lightmapped},
    line_widths::{WideMeshes, WidthViews},
    object_ids::{ObjectIds, begin_frame},
    phase::{ObjectIdItem, ObjectIdPhases},
    pipeline::{ObjectIdSpecializer, init_object_id_pipeline},
    ranged::{RangedMeshes, extract_ranged_meshes},
    sections::{SectionBuffer, SectionStarts, extract_sections, prepare_sections},
    table::ObjectStyles,
    update_highlight_styles,
};
use crate::schedule::{ComicsSystems, PrepareComics};

/// Adds the pass that draws ids. Needs the engine's `PbrPlugin`.
pub(crate) fn build(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedMeshPipelines<ObjectIdSpecializer>>()
        .init_resource::<HighlightedObjects>()
        .init_resource::<Levels>()
        .init_resource::<Backdrops>()
        .init_gpu_resource::<SectionBuffer>()
        .init_resource::<SectionStarts>()
        .init_gpu_resource::<ObjectIdPhases>()
        .init_gpu_resource::<ObjectIds>()
        .init_resource::<ObjectGroups>()
        .init_resource::<WideMeshes>()
        .init_resource::<RangedMeshes>()
        .init_resource::<Lightmapped>()
        .init_resource::<WidthViews>()
        .init_resource::<DrawFunctions<ObjectIdItem>>()
        .add_render_command::<ObjectIdItem, DrawId>()
        .add_render_command::<ObjectIdItem, DrawIdWithMaterial>();
    add_systems(render_app);
    changes::build(render_app);
    depth_test::build_render(render_app);
    depths::build(render_app);
}

/// What views have that is bound to the device.
type OfDevice = (
    IdBindings,
    IdCount,
    ObjectDepthPass,
    ObjectDepths,
    ViewLineWidths,
);

/// Removes the buffers of views. This runs again after a lost device, whose buffers are no longer
/// valid.
fn forget_buffers(
    mut commands: Commands,
    views: Query<Entity, Or<(With<IdBindings>, With<IdCount>, With<ObjectDepths>)>>,
) {
    for view in &views {
        commands.entity(view).remove::<OfDevice>();
    }
}

fn add_systems(render_app: &mut SubApp) {
    render_app
        .add_systems(
            RenderStartup,
            (
                init_object_id_pipeline.after(bevy::pbr::init_prepass_pipeline),
                forget_buffers,
            ),
        )
        .add_systems(
            ExtractSchedule,
            (
                begin_frame,
                follow::<ObjectStyles>,
                follow::<ObjectGroups>,
                follow::<HighlightedObjects>,
                follow::<WideMeshes>,
                follow::<Levels>,
                follow::<Backdrops>,
                extract_sections,
                extract_lightmapped,
                extract_ranged_meshes,
            )
                .in_set(NoteChanges),
        )
        .add_systems(
            Render,
            (
                prepare_sections.in_set(RenderSystems::PrepareAssets),
                (
                    remove_backdrops.after(queue_prepass_material_meshes),
                    queue_object_ids,
                )
                    .chain()
                    .in_set(RenderSystems::QueueMeshes),
                place_instances.in_set(RenderSystems::PrepareResourcesBatchPhases),
                bind_instances.in_set(RenderSystems::PrepareBindGroups),
                (prepare_object_ids, prepare_layers, update_highlight_styles)
                    .in_set(PrepareComics::Services),
                prepare_id_bindings
                    .in_set(PrepareComics::Services)
                    .after(bind_instances),
            ),
        )
        .add_systems(
            Core3d,
            (expand_instances, draw_object_ids, count_ids)
                .chain()
                .after(Core3dSystems::Prepass)
                .before(ComicsSystems::DepthRange)
                .before(ComicsSystems::Outlines)
                .before(Core3dSystems::MainPass),
        );
}
