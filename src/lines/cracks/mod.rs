//! Where the cracks of a view are stored, and the geometry of a line along a crack.

mod store;

pub use store::ViewCracks;
pub(crate) use store::{CrackBuffers, CrackStore, largest_buffer};
