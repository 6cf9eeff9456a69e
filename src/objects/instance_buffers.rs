//! The buffers of the instances of a view.

use bevy::render::{
    batching::gpu_preprocessing::PreprocessWorkItem,
    render_resource::{BindGroup, BufferId, BufferUsages, RawBufferVec},
};

/// The instances of a view on the GPU, in the order of its draw calls.
pub(crate) struct InstanceBuffers {
    /// What the engine expands; empty where the CPU does it.
    pub work: RawBufferVec<PreprocessWorkItem>,
    /// The records of the instances, after as many unused ones as there are instances of other
    /// passes before them.
    pub records: RawBufferVec<[u32; 4]>,
    pub expansion: Option<Expansion>,
    /// What the passes bind, and the buffers that are bound.
    pub bound: Option<([BufferId; 2], BindGroup)>,
}

impl Default for InstanceBuffers {
    fn default() -> Self {
        Self {
            work: RawBufferVec::new(BufferUsages::STORAGE),
            records: RawBufferVec::new(BufferUsages::STORAGE),
            expansion: None,
            bound: None,
        }
    }
}

/// What expands the instances of a view.
#[derive(Clone)]
pub(crate) struct Expansion {
    /// The buffers that are bound, and the number of instances.
    pub key: ([BufferId; 5], usize),
    pub group: BindGroup,
}
