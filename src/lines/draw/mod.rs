//! Draws the ink of lines.

mod strokes;

pub(crate) use strokes::{StrokeList, stroke_layout};
