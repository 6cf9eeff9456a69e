//! What lines keep of the frames before: weak edges, and ink.

mod line_memory;
mod lives;

pub(crate) use line_memory::{LineMemory, MemoryKey, MemoryPipeline};
pub(crate) use lives::LineLives;
