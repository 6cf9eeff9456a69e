//! Finds cracks in depth, normals and object ids.

mod resolve;

pub(crate) use resolve::{Resolved, resolved_formats};
