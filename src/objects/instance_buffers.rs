//! The buffers of the instances of a view.

use bevy::render::render_resource::BindGroup;

use crate::gpu::Table;

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
