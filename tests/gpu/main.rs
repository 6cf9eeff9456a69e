//! Everything that needs a GPU, or a CPU that plays one, in one binary.

#[path = "../../examples/common/mod.rs"]
mod common;
#[path = "../reference/mod.rs"]
mod reference;

mod device;
mod functions;
mod range;
mod shaders;
mod small;
mod wgsl;
