//! The history of lines under temporal anti-aliasing: see `accumulate.wgsl`.

use bevy::{
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, BindGroupEntry, CommandEncoder, IntoBinding, RenderPassDescriptor,
            RenderPipeline, TextureFormat, TextureUsages, TextureViewDescriptor,
        },
        renderer::RenderDevice,
        texture::CachedTexture,
    },
};

use crate::{
    gpu::entry,
    lines::{
        request::HistoryRequest,
        settings::Outlines,
        textures::{cleared, descriptor},
        tiles::{TileList, TileLists, draw_tiles},
    },
};

/// Formats of ink, finer than that of a frame, so that small steps towards it are not lost; and of
/// a raw depth and a number of frames.
pub(crate) const HISTORY_FORMATS: [TextureFormat; 2] =
    [TextureFormat::Rgba16Float, TextureFormat::Rg32Float];

/// The ink of a frame, and the nearest depth around each of its pixels.
struct Frame {
    ink: CachedTexture,
    depth: CachedTexture,
}

/// The history of a view.
pub(crate) struct LineHistory {
    size: UVec2,
    /// This frame and the one before.
    frames: [Frame; 2],
    cuts: u32,
    settings: Outlines,
    /// Whether it is empty.
    pub is_new: bool,
}

impl LineHistory {
    /// The history for the next frame. `kept`: whether that of the last frame was drawn.
    pub fn next(
        before: Option<Self>,
        kept: bool,
        device: &RenderDevice,
        (request, size, settings): (&HistoryRequest, UVec2, &Outlines),
    ) -> Self {
        let [ink, depth] = HISTORY_FORMATS;
        let frame = || Frame {
            ink: texture(device, "comics_history_ink", size, ink),
            depth: texture(device, "comics_history_depth", size, depth),
        };
        let before = before.filter(|before| before.size == size);
        // Other settings are seen at once.
        let same = |before: &Self| before.cuts == request.cuts && before.settings == *settings;
        let same = before.as_ref().is_some_and(same);
        let [past, now] = before.map_or_else(|| [frame(), frame()], |before| before.frames);
        Self {
            size,
            frames: [now, past],
            cuts: request.cuts,
            settings: *settings,
            is_new: !kept || !same,
        }
    }

    /// The ink of this frame.
    pub fn ink(&self) -> &CachedTexture {
        &self.frames[0].ink
    }

    /// The bindings of the last frame.
    pub fn entries(&self) -> [BindGroupEntry<'_>; 2] {
        let past = &self.frames[1];
        [
            entry(25, (&past.ink.default_view).into_binding()),
            entry(26, (&past.depth.default_view).into_binding()),
        ]
    }

    /// Records the pass. `tiles`: those with ink; `None`: all pixels are drawn.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        ready: (&RenderPipeline, &BindGroup),
        tiles: Option<&TileLists>,
    ) {
        let [now, _] = &self.frames;
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_accumulate_lines"),
            color_attachments: &[Some(cleared(&now.ink)), Some(cleared(&now.depth))],
            ..Default::default()
        });
        let tiles = tiles.map(|tiles| (tiles, TileList::Inked));
        draw_tiles(&mut pass, ready, tiles);
    }
}

/// A texture that is not given back to the engine's cache after the frame.
fn texture(
    device: &RenderDevice,
    label: &'static str,
    size: UVec2,
    format: TextureFormat,
) -> CachedTexture {
    let drawn = TextureUsages::RENDER_ATTACHMENT;
    let texture = device.create_texture(&descriptor(label, size, (format, drawn)));
    let default_view = texture.create_view(&TextureViewDescriptor::default());
    CachedTexture {
        texture,
        default_view,
    }
}
