//! The textures that the passes of lines write and read.

use bevy::{
    math::UVec2,
    render::{
        render_resource::{
            LoadOp, RenderPassColorAttachment, TextureDescriptor, TextureFormat, TextureUsages,
        },
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
};

use crate::gpu;

/// The two cracks of a pixel, see `Crack` in `edge.wgsl`.
pub(crate) const CRACK_FORMAT: TextureFormat = TextureFormat::Rg32Uint;
/// The two best cracks of a pixel's column, see `columns.wgsl`.
pub(crate) const COLUMN_FORMAT: TextureFormat = TextureFormat::Rgba32Uint;
/// The rows with cracks in a block of pixels.
pub(crate) const BLOCK_FORMAT: TextureFormat = TextureFormat::R32Uint;
/// The ink of a pixel, see `draw.wgsl`.
pub(crate) const INK_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// How far away the pixel is that owns a pixel's line, and the sign of a crease, see `draw.wgsl`.
pub(crate) const OWNER_FORMAT: TextureFormat = TextureFormat::Rgba8Sint;

pub(crate) fn texture(
    (textures, device): (&mut TextureCache, &RenderDevice),
    label: &'static str,
    size: UVec2,
    (format, usage): (TextureFormat, TextureUsages),
) -> CachedTexture {
    textures.get(device, descriptor(label, size, (format, usage)))
}

/// A texture that passes of lines write and read.
pub(crate) fn descriptor(
    label: &'static str,
    size: UVec2,
    (format, usage): (TextureFormat, TextureUsages),
) -> TextureDescriptor<'static> {
    let usage = usage | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    gpu::texture(label, (size, 1), format, usage)
}

/// A texture that is cleared to 0 before it is drawn to.
pub(crate) fn cleared(texture: &CachedTexture) -> RenderPassColorAttachment<'_> {
    gpu::attachment(&texture.default_view, LoadOp::default())
}
