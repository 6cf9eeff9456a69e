//! What a view requests of the lines, and the uniform that its passes read.

mod grid;
mod history;
mod line_request;
mod uniform;

pub(crate) use grid::{WORKGROUP, blocks, words};
pub(crate) use history::HistoryRequest;
pub(crate) use line_request::{LineRequest, Search};
pub(crate) use uniform::LinePassUniform;
