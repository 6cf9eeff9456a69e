//! Draws object ids: every mesh of the depth prepass is drawn again where its depth is
//! equal to that of the prepass (`depth_test/`: or nearly so).
//!
//! Skins, morph targets and materials with their own vertex shader are correct, because
//! the vertex shader is that of the prepass. Alpha masks are correct, because what the
//! prepass discarded fails the depth test.

use bevy::{
    app::{App, SubApp},
    core_pipeline::{
        prepass::{MotionVectorPrepass, NormalPrepass},
        schedule::{Core3d, Core3dSystems},
    },
    ecs::{
        entity::Entity,
        query::{Has, Or, With, Without},
        schedule::IntoScheduleConfigs,
        system::{Commands, Query, Res, ResMut},
    },
    math::UVec4,
    mesh::Mesh3d,
    pbr::{MeshPipeline, MeshPipelineKey},
    platform::collections::HashSet,
    render::{
        ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderDebugFlags, RenderStartup,
        RenderSystems,
        render_phase::{
            AddRenderCommand, DrawFunctions, PhaseItem, SortedRenderPhase, SortedRenderPhasePlugin,
            ViewSortedRenderPhases, sort_phase_system,
        },
        render_resource::{
            BindGroupEntries, Extent3d, PipelineCache, SpecializedMeshPipelines, TextureDescriptor,
            TextureDimension, TextureUsages,
        },
        renderer::{RenderDevice, RenderQueue},
        sync_world::MainEntity,
        texture::TextureCache,
        view::{ExtractedView, Msaa, RenderVisibleEntities, RetainedViewEntity},
    },
};

use super::{
    DepthWanted, DepthWrites, ID_FORMAT, IdRequest, IdsWanted, ObjectStyles, QueuedDepth,
    ViewObjectIds,
    draw::draw_object_ids,
    groups::{ObjectGroups, extract_object_groups},
    items::{
        DrawId, DrawIdWithMaterial, Drawn, IdItems, ObjectIdPipeline, ObjectIdSpecializer,
        ObjectTable, init_object_id_pipeline,
    },
    layer::{LayerRequest, MarkSpecializer, prepare_layers},
    lightmaps::{Lightmapped, extract_lightmapped},
    line_widths::{WideMeshes, WidthViews, extract_wide_meshes, prepare_line_widths},
    marks::{Marks, extract_marks},
    phase::{Layer, ObjectIdItem},
    sections::{SectionBuffer, SectionTables, extract_sections, prepare_sections},
    transparent::TransparentItems,
};
use crate::schedule::{ComicsSystems, PrepareComics};

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
/// [object edge](crate::lines::ObjectEdges) between them.
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
/// compiles, the older plan that is still drawn may read ids that the new one does not. And
/// views into whose depth transparent meshes are drawn, or with marked objects.
type WithIds = Or<(
    With<IdsWanted>,
    With<IdRequest>,
    With<LayerRequest>,
    With<DepthWanted>,
)>;

/// What is drawn for a view, and how its prepass is drawn.
type Queued<'w> = (
    (
        Option<&'w IdsWanted>,
        Option<&'w IdRequest>,
        Has<LayerRequest>,
    ),
    (Option<&'w DepthWanted>, Option<&'w QueuedDepth>),
    (&'w Msaa, Has<NormalPrepass>, Has<MotionVectorPrepass>),
);

/// The items of an object are made by these.
type Items<'w> = (
    IdItems<'w>,
    TransparentItems<'w>,
    Res<'w, Marks>,
    ResMut<'w, WidthViews>,
);

