//! Draws object ids: every mesh of the depth prepass is drawn again where its depth is
//! equal to that of the prepass (`depth_test/`: or nearly so).
//!
//! Skins, morph targets and materials with their own vertex shader are correct, because
//! the vertex shader is that of the prepass. Alpha masks are correct, because what the
//! prepass discarded fails the depth test.

use bevy::{
    core_pipeline::prepass::{MotionVectorPrepass, NormalPrepass},
    ecs::system::SystemParam,
    pbr::MeshPipelineKey,
    platform::{collections::HashSet, time::Instant},
    prelude::*,
    render::{
        camera::DirtySpecializations,
        render_resource::TextureUsages,
        renderer::RenderDevice,
        sync_world::{MainEntity, MainEntityHashSet},
        texture::TextureCache,
        view::{
            ExtractedView, RenderVisibleEntities, RenderVisibleEntitiesClass, RetainedViewEntity,
        },
    },
};

use super::{
    DepthWanted, DepthWrites, ID_FORMAT, IdRequest, IdsWanted, ObjectStyles, QueuedDepth,
    ViewObjectIds,
    changes::ChangedObjects,
    depth_test::DepthTest,
    groups::ObjectGroups,
    highlights::HighlightedObjects,
    items::{Drawn, IdItems, Missing},
    layer::LayerRequest,
    levels::{FadingMeshes, Levels},
    line_widths::WidthViews,
    object_ids::ObjectIds,
    phase::{Bin, Instance, Layer, ObjectIdPhase, ObjectIdPhases, PhaseKey},
    ranged::InRange,
    sections::SectionStarts,
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
/// views into whose depth transparent meshes are drawn, or with highlighted objects.
type WithIds = Or<(
    With<IdsWanted>,
    With<IdRequest>,
    With<LayerRequest>,
    With<DepthWanted>,
)>;

/// What is drawn for a view, and how its prepass is drawn.
type Queued<'w> = (
    Option<&'w FadingMeshes>,
    (
        Option<&'w IdsWanted>,
        Option<&'w IdRequest>,
        Has<LayerRequest>,
    ),
    (Option<&'w DepthWanted>, Option<&'w QueuedDepth>),
    (&'w Msaa, Has<NormalPrepass>, Has<MotionVectorPrepass>),
);

/// The instances of a mesh are made by these.
type Items<'w> = (
    IdItems<'w>,
    TransparentItems<'w>,
    Records<'w>,
    ResMut<'w, WidthViews>,
    Res<'w, DepthTest>,
);

/// What has changed since the last frame.
type Changes<'w, 's> = (
    Res<'w, DirtySpecializations>,
    Res<'w, ChangedObjects>,
    InRange<'w, 's>,
);

