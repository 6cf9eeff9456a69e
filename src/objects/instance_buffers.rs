//! The buffers of the instances of a view.

use bevy::render::render_resource::{BindGroup, BufferId};

use crate::gpu::Table;

/// The instances of a view on the GPU, in the order of its draw calls.
#[derive(Default)]
pub(crate) struct InstanceBuffers {
    /// What the engine expands, as its `PreprocessWorkItem`s; empty where the CPU does it.
    pub work: Table<2>,
    /// The records of the instances, after as many unused ones as there are instances of other
    /// passes before them.
    pub records: Table<4>,
    pub expansion: Option<Expansion>,
    /// What the passes bind, and the buffers that are bound.
    pub bound: Option<([BufferId; 2], BindGroup)>,
}

/// What expands the instances of a view.
#[derive(Clone)]
pub(crate) struct Expansion {
    /// The buffers that are bound, and the number of instances.
    pub key: ([BufferId; 5], usize),
    pub group: BindGroup,
}