fn queue_object_ids(
    mut commands: Commands,
    views: Query<(Entity, &ExtractedView, &RenderVisibleEntities, Queued), WithIds>,
    stale: Query<Entity, (With<QueuedDepth>, Without<DepthWanted>)>,
    (mut items, mut transparent, marks, mut with_widths): Items,
    mut phases: ResMut<ViewSortedRenderPhases<ObjectIdItem>>,
) {
    let mut live: HashSet<RetainedViewEntity> = HashSet::default();
    with_widths.clear();
    for view in &stale {
        commands.entity(view).remove::<QueuedDepth>();
    }
    for (entity, view, visible, (ids, (wanted, queued), (msaa, has_normals, has_motion))) in &views
    {
        let widths = with_widths.decide(view.retained_view_entity, ids.0, ids.1);
        let asked = ids.0.copied().unwrap_or_default();
        let layer = asked.layer || ids.2;
        let ids = (asked.ids, ids.1.is_some());
        live.insert(view.retained_view_entity);
        phases.prepare_for_new_frame(view.retained_view_entity);
        let Some(phase) = phases.get_mut(&view.retained_view_entity) else {
            continue;
        };
        let Some(class) = visible.get::<Mesh3d>() else {
            continue;
        };
        let mut key =
            MeshPipelineKey::from_msaa_samples(msaa.samples()) | MeshPipelineKey::DEPTH_PREPASS;
        // The engine then binds the view with the uniform of the last frame.
        key.set(MeshPipelineKey::MOTION_VECTOR_PREPASS, has_motion);
        let targets = wanted.map(|wanted| QueuedDepth {
            ids: ids.0,
            normals: wanted.normals && has_normals,
        });
        let writes = queue_objects(
            phase,
            (&mut items, &mut transparent, &marks),
            class.iter_visible().map(|(own, main)| (*own, *main)),
            &Queue {
                key,
                ids: ids.0 || ids.1,
                widths,
                layer,
                targets,
            },
        );
        match writes {
            Some(targets) if queued != Some(&targets) => {
                commands.entity(entity).insert(targets);
            }
            None if queued.is_some() => {
                commands.entity(entity).remove::<QueuedDepth>();
            }
            _ => {}
        }
    }
    phases.retain(|view, _| live.contains(view));
}

/// What is queued for a view.
struct Queue {
    key: MeshPipelineKey,
    ids: bool,
    /// The widths of lines are drawn with the ids.
    widths: bool,
    /// The layer of marked objects.
    layer: bool,
    /// What transparent meshes are drawn into.
    targets: Option<QueuedDepth>,
}

/// Queues the visible objects of a view. Returns what transparent meshes are drawn into, if
/// there are any.
fn queue_objects(
    phase: &mut SortedRenderPhase<ObjectIdItem>,
    (items, transparent, marks): (&mut IdItems, &mut TransparentItems, &Marks),
    visible: impl Iterator<Item = (Entity, MainEntity)>,
    queue: &Queue,
) -> Option<QueuedDepth> {
    let mut writes = None;
    let drawn = Drawn::Ids {
        widths: queue.widths,
    };
    for object in visible {
        if queue.ids
            && let Some(item) = items.item(object, queue.key, drawn)
        {
            phase.add_transient(item);
        } else if let Some(targets) = queue.targets
            && let Some(item) = transparent.item(object, queue.key, targets)
        {
            phase.add_transient(item);
            writes = Some(targets);
        }
        let marked = queue.layer && marks.of(object.1.id()).is_some();
        if marked && let Some(item) = items.item(object, queue.key, Drawn::Marked) {
            // Under a key of its own, because the object has an item already.
            let own = (Entity::PLACEHOLDER, object.1);
            phase.items.insert(own, item);
            phase.transient_items.push(own);
        }
    }
    writes
}

/// What is known of objects by their entities.
type Tables<'w> = (
    Res<'w, ObjectStyles>,
    Res<'w, ObjectGroups>,
    Res<'w, Marks>,
    Res<'w, DepthWrites>,
);

pub(super) fn prepare_object_table(
    phases: Res<ViewSortedRenderPhases<ObjectIdItem>>,
    (styles, groups, marks, writes): Tables,
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
        if let Some((root, slot)) = marks.of(mesh).filter(|_| item.layer == Layer::Marked) {
            objects[at] = UVec4::new(u32::from(object_id(root)), u32::from(slot), 0, 0);
            continue;
        }
        let slot = styles.slots.get(&mesh).copied();
        let id = object_id(groups.object(mesh));
        let start = sections.start(&section_tables, mesh).unwrap_or(0);
        let cutoff = writes
            .cutoffs
            .get(&mesh)
            .map_or(0, |cutoff| cutoff.to_bits());
        objects[at] = UVec4::new(u32::from(id), u32::from(slot.unwrap_or(0)), start, cutoff);
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
    super::depth_test::build_render(render_app);
    super::depths::build(render_app);
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
                super::table::extract_object_styles,
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
                (
                    prepare_object_ids,
                    prepare_layers,
                    super::update_mark_styles,
                )
                    .in_set(PrepareComics::Services),
                prepare_line_widths
                    .in_set(PrepareComics::Services)
                    .after(prepare_object_table),
            ),
        )
        .add_systems(
            Core3d,
            draw_object_ids
                .after(Core3dSystems::Prepass)
                // With occlusion culling, it writes what indirect draws read.
                .after(bevy::pbr::main_build_indirect_parameters)
                .before(ComicsSystems::DepthRange)
                .before(ComicsSystems::Outlines)
                .before(Core3dSystems::MainPass),
        );
}
