//! The phase item of an object in the pass that draws ids.

use std::ops::Range;

use bevy::{
    ecs::entity::{Entity, EntityHash},
    math::FloatOrd,
    render::{
        render_phase::{
            CachedRenderPipelinePhaseItem, DrawFunctionId, PhaseItem, PhaseItemExtraIndex,
            SortedPhaseItem, SortedRenderPhase,
        },
        render_resource::CachedRenderPipelineId,
        sync_world::MainEntity,
        view::ExtractedView,
    },
};
use indexmap::IndexMap;

pub(crate) struct ObjectIdItem {
    pub entity: (Entity, MainEntity),
    pub pipeline: CachedRenderPipelineId,
    pub draw_function: DrawFunctionId,
    pub batch_range: Range<u32>,
    pub extra_index: PhaseItemExtraIndex,
    pub indexed: bool,
    pub layer: Layer,
}

/// What an item is drawn into. In a sorted phase, items follow in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Layer {
    /// The object ids: the depth prepass has the mesh.
    Prepass,
    /// The view's own depth: a transparent mesh.
    OwnDepth,
    /// The layer of marked objects.
    Marked,
}

impl ObjectIdItem {
    /// An item that is not in a batch yet.
    pub fn new(
        entity: (Entity, MainEntity),
        pipeline: CachedRenderPipelineId,
        draw_function: DrawFunctionId,
        (indexed, layer): (bool, Layer),
    ) -> Self {
        Self {
            entity,
            pipeline,
            draw_function,
            batch_range: 0..1,
            extra_index: PhaseItemExtraIndex::None,
            indexed,
            layer,
        }
    }

    /// The items of a layer in a sorted phase.
    pub fn of(phase: &SortedRenderPhase<Self>, layer: Layer) -> Range<usize> {
        let before = |layers: fn(Layer, Layer) -> bool| {
            phase
                .items
                .partition_point(|_, item| layers(item.layer, layer))
        };
        before(|a, b| a < b)..before(|a, b| a <= b)
    }
}

impl PhaseItem for ObjectIdItem {
    // Instances must not be batched: the first instance index of an item is the index of
    // its object in the table.
    const AUTOMATIC_BATCHING: bool = false;

    fn entity(&self) -> Entity {
        self.entity.0
    }

    fn main_entity(&self) -> MainEntity {
        self.entity.1
    }

    fn draw_function(&self) -> DrawFunctionId {
        self.draw_function
    }

    fn batch_range(&self) -> &Range<u32> {
        &self.batch_range
    }

    fn batch_range_mut(&mut self) -> &mut Range<u32> {
        &mut self.batch_range
    }

    fn extra_index(&self) -> PhaseItemExtraIndex {
        self.extra_index.clone()
    }

    fn batch_range_and_extra_index_mut(&mut self) -> (&mut Range<u32>, &mut PhaseItemExtraIndex) {
        (&mut self.batch_range, &mut self.extra_index)
    }
}

impl SortedPhaseItem for ObjectIdItem {
    // Layers follow each other. Within each, any order is right: sort by pipeline.
    type SortKey = (FloatOrd, usize);

    fn sort_key(&self) -> Self::SortKey {
        (FloatOrd(f32::from(self.layer as u8)), self.pipeline.id())
    }

    fn sort(items: &mut IndexMap<(Entity, MainEntity), Self, EntityHash>) {
        items.sort_by_key(|_, item| (item.layer, item.pipeline.id()));
    }

    fn recalculate_sort_keys(
        _items: &mut IndexMap<(Entity, MainEntity), Self, EntityHash>,
        _view: &ExtractedView,
    ) {
    }

    fn indexed(&self) -> bool {
        self.indexed
    }
}

impl CachedRenderPipelinePhaseItem for ObjectIdItem {
    fn cached_pipeline(&self) -> CachedRenderPipelineId {
        self.pipeline
    }
}
