//! Draws object ids: every mesh of the depth prepass is drawn again where its depth is
//! equal to that of the prepass (`depth_test/`: or nearly so).
//!
//! Skins, morph targets and materials with their own vertex shader are correct, because
//! the vertex shader is that of the prepass. Alpha masks are correct, because what the
//! prepass discarded fails the depth test.

use bevy::{
    core_pipeline::prepass::{MotionVectorPrepass, NormalPrepass},
    ecs::{
        entity::Entity,
        query::{Has, Or, With, Without},
        system::{Commands, Query, Res, ResMut},
    },
    mesh::Mesh3d,
    pbr::MeshPipelineKey,
    platform::collections::HashSet,
    render::{
        render_phase::{SortedRenderPhase, ViewSortedRenderPhases},
        render_resource::TextureUsages,
        renderer::RenderDevice,
        sync_world::MainEntity,
        texture::TextureCache,
        view::{ExtractedView, Msaa, RenderVisibleEntities, RetainedViewEntity},
    },
};

use super::{
    DepthWanted, ID_FORMAT, IdRequest, IdsWanted, QueuedDepth, ViewObjectIds,
    items::{Drawn, IdItems},
    layer::LayerRequest,
    line_widths::WidthViews,
    marks::Marks,
    phase::ObjectIdItem,
    transparent::TransparentItems,
};
use crate::gpu::texture;

/// Gets the textures of this frame from the engine's texture cache.
pub(super) fn prepare_object_ids(
    mut commands: Commands,
    views: Query<(Entity, &IdRequest, Option<&ViewObjectIds>)>,
    stale: Query<Entity, (With<ViewObjectIds>, Without<IdRequest>)>,
    mut textures: ResMut<TextureCache>,
    device: Res<RenderDevice>,
) {
    for (view, request, known) in &views {
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC;
        let size = (request.size, request.samples);
        let descriptor = texture("comics_object_ids", size, ID_FORMAT, usage);
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

pub(super) fn queue_object_ids(
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
