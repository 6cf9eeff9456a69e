//! What a view requests of the lines, and the uniform that its passes read.

mod grid;
mod line_request;
mod memory;
mod uniform;

pub(crate) use grid::{WORKGROUP, blocks, words};
pub(crate) use line_request::{LineRequest, Search};
pub(crate) use memory::MemoryRequest;
pub(crate) use uniform::LinePassUniform;
