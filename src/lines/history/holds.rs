//! Lines that stay for some frames where their edges have become weak: see `hold.wgsl`.

use bevy::{
    math::UVec2,
    render::{
        render_resource::{BindGroupEntry, Buffer, BufferUsages, CommandEncoder},
        renderer::RenderDevice,
    },
};

use crate::{
    gpu::{buffer, entry},
    lines::{request::LineRequest, settings::Outlines},
};

/// The holds of a frame, for a grid of a size.
struct Frame {
    size: UVec2,
    buffer: Buffer,
}

impl Frame {
    fn new(device: &RenderDevice, size: UVec2) -> Self {
        // A word for four pixels of a row.
        let bytes = 4 * u64::from(size.x.div_ceil(4).max(1)) * u64::from(size.y.max(1));
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        Self {
            size,
            buffer: buffer(device, "comics_line_holds", bytes, usage),
        }
    }
}

/// The holds of a view's lines, see `holds.wgsl`.
pub(crate) struct LineHolds {
    /// This frame and the one before. The size of the main pass may have changed between them.
    frames: [Frame; 2],
    cuts: u32,
    settings: Outlines,
    /// Whether the last frame says nothing about this one.
    is_new: bool,
}

impl LineHolds {
    /// The holds for the next frame. `kept`: whether the passes of the last frame ran.
    pub fn next(
        before: Option<Self>,
        kept: bool,
        device: &RenderDevice,
        request: &LineRequest,
    ) -> Self {
        let size = UVec2::new(request.rect.z, request.rect.w);
        let (cuts, settings) = (request.cuts, request.settings);
        let frame = || Frame::new(device, size);
        // Other settings are seen at once.
        let same = |before: &Self| before.cuts == cuts && before.settings == settings;
        let same = before.as_ref().is_some_and(same);
        let frames = before.map_or_else(|| [frame(), frame()], |before| before.frames);
        let [past, unused] = frames;
        let now = if unused.size == size { unused } else { frame() };
        Self {
            frames: [now, past],
            cuts,
            settings,
            is_new: !kept || !same,
        }
    }

    /// Size of the grid of the last frame.
    pub fn past_size(&self) -> UVec2 {
        self.frames[1].size
    }

    /// Clears what the pass does not write, and what says nothing about this frame.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        let [now, past] = &self.frames;
        encoder.clear_buffer(&now.buffer, 0, None);
        if self.is_new {
            encoder.clear_buffer(&past.buffer, 0, None);
        }
    }

    /// The bindings of `hold.wgsl`: the last frame, and this one.
    pub fn entries(&self) -> [BindGroupEntry<'_>; 2] {
        let [now, past] = &self.frames;
        [
            entry(28, past.buffer.as_entire_binding()),
            entry(29, now.buffer.as_entire_binding()),
        ]
    }
}
