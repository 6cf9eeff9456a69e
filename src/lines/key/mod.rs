//! What selects the shader variants of the passes, and what they bind.

mod layouts;
mod line_key;
mod pass;

pub(crate) use layouts::{ink_entry, owners_entry, range_entry};
pub(crate) use line_key::LineKey;
pub(crate) use pass::{LinePass, SearchPass};
