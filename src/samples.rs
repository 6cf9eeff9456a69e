//! Definitions of shaders that read multisampled textures.

use bevy::{
    render::{render_resource::DownlevelFlags, renderer::RenderAdapter},
    shader::ShaderDefVal,
};

/// `MULTISAMPLED` and the number `SAMPLES`, if there are several samples. A shader could ask the
/// texture for their number, but not in OpenGL ES.
pub(crate) fn definitions(samples: u32) -> impl Iterator<Item = ShaderDefVal> {
    let number = ShaderDefVal::UInt("SAMPLES".into(), samples);
    (samples > 1)
        .then(|| ["MULTISAMPLED".into(), number])
        .into_iter()
        .flatten()
}

/// Whether shaders can be run for each sample: then `SAMPLE_SHADING` is defined where a shader asks for
/// the number of its sample. Vulkan drivers need not have it; where it is missing, the first sample of a
/// pixel stands for all.
pub(crate) fn can_be_shaded(adapter: &RenderAdapter) -> bool {
    let flags = adapter.get_downlevel_capabilities().flags;
    flags.contains(DownlevelFlags::MULTISAMPLED_SHADING)
}
