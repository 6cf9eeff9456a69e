//! The phase item of an object in the pass that draws ids.

use std::ops::Range;

use bevy::{
    ecs::entity::{Entity, EntityHash},
    math::FloatOrd,
    render::{
        render_phase::{
            CachedRenderPipelinePhaseItem, DrawFunctionId, PhaseItem, PhaseItemExtraIndex,
            SortedPhaseItem,
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
    /// It is drawn into the layer of marked objects.
    pub marked: bool,
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
    // Depth is already complete, so any order is right: sort by pipeline. Those of the layer
    // come last.
    type SortKey = (FloatOrd, usize);

    fn sort_key(&self) -> Self::SortKey {
        (FloatOrd(0.0), self.pipeline.id())
    }

    fn sort(items: &mut IndexMap<(Entity, MainEntity), Self, EntityHash>) {
        items.sort_by_key(|_, item| (item.marked, item.pipeline.id()));
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
