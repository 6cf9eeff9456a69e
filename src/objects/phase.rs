//! The meshes that the pass of object ids draws in each view, in bins: those of a bin are the
//! instances of one draw call. Bins are kept from frame to frame, so a frame without changes does
//! nothing for each mesh.

use std::{collections::BTreeMap, ops::Range, time::Duration};

use bevy::{
    pbr::MeshPipelineKey,
    platform::collections::{HashMap, HashSet},
    prelude::*,
    render::{
        render_phase::{
            CachedRenderPipelinePhaseItem, DrawError, DrawFunctionId, DrawFunctions, PhaseItem,
            PhaseItemExtraIndex, TrackedRenderPass,
        },
        render_resource::{BindGroup, CachedRenderPipelineId},
        sync_world::{MainEntity, MainEntityHashMap, MainEntityHashSet},
        view::RetainedViewEntity,
    },
};

use super::{QueuedDepth, object_ids::ObjectIds};
use crate::gpu::Table;

/// A draw call.
pub(crate) struct ObjectIdItem {
    pub bin: Bin,
    /// The first mesh of the bin: the draw functions bind what it has.
    mesh: MainEntity,
    pub instances: Range<u32>,
    extra_index: PhaseItemExtraIndex,
}

/// What meshes of one draw call have in common. Draw calls follow in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Bin {
    pub layer: Layer,
    pub pipeline: CachedRenderPipelineId,
    pub draw_function: DrawFunctionId,
    /// `None` if the pipeline does not read the material.
    pub material: Option<u32>,
    pub mesh: AssetId<Mesh>,
    /// Whether the bindings of a skin are bound.
    pub skinned: bool,
    /// A mesh that is drawn alone.
    pub alone: Option<MainEntity>,
    /// The pipeline of the tolerant depth test, while it compiles ahead of its use.
    pub ahead: Option<CachedRenderPipelineId>,
}

/// What an item is drawn into.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Layer {
    /// The object ids: the depth prepass has the mesh.
    Prepass,
    /// The view's own depth: a transparent mesh.
    OwnDepth,
    /// The layer of highlighted objects.
    Highlighted,
}

impl PhaseItem for ObjectIdItem {
    fn entity(&self) -> Entity {
        Entity::PLACEHOLDER
    }

    fn main_entity(&self) -> MainEntity {
        self.mesh
    }

    fn draw_function(&self) -> DrawFunctionId {
        self.bin.draw_function
    }

    fn batch_range(&self) -> &Range<u32> {
        &self.instances
    }

    fn batch_range_mut(&mut self) -> &mut Range<u32> {
        &mut self.instances
    }

    fn extra_index(&self) -> PhaseItemExtraIndex {
        self.extra_index.clone()
    }

    fn batch_range_and_extra_index_mut(&mut self) -> (&mut Range<u32>, &mut PhaseItemExtraIndex) {
        (&mut self.instances, &mut self.extra_index)
    }
}

impl CachedRenderPipelinePhaseItem for ObjectIdItem {
    fn cached_pipeline(&self) -> CachedRenderPipelineId {
        self.bin.pipeline
    }
}

/// A mesh in a bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Instance {
    pub mesh: MainEntity,
    /// Where the engine has uploaded the mesh's transform.
    pub input: u32,
    /// What `ids.wgsl` reads of it. The first is the id that its object gave it.
    pub record: [u32; 4],
}

impl Instance {
    pub fn new(mesh: MainEntity, input: u32, record: [u32; 4]) -> Self {
        Self {
            mesh,
            input,
            record,
        }
    }
}

/// [`Instance::input`] of a mesh that has left its bin.
const GONE: u32 = u32::MAX;

/// The meshes of a bin, sorted, except for those that were added since the last
/// [`ObjectIdPhase::settle`].
#[derive(Default)]
struct Contents {
    bin: Option<Bin>,
    instances: Vec<Instance>,
    /// The number of those that are sorted.
    sorted: usize,
}

/// What the pipelines of a view's bins depend on, besides meshes and materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PhaseKey {
    pub view: MeshPipelineKey,
    pub ids: bool,
    /// The widths of lines are drawn with the ids.
    pub widths: bool,
    /// The layer of highlighted objects.
    pub layer: bool,
    /// What transparent meshes are drawn into.
    pub targets: Option<QueuedDepth>,
    /// Depth is compared with a tolerance.
    pub tolerant: bool,
    /// The pipelines that do so compile ahead of their use.
    pub compiles_ahead: bool,
}

