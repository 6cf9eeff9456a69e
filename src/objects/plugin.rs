//! Adds the passes that draw object ids.

use bevy::{
    app::{App, SubApp},
    core_pipeline::schedule::{Core3d, Core3dSystems},
    ecs::schedule::IntoScheduleConfigs,
    pbr::MeshPipeline,
    render::{
        ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderDebugFlags, RenderStartup,
        RenderSystems,
        render_phase::{
            AddRenderCommand, DrawFunctions, SortedRenderPhasePlugin, sort_phase_system,
        },
        render_resource::SpecializedMeshPipelines,
    },
};

use super::{
    depth_test::{self, count_ids},
    depths,
    draw::draw_object_ids,
    groups::{ObjectGroups, extract_object_groups},
    ids::{prepare_object_ids, queue_object_ids},
    items::{DrawId, DrawIdWithMaterial},
    layer::prepare_layers,
    lightmaps::{Lightmapped, extract_lightmapped},
    line_widths::{WideMeshes, WidthViews, extract_wide_meshes, prepare_line_widths},
    marks::{Marks, extract_marks},
    object_table::{ObjectTable, prepare_object_table},
    phase::ObjectIdItem,
    pipeline::{MarkSpecializer, ObjectIdSpecializer, init_object_id_pipeline},
    sections::{SectionBuffer, SectionTables, extract_sections, prepare_sections},
    table::extract_object_styles,
    update_mark_styles,
};
use crate::schedule::{ComicsSystems, PrepareComics};

/// Adds the pass that draws ids. Needs the engine's `PbrPlugin`.
pub(crate) fn build(app: &mut App) {
    app.add_plugins(SortedRenderPhasePlugin::<ObjectIdItem, MeshPipeline>::new(
        RenderDebugFlags::default(),
    ));
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedMeshPipelines<ObjectIdSpecializer>>()
        .init_gpu_resource::<SpecializedMeshPipelines<MarkSpecializer>>()
        .init_resource::<Marks>()
        .init_gpu_resource::<SectionBuffer>()
        .init_resource::<SectionTables>()
        .init_gpu_resource::<ObjectTable>()
        .init_resource::<ObjectGroups>()
        .init_resource::<WideMeshes>()
        .init_resource::<Lightmapped>()
        .init_resource::<WidthViews>()
        .init_resource::<DrawFunctions<ObjectIdItem>>()
        .add_render_command::<ObjectIdItem, DrawId>()
        .add_render_command::<ObjectIdItem, DrawIdWithMaterial>();
    add_systems(render_app);
    depth_test::build_render(render_app);
    depths::build(render_app);
}

fn add_systems(render_app: &mut SubApp) {
    render_app
        .add_systems(
            RenderStartup,
            init_object_id_pipeline.after(bevy::pbr::init_prepass_pipeline),
        )
        .add_systems(
            ExtractSchedule,
            (
                extract_object_styles,
                extract_object_groups,
                extract_sections,
                extract_marks,
                extract_wide_meshes,
                extract_lightmapped,
            ),
        )
        .add_systems(
            Render,
            (
                prepare_sections.in_set(RenderSystems::PrepareAssets),
                queue_object_ids.in_set(RenderSystems::QueueMeshes),
                sort_phase_system::<ObjectIdItem>.in_set(RenderSystems::PhaseSort),
                prepare_object_table.in_set(RenderSystems::PrepareBindGroups),
                (prepare_object_ids, prepare_layers, update_mark_styles)
                    .in_set(PrepareComics::Services),
                prepare_line_widths
                    .in_set(PrepareComics::Services)
                    .after(prepare_object_table),
            ),
        )
        .add_systems(
            Core3d,
            (draw_object_ids, count_ids)
                .chain()
                .after(Core3dSystems::Prepass)
                // With occlusion culling, it writes what indirect draws read.
                .after(bevy::pbr::main_build_indirect_parameters)
                .before(ComicsSystems::DepthRange)
                .before(ComicsSystems::Outlines)
                .before(Core3dSystems::MainPass),
        );
}
