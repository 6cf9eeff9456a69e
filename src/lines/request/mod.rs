//! What a view requests of the lines, and the uniform that its passes read.

mod grid;
mod line_request;

pub(crate) use grid::{WORKGROUP, blocks, words};
pub(crate) use line_request::{HistoryRequest, LinePassUniform, LineRequest, Search};
