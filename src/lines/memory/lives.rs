//! Lines that stay for some frames where their edges have become weak: see `persist.wgsl`.

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

/// The lives of a view's lines, see `lives.wgsl`.
pub(crate) struct LineLives {
    /// Size of the grid.
    size: UVec2,
    /// This frame and the one before.
    buffers: [Buffer; 2],
    cuts: u32,
    settings: Outlines,
    /// Whether the last frame says nothing about this one.
    is_new: bool,
}

impl LineLives {
    /// The lives for the next frame. `kept`: whether the passes of the last frame ran.
    pub fn next(
        before: Option<Self>,
        kept: bool,
        device: &RenderDevice,
        request: &LineRequest,
    ) -> Self {
        let size = UVec2::new(request.rect.z, request.rect.w);
        let settings = request.settings;
        if let Some(mut before) = before.filter(|before| before.size == size) {
            before.buffers.swap(0, 1);
            // Other settings are seen at once.
            let same = before.cuts == request.cuts && before.settings == settings;
            before.is_new = !kept || !same;
            before.cuts = request.cuts;
            before.settings = settings;
            return before;
        }
        // A word for four pixels of a row.
        let bytes = 4 * u64::from(size.x.div_ceil(4).max(1)) * u64::from(size.y.max(1));
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
        let buffer = || buffer(device, "comics_line_lives", bytes, usage);
        Self {
            size,
            buffers: [buffer(), buffer()],
            cuts: request.cuts,
            settings,
            is_new: true,
        }
    }

    /// Clears what the pass does not write, and what says nothing about this frame.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        let [now, past] = &self.buffers;
        encoder.clear_buffer(now, 0, None);
        if self.is_new {
            encoder.clear_buffer(past, 0, None);
        }
    }

    /// The bindings of `persist.wgsl`: the last frame, and this one.
    pub fn entries(&self) -> [BindGroupEntry<'_>; 2] {
        let [now, past] = &self.buffers;
        [
            entry(28, past.as_entire_binding()),
            entry(29, now.as_entire_binding()),
        ]
    }
}