/// The instances of a view on the GPU, in the order of its draw calls.
#[derive(Default)]
pub(crate) struct InstanceBuffers {
    /// What the engine expands, as its `PreprocessWorkItem`s; empty where the CPU does it.
    pub work: Table<2>,
    /// The records of the instances, after as many unused ones as there are instances of other
    /// passes before them.
    pub records: Table<4>,
    /// What the pass that expands them binds.
    pub expansion: Option<BindGroup>,
    /// What the passes that draw them bind.
    pub bound: Option<BindGroup>,
}

/// The bins of a view.
#[derive(Default)]
pub(crate) struct ObjectIdPhase {
    key: Option<PhaseKey>,
    bins: BTreeMap<Bin, usize>,
    contents: Vec<Contents>,
    /// Unused places of `contents`.
    free: Vec<usize>,
    /// The contents that have changed since the last [`settle`](Self::settle).
    touched: HashSet<usize>,
    /// The contents that a mesh is in: that of its ids or its own depth, and that of the highlighted objects.
    places: MainEntityHashMap<[Option<u32>; 2]>,
    /// Meshes whose assets have not loaded.
    pub pending: MainEntityHashSet,
    /// Meshes that fade, see [`FadingMeshes`](super::levels::FadingMeshes).
    pub fading: MainEntityHashSet,
    /// Those of them that have mostly faded to nothing.
    pub gone: MainEntityHashSet,
    /// Meshes that the GPU leaves out.
    pub out_of_range: MainEntityHashSet,
    /// Whether draw calls and buffers have yet to follow the bins.
    pub changed: bool,
    /// The draw calls of this frame.
    pub items: Vec<ObjectIdItem>,
    pub buffers: InstanceBuffers,
    /// Whether the view was drawn in this frame.
    pub live: bool,
    /// Meshes that were added so far.
    pub added: usize,
}

impl ObjectIdPhase {
    /// Empties the bins if what their pipelines depend on has changed; returns whether it has.
    pub fn begin(&mut self, key: PhaseKey, outdated: bool, ids: &mut ObjectIds) -> bool {
        let is_new = outdated || self.key != Some(key);
        if is_new {
            self.clear(ids);
            self.key = Some(key);
        }
        is_new
    }

    /// Empties the bins.
    pub fn clear(&mut self, ids: &mut ObjectIds) {
        self.changed |= !self.bins.is_empty();
        for instance in self
            .contents
            .iter()
            .flat_map(|contents| &contents.instances)
        {
            ids.take(instance.record[0] as u16);
        }
        self.bins.clear();
        self.contents.clear();
        self.free.clear();
        self.touched.clear();
        self.places.clear();
        self.pending.clear();
    }

    pub fn contains(&self, mesh: MainEntity) -> bool {
        self.places.contains_key(&mesh)
    }

    /// Takes a mesh out of its bins. It must not have been added since the last
    /// [`settle`](Self::settle).
    pub fn remove(&mut self, mesh: MainEntity, ids: &mut ObjectIds) {
        for bin in self.places.remove(&mesh).into_iter().flatten().flatten() {
            let contents = &mut self.contents[bin as usize];
            let instances = &mut contents.instances[..contents.sorted];
            if let Ok(at) = instances.binary_search_by_key(&mesh, |instance| instance.mesh) {
                instances[at].input = GONE;
                ids.take(instances[at].record[0] as u16);
                self.touched.insert(bin as usize);
            }
        }
    }

    /// Adds a mesh that is not in a bin of this kind.
    pub fn add(&mut self, bin: Bin, instance: Instance) {
        let at = *self.bins.entry(bin).or_insert_with(|| {
            let at = self.free.pop().unwrap_or(self.contents.len());
            self.contents
                .resize_with(self.contents.len().max(at + 1), Default::default);
            self.contents[at].bin = Some(bin);
            at
        });
        self.added += 1;
        self.contents[at].instances.push(instance);
        self.touched.insert(at);
        let kind = usize::from(bin.layer == Layer::Highlighted);
        self.places.entry(instance.mesh).or_default()[kind] = Some(at as u32);
    }

    /// Ends the changes of a frame.
    pub fn settle(&mut self) {
        self.changed |= !self.touched.is_empty();
        for at in self.touched.drain() {
            let contents = &mut self.contents[at];
            let instances = &mut contents.instances;
            instances.retain(|instance| instance.input != GONE);
            instances.sort_by_key(|instance| instance.mesh);
            contents.sorted = instances.len();
            if instances.is_empty()
                && let Some(bin) = contents.bin.take()
            {
                self.bins.remove(&bin);
                self.free.push(at);
            }
        }
    }