pub(super) fn queue_object_ids(
    mut commands: Commands,
    views: Query<(Entity, &ExtractedView, &RenderVisibleEntities, Queued), WithIds>,
    stale: Query<Entity, (With<QueuedDepth>, Without<DepthWanted>)>,
    (mut items, mut transparent, mut records, mut with_widths, test): Items,
    changes: Changes,
    mut phases: ResMut<ObjectIdPhases>,
) {
    let started = Instant::now();
    with_widths.clear();
    for view in &stale {
        commands.entity(view).remove::<QueuedDepth>();
    }
    for phase in phases.views.values_mut() {
        phase.live = false;
    }
    for (entity, view, visible, (fading, ids, (wanted, queued), msaa)) in &views {
        let (msaa, has_normals, has_motion) = msaa;
        let widths = with_widths.decide(view.retained_view_entity, ids.0, ids.1);
        let asked = ids.0.copied().unwrap_or_default();
        let layer = asked.layer || ids.2;
        let ids = (asked.ids, ids.1.is_some());
        let phase = phases.views.entry(view.retained_view_entity).or_default();
        phase.live = true;
        let Some(class) = visible.get::<Mesh3d>() else {
            phase.clear(&mut records.ids);
            continue;
        };
        let mut view_key =
            MeshPipelineKey::from_msaa_samples(msaa.samples()) | MeshPipelineKey::DEPTH_PREPASS;
        // The engine then binds the view with the uniform of the last frame.
        view_key.set(MeshPipelineKey::MOTION_VECTOR_PREPASS, has_motion);
        view_key.set(MeshPipelineKey::INVERT_CULLING, view.invert_culling);
        let key = PhaseKey {
            view: view_key,
            ids: ids.0 || ids.1,
            widths,
            layer,
            targets: wanted.map(|wanted| QueuedDepth {
                ids: ids.0,
                normals: wanted.normals && has_normals,
            }),
            tolerant: test.tolerant(),
            compiles_ahead: test.compiles_ahead(),
        };
        let mut queue = Queue {
            phase,
            items: &mut items,
            transparent: &mut transparent,
            records: &mut records,
            key,
        };
        let out = changes.2.out_of_range(entity, view);
        let fading = fading.filter(|_| key.targets.is_some());
        let FadingMeshes { meshes, gone } = fading.cloned().unwrap_or_default();
        let levels = [out, meshes, gone];
        queue.update((view.retained_view_entity, class), &changes, levels);
        if test.compiles_ahead() {
            phase.note_ahead(&test, &items);
        }
        let writes = key.targets.filter(|_| phase.has(Layer::OwnDepth));
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
    phases.views.retain(|_, phase| {
        if !phase.live {
            phase.clear(&mut records.ids);
        }
        phase.live
    });
    phases.elapsed = started.elapsed();
}

/// Makes the instances of a view.
struct Queue<'a, 'w> {
    phase: &'a mut ObjectIdPhase,
    items: &'a mut IdItems<'w>,
    transparent: &'a mut TransparentItems<'w>,
    records: &'a mut Records<'w>,
    key: PhaseKey,
}

impl Queue<'_, '_> {
    /// Takes away and adds what has changed, or everything if the view has.
    fn update(
        &mut self,
        (view, class): (RetainedViewEntity, &RenderVisibleEntitiesClass),
        (dirty, changed, _): &Changes,
        levels: [MainEntityHashSet; 3],
    ) {
        let ObjectIdPhase {
            out_of_range,
            fading,
            gone,
            ..
        } = &mut *self.phase;
        let mut crossed = Vec::new();
        for (known, now) in [out_of_range, fading, gone].into_iter().zip(levels) {
            let before = std::mem::replace(known, now);
            crossed.extend(before.symmetric_difference(known).copied());
        }
        let outdated = dirty.must_wipe_specializations_for_view(view);
        if self.phase.begin(self.key, outdated, &mut self.records.ids) {
            for (_, mesh) in class.iter_visible() {
                self.add(*mesh);
            }
        } else {
            let pending = std::mem::take(&mut self.phase.pending);
            let others = changed.0.iter().chain(&crossed);
            for mesh in dirty.iter_to_dequeue(view, class).chain(others.clone()) {
                self.phase.remove(*mesh, &mut self.records.ids);
            }
            for (_, mesh) in dirty.iter_to_queue(view, class, &HashSet::default()) {
                self.add(*mesh);
            }
            for mesh in others
                .chain(&pending)
                .filter(|mesh| is_visible(class, **mesh))
            {
                self.add(*mesh);
            }
        }
        self.phase.settle();
    }

    /// The bin of a mesh that fades: it is drawn whole into the depth that effects read.
    fn fading_bin(&mut self, mesh: MainEntity) -> Option<Result<(Bin, u32), Missing>> {
        let targets = self.key.targets?;
        let fades = self.phase.fading.contains(&mesh) && !self.items.is_backdrop(mesh);
        fades.then(|| self.transparent.fading_bin(mesh, self.key.view, targets))
    }

    /// Adds a visible mesh, if it is not there.
    fn add(&mut self, mesh: MainEntity) {
        if self.phase.contains(mesh) || self.phase.out_of_range.contains(&mesh) {
            return;
        }
        let drawn = Drawn::Ids {
            widths: self.key.widths,
        };
        let fading = self.fading_bin(mesh);
        let mut found = fading.unwrap_or(Err(Missing::NotDrawn));
        if fading.is_none() && self.key.ids {
            found = self.items.bin(mesh, self.key.view, drawn);
        }
        if let (Err(Missing::NotDrawn), Some(targets)) = (found, self.key.targets) {
            found = self.transparent.bin(mesh, self.key.view, targets);
        }
        if let Ok((bin, input)) = found {
            let cutoff = fading.and_then(|_| self.transparent.alpha_mask(mesh));
            let is_gone = self.phase.gone.contains(&mesh);
            let record = self.records.of(mesh.id(), cutoff, is_gone);
            self.phase.add(bin, Instance::new(mesh, input, record));
        }
        if self.key.layer && self.records.highlights.of(mesh.id()).is_some() {
            let highlighted = self.items.bin(mesh, self.key.view, Drawn::Highlighted);
            if let Ok((bin, input)) = highlighted
                && let Some(record) = self.records.highlighted(mesh.id())
            {
                self.phase.add(bin, Instance::new(mesh, input, record));
            }
            if found.is_err() {
                found = highlighted;
            }
        }
        if let Err(Missing::NotLoaded) = found {
            self.phase.pending.insert(mesh);
        }
    }
}

fn is_visible(class: &RenderVisibleEntitiesClass, mesh: MainEntity) -> bool {
    let listed = (class.entities_cpu_culling).binary_search_by_key(&mesh, |(_, main)| *main);
    listed.is_ok() || class.entities_gpu_culling.contains_key(&mesh)
}

/// What is known of objects by their entities.
#[derive(SystemParam)]
pub(super) struct Records<'w> {
    ids: ResMut<'w, ObjectIds>,
    styles: Res<'w, ObjectStyles>,
    groups: Res<'w, ObjectGroups>,
    levels: Res<'w, Levels>,
    highlights: Res<'w, HighlightedObjects>,
    writes: Res<'w, DepthWrites>,
    sections: Res<'w, SectionStarts>,
}

impl Records<'_> {
    /// Id, style slot, start of the sections and bits of the least alpha of a mesh.
    fn of(&mut self, mesh: Entity, alpha_mask: Option<f32>, is_gone: bool) -> [u32; 4] {
        let faded = self.styles.faded.get(mesh).filter(|_| is_gone);
        let slot = faded.or_else(|| self.styles.slots.get(mesh));
        let slot = slot.copied().unwrap_or(0);
        let id = self.ids.give(self.levels.object(self.groups.object(mesh)));
        let start = self.sections.get(mesh).unwrap_or(0);
        let cutoff = self.writes.0.get(mesh);
        let cutoff = cutoff.copied().or(alpha_mask);
        [
            u32::from(id),
            u32::from(slot),
            start,
            cutoff.map_or(0, |cutoff| cutoff.to_bits()),
        ]
    }

    /// The same of a mesh in the layer of highlighted objects.
    fn highlighted(&mut self, mesh: Entity) -> Option<[u32; 4]> {
        let (root, slot) = self.highlights.of(mesh)?;
        Some([u32::from(self.ids.give(root)), u32::from(slot), 0, 0])
    }
}
