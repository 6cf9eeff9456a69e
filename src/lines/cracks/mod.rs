//! Where the cracks of a view are stored, and how densely they lie; and the geometry of a line
//! along a crack.

mod densities;
mod store;

pub use store::ViewCracks;

pub(crate) use densities::LineDensities;
pub(crate) use store::{CrackBuffers, CrackStore, largest_buffer};
