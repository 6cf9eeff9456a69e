//! Shaders that run for each sample of a pixel.

use bevy::render::{render_resource::DownlevelFlags, renderer::RenderAdapter};

/// Whether the adapter has them: then `SAMPLE_SHADING` is defined where a shader asks for the
/// number of its sample. Vulkan drivers need not have it; where it is missing, the first sample of
/// a pixel stands for all.
pub(super) fn has_sample_shading(adapter: &RenderAdapter) -> bool {
    let flags = adapter.get_downlevel_capabilities().flags;
    flags.contains(DownlevelFlags::MULTISAMPLED_SHADING)
}
