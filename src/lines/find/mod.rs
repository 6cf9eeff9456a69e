//! One sample of every pixel of a multisampled view: see `resolve.wgsl`.

use bevy::{
    core_pipeline::prepass::NORMAL_PREPASS_FORMAT,
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, CommandEncoder, RenderPassDescriptor, RenderPipeline, TextureFormat,
            TextureUsages,
        },
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
};

use crate::{
    lines::{
        key::LineKey,
        request::LineRequest,
        textures::{cleared, texture},
        tiles::draw_tiles,
    },
    objects::{ID_FORMAT, WIDTH_FORMAT},
};

/// A texel of the engine's depth prepass, which is a `Depth32Float`.
const DEPTH_FORMAT: TextureFormat = TextureFormat::R32Float;

/// Formats by `@location` for the pass's part of a key; `None`: it is not written.
pub(crate) fn resolved_formats(key: LineKey) -> [Option<TextureFormat>; 4] {
    [
        Some(DEPTH_FORMAT),
        (key.contains(LineKey::NORMALS)).then_some(NORMAL_PREPASS_FORMAT),
        (key.contains(LineKey::OBJECT_IDS)).then_some(ID_FORMAT),
        (key.contains(LineKey::WIDTH_MAP)).then_some(WIDTH_FORMAT),
    ]
}

/// One sample per pixel of the prepass textures, valid inside [`LineRequest::rect`].
pub(crate) struct Resolved {
    pub depth: CachedTexture,
    pub normal: Option<CachedTexture>,
    pub ids: Option<CachedTexture>,
    pub widths: Option<CachedTexture>,
}

impl Resolved {
    /// Gets the textures of this frame. `key`: the pass's part of it; `size`: that of the depth
    /// texture.
    pub fn new(
        (textures, device): (&mut TextureCache, &RenderDevice),
        key: LineKey,
        size: UVec2,
    ) -> Self {
        let [_, normal, ids, widths] = resolved_formats(key);
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let mut new = |label, format| texture((textures, device), label, size, (format, drawn));
        Self {
            depth: new("comics_resolved_depth", DEPTH_FORMAT),
            normal: normal.map(|format| new("comics_resolved_normals", format)),
            ids: ids.map(|format| new("comics_resolved_ids", format)),
            widths: widths.map(|format| new("comics_resolved_widths", format)),
        }
    }

    /// Records the pass.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        request: &LineRequest,
        ready: (&RenderPipeline, &BindGroup),
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_resolve_samples"),
            color_attachments: &[
                Some(cleared(&self.depth)),
                self.normal.as_ref().map(cleared),
                self.ids.as_ref().map(cleared),
                self.widths.as_ref().map(cleared),
            ],
            ..Default::default()
        });
        let [x, y, width, height] = request.rect.to_array().map(|v| v as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        draw_tiles(&mut pass, ready, None);
    }
}
