//! Records the passes of a view.

mod completing;
mod find_lines;
mod inputs;
mod marks;
mod ready;
mod sources;

pub(crate) use find_lines::find_lines;
#[cfg(feature = "objects")]
pub(crate) use find_lines::find_marks;
#[cfg(feature = "objects")]
pub(crate) use marks::MarkKey;
pub(crate) use marks::{MarkPipeline, ViewMarks, draw_marks};
