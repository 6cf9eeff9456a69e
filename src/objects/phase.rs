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
    /// It is a transparent mesh, which writes depth. Otherwise the depth prepass has it.
    pub writes_depth: bool,
}

impl ObjectIdItem {
    /// The index of the first transparent mesh in a sorted phase; its length if there is none.
    pub fn first_transparent(phase: &SortedRenderPhase<Self>) -> usize {
        let items = phase.items.values();
        items.take_while(|item| !item.writes_depth).count()
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
    // Opaque meshes come first. Within both groups any order is right: sort by pipeline.
    type SortKey = (FloatOrd, usize);

    fn sort_key(&self) -> Self::SortKey {
        (
            FloatOrd(f32::from(u8::from(self.writes_depth))),
            self.pipeline.id(),
        )
    }

    fn sort(items: &mut IndexMap<(Entity, MainEntity), Self, EntityHash>) {
        items.sort_by_key(|_, item| (item.writes_depth, item.pipeline.id()));
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
