//! Records the passes of a view.

mod find_lines;
mod highlights;
mod inputs;
mod ready;
mod sources;

#[cfg(feature = "objects")]
pub(crate) use find_lines::find_highlights;
pub(crate) use find_lines::find_lines;
#[cfg(feature = "objects")]
pub(crate) use highlights::HighlightKey;
pub(crate) use highlights::{HighlightPipeline, ViewHighlights, draw_highlights};
