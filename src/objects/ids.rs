//! Draws object ids: every mesh of the depth prepass is drawn again where its depth is
//! equal to that of the prepass.
//!
//! Skins, morph targets and materials with their own vertex shader are correct, because
//! the vertex shader is that of the prepass. Alpha masks are correct, because what the
//! prepass discarded fails the depth test.

use bevy::{
    app::App,
    camera::{MainPassResolutionOverride, Viewport},
    core_pipeline::schedule::{Core3d, Core3dSystems},
    ecs::{
        entity::Entity,
        query::{Or, With, Without},
        schedule::IntoScheduleConfigs,
        system::{Commands, Query, Res, ResMut},
        world::World,
    },
    log::error_once,
    math::UVec4,
    mesh::Mesh3d,
    pbr::MeshPipeline,
    platform::collections::HashSet,
    render::{
        ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderDebugFlags, RenderStartup,
        RenderSystems,
        camera::ExtractedCamera,
        render_phase::{
            AddRenderCommand, DrawFunctions, PhaseItem, SortedRenderPhasePlugin,
            ViewSortedRenderPhases, sort_phase_system,
        },
        render_resource::{
            BindGroupEntries, Extent3d, LoadOp, Operations, PipelineCache,
            RenderPassColorAttachment, RenderPassDescriptor, SpecializedMeshPipelines, StoreOp,
            TextureDescriptor, TextureDimension, TextureUsages,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        texture::TextureCache,
        view::{ExtractedView, Msaa, RenderVisibleEntities, RetainedViewEntity, ViewDepthTexture},
    },
};

use super::{
    ID_FORMAT, IdRequest, IdsWanted, ObjectStyles, ViewLineWidths, ViewObjectIds,
    groups::{ObjectGroups, extract_object_groups},
    items::{
        DrawId, DrawIdWithMaterial, IdItems, ObjectIdPipeline, ObjectIdSpecializer, ObjectTable,
        init_object_id_pipeline,
    },
    line_widths::{WideMeshes, WidthViews, attachment, extract_wide_meshes, prepare_line_widths},
    phase::ObjectIdItem,
    sections::{SectionBuffer, SectionTables, extract_sections, prepare_sections},
};
use crate::{
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    schedule::{ComicsSystems, PrepareComics},
};

/// The id of an object in [`ViewObjectIds`](super::ViewObjectIds), 1 to 65535.
///
/// | mesh | entity whose id it has |
/// |---|---|
/// | below an [`OutlineGroup`](crate::OutlineGroup), or with one | the entity with the nearest group |
/// | one of several primitives of a glTF node, in no group | the first of these primitives, in the order of the node's children |
/// | any other | the entity with the mesh |
///
/// Primitives of a glTF node are meshes of one parent whose asset paths end in
/// `#MeshM/PrimitiveP` with the same file and the same `M`, as the engine's glTF loader
/// spawns them. A second mesh with the same `P` begins a second object.
///
/// Entities whose indices differ by a multiple of 65535 have the same id, and no
/// [object edge](crate::ObjectEdges) between them.
pub fn object_id(entity: Entity) -> u16 {
    (entity.index_u32() % 65535 + 1) as u16
}

/// Gets the textures of this frame from the engine's texture cache.
fn prepare_object_ids(
    mut commands: Commands,
    views: Query<(Entity, &IdRequest, Option<&ViewObjectIds>)>,
    stale: Query<Entity, (With<ViewObjectIds>, Without<IdRequest>)>,
    mut textures: ResMut<TextureCache>,
    device: Res<RenderDevice>,
) {
    for (view, request, known) in &views {
        let descriptor = TextureDescriptor {
            label: Some("comics_object_ids"),
            size: Extent3d {
                width: request.size.x,
                height: request.size.y,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: request.samples,
            dimension: TextureDimension::D2,
            format: ID_FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT
                | TextureUsages::TEXTURE_BINDING
                | TextureUsages::COPY_SRC,
            view_formats: &[],
        };
        let cached = textures.get(&device, descriptor);
        if known.is_none_or(|known| known.texture.id() != cached.texture.id()) {
            commands.entity(view).insert(ViewObjectIds {
                texture: cached.texture,
                view: cached.default_view,
            });
        }
    }
    for view in &stale {
        commands.entity(view).remove::<ViewObjectIds>();
    }
}

/// Views whose plan reads ids, or whose ids were drawn in the last frame: while a pipeline
/// compiles, the older plan that is still drawn may read ids that the new one does not.
type WithIds = Or<(With<IdsWanted>, With<IdRequest>)>;

fn queue_object_ids(
    views: Query<
        (
            (&ExtractedView, &RenderVisibleEntities, &Msaa),
            (Option<&IdsWanted>, Option<&IdRequest>),
        ),
        WithIds,
    >,
    (mut items, mut with_widths): (IdItems, ResMut<WidthViews>),
    mut phases: ResMut<ViewSortedRenderPhases<ObjectIdItem>>,
) {
    let mut live: HashSet<RetainedViewEntity> = HashSet::default();
    with_widths.clear();
    for ((view, visible, msaa), (wanted, before)) in &views {
        let widths = with_widths.decide(view.retained_view_entity, wanted, before);
        live.insert(view.retained_view_entity);
        phases.prepare_for_new_frame(view.retained_view_entity);
        let Some(phase) = phases.get_mut(&view.retained_view_entity) else {
            continue;
        };
        let Some(class) = visible.get::<Mesh3d>() else {
            continue;
        };
        for (render_entity, main_entity) in class.iter_visible() {
            if let Some(item) = items.item((*render_entity, *main_entity), *msaa, widths) {
                phase.add_transient(item);
            }
        }
    }
    phases.retain(|view, _| live.contains(view));
}

fn prepare_object_table(
    phases: Res<ViewSortedRenderPhases<ObjectIdItem>>,
    (styles, groups): (Res<ObjectStyles>, Res<ObjectGroups>),
    (sections, section_tables): (Res<SectionBuffer>, Res<SectionTables>),
    (shared, cache): (Res<ObjectIdPipeline>, Res<PipelineCache>),
    mut table: ResMut<ObjectTable>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    let table = &mut *table;
    let objects = table.objects.get_mut();
    objects.clear();
    for item in phases.values().flat_map(|phase| phase.items.values()) {
        let at = item.batch_range.start as usize;
        if objects.len() <= at {
            objects.resize(at + 1, UVec4::ZERO);
        }
        let mesh = item.main_entity().id();
        let slot = styles.slots.get(&mesh).copied();
        let id = object_id(groups.object(mesh));
        let start = sections.start(&section_tables, mesh).unwrap_or(0);
        objects[at] = UVec4::new(u32::from(id), u32::from(slot.unwrap_or(0)), start, 0);
    }
    table.bind_group = None;
    if objects.is_empty() {
        return;
    }
    table.objects.write_buffer(&device, &queue);
    if let (Some(objects), Some(sections)) = (table.objects.binding(), sections.buffer()) {
        table.bind_group = Some(device.create_bind_group(
            "comics_objects",
            &cache.get_bind_group_layout(&shared.layout),
            &BindGroupEntries::sequential((objects, sections.as_entire_binding())),
        ));
    }
}

/// Draws the object ids of a view.
fn draw_object_ids(
    world: &World,
    view: ViewQuery<(
        &ExtractedCamera,
        &ExtractedView,
        &ViewDepthTexture,
        Option<&MainPassResolutionOverride>,
        (&IdRequest, &ViewObjectIds, Option<&ViewLineWidths>),
    )>,
    phases: Option<Res<ViewSortedRenderPhases<ObjectIdItem>>>,
    ledger: Res<StageLedger>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (camera, extracted, depth, resolution, (request, target, widths)) = view.into_inner();
    let Some(phase) = phases
        .as_ref()
        .and_then(|phases| phases.get(&extracted.retained_view_entity))
    else {
        let outcome = StageOutcome::LeftOut(LeftOut::PipelineNotReady);
        return ledger.set(request.camera, ComicsStage::ObjectIds, outcome);
    };
    if depth.texture.sample_count() != request.samples {
        let outcome = StageOutcome::LeftOut(LeftOut::SampleCountMismatch);
        return ledger.set(request.camera, ComicsStage::ObjectIds, outcome);
    }
    let ids = RenderPassColorAttachment {
        view: &target.view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations {
            load: LoadOp::Clear(Default::default()),
            store: StoreOp::Store,
        },
    };
    let count = if widths.is_some() { 2 } else { 1 };
    let mut render_pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
        label: Some("comics_object_ids"),
        color_attachments: &[Some(ids), widths.map(attachment)][..count],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    if let Some(viewport) =
        Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution)
    {
        render_pass.set_camera_viewport(&viewport);
    }
    if let Err(error) = phase.render(&mut render_pass, world, entity) {
        error_once!("the object ids were not drawn: {error:?}");
        return;
    }
    ledger.set(request.camera, ComicsStage::ObjectIds, StageOutcome::Ran);
}

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
        .init_gpu_resource::<SectionBuffer>()
        .init_resource::<SectionTables>()
        .init_gpu_resource::<ObjectTable>()
        .init_resource::<ObjectGroups>()
        .init_resource::<WideMeshes>()
        .init_resource::<WidthViews>()
        .init_resource::<DrawFunctions<ObjectIdItem>>()
        .add_render_command::<ObjectIdItem, DrawId>()
        .add_render_command::<ObjectIdItem, DrawIdWithMaterial>()
        .add_systems(
            RenderStartup,
            init_object_id_pipeline.after(bevy::pbr::init_prepass_pipeline),
        )
        .add_systems(
            ExtractSchedule,
            (
                super::table::extract_object_styles,
                extract_object_groups,
                extract_sections,
                extract_wide_meshes,
            ),
        )
        .add_systems(
            Render,
            (
                prepare_sections.in_set(RenderSystems::PrepareAssets),
                queue_object_ids.in_set(RenderSystems::QueueMeshes),
                sort_phase_system::<ObjectIdItem>.in_set(RenderSystems::PhaseSort),
                prepare_object_table.in_set(RenderSystems::PrepareBindGroups),
                prepare_object_ids.in_set(PrepareComics::Services),
                prepare_line_widths
                    .in_set(PrepareComics::Services)
                    .after(prepare_object_table),
            ),
        )
        .add_systems(
            Core3d,
            draw_object_ids
                .after(Core3dSystems::Prepass)
                .after(ComicsSystems::DepthRange)
                .before(ComicsSystems::Outlines)
                .before(Core3dSystems::MainPass),
        );
}
