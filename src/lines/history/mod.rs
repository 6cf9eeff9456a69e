//! What lines keep of the frames before: weak edges, and ink.

mod holds;
mod line_history;

pub(crate) use holds::LineHolds;
pub(crate) use line_history::{HISTORY_FORMATS, LineHistory};