    /// The bins in the order of their draw calls, and their meshes.
    pub fn bins(&self) -> impl Iterator<Item = (Bin, &[Instance])> {
        let bins = self.bins.iter();
        bins.map(|(bin, at)| (*bin, self.contents[*at].instances.as_slice()))
    }

    pub fn has(&self, layer: Layer) -> bool {
        self.bins.keys().any(|bin| bin.layer == layer)
    }

    /// Makes the draw call of a bin.
    pub fn draw_call(bin: Bin, mesh: MainEntity, instances: Range<u32>) -> ObjectIdItem {
        ObjectIdItem {
            bin,
            mesh,
            instances,
            extra_index: PhaseItemExtraIndex::None,
        }
    }

    /// Records the draw calls of a layer.
    pub fn render<'w>(
        &self,
        pass: &mut TrackedRenderPass<'w>,
        (world, view): (&'w World, Entity),
        layer: Layer,
    ) -> Result<(), DrawError> {
        let functions = world.resource::<DrawFunctions<ObjectIdItem>>();
        let mut functions = functions.write();
        functions.prepare(world);
        for item in self.items.iter().filter(|item| item.bin.layer == layer) {
            if let Some(function) = functions.get_mut(item.bin.draw_function) {
                function.draw(world, pass, view, item)?;
            }
        }
        Ok(())
    }
}

/// The bins of all views.
#[derive(Resource, Default)]
pub(crate) struct ObjectIdPhases {
    pub views: HashMap<RetainedViewEntity, ObjectIdPhase>,
    /// How long the CPU took this frame to queue, batch and bind them.
    pub elapsed: Duration,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bin(mesh: u128, layer: Layer) -> Bin {
        Bin {
            layer,
            pipeline: CachedRenderPipelineId::INVALID,
            draw_function: DrawFunctions::<ObjectIdItem>::default()
                .write()
                .add(Nothing),
            material: None,
            mesh: AssetId::from(bevy::asset::uuid::Uuid::from_u128(mesh)),
            skinned: false,
            alone: None,
            ahead: None,
        }
    }

    struct Nothing;

    impl bevy::render::render_phase::Draw<ObjectIdItem> for Nothing {
        fn draw<'w>(
            &mut self,
            _: &'w World,
            _: &mut TrackedRenderPass<'w>,
            _: Entity,
            _: &ObjectIdItem,
        ) -> Result<(), DrawError> {
            Ok(())
        }
    }

    /// After any changes, the bins are those of a phase to which the same meshes were added.
    #[test]
    fn bins_that_changed_are_those_of_a_new_phase() {
        let mut phase = ObjectIdPhase::default();
        let mut ids = ObjectIds::default();
        let mut meshes: BTreeMap<MainEntity, (u128, bool, u32)> = BTreeMap::default();
        let mut random = 1_u32;
        for frame in 0..300 {
            let mut changed = HashSet::new();
            for _ in 0..frame % 7 {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let mesh = MainEntity::from(Entity::from_raw_u32(random >> 27).expect("small"));
                if !changed.insert(mesh) {
                    continue;
                }
                phase.remove(mesh, &mut ids);
                meshes.remove(&mesh);
                if random & 8 == 0 {
                    let drawn = (u128::from(random >> 4 & 3), random & 4 == 0, random);
                    meshes.insert(mesh, drawn);
                    add(&mut phase, mesh, drawn);
                }
            }
            phase.settle();
            let mut new = ObjectIdPhase::default();
            for (mesh, drawn) in &meshes {
                add(&mut new, *mesh, *drawn);
            }
            new.settle();
            let [bins, wanted] = [&phase, &new].map(|phase| {
                let bins = phase.bins();
                bins.map(|(bin, meshes)| (bin, meshes.to_vec()))
                    .collect::<Vec<_>>()
            });
            assert_eq!(bins, wanted, "frame {frame}");
        }
    }

    fn add(
        phase: &mut ObjectIdPhase,
        mesh: MainEntity,
        (of, highlighted, input): (u128, bool, u32),
    ) {
        let record = [0, input, 0, 0];
        let instance = Instance::new(mesh, input, record);
        phase.add(bin(of, Layer::Prepass), instance);
        if highlighted {
            phase.add(bin(of, Layer::Highlighted), instance);
        }
    }
}
