//! Everything that needs a GPU, or a CPU that plays one, in one binary.

mod shaders;
mod wgsl;
