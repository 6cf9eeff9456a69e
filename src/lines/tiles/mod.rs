//! The tiles of pixels that may have ink, and the cells that have cracks.

mod lists;

pub(crate) use lists::{TileList, TileLists, draw_tiles, tile_shader, vertices};
