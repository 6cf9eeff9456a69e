//! The strokes that extend lines beyond their loose ends: see `ends.wgsl` and `strokes.wgsl`.

use bevy::{
    math::UVec4,
    mesh::VertexBufferLayout,
    render::{
        render_resource::{BindGroupEntry, Buffer, BufferUsages, VertexFormat, VertexStepMode},
        renderer::{RenderDevice, RenderQueue},
    },
};

use crate::gpu::{buffer, entry, is_reused};

/// Bytes of the arguments of the indirect draw and the number of ends, and of a stroke.
const ARGUMENTS: u64 = 32;
const STROKE: u64 = 32;
/// Pixels for each stroke that there is room for. Where there are more ends, which no picture
/// of lines has, some are not extended.
const PIXELS: u64 = 8;

/// The list of a view's strokes.
pub(crate) struct StrokeList {
    buffer: Buffer,
}

impl StrokeList {
    /// An empty list for a grid; the buffer of `before` is used again if it fits.
    pub fn new(
        before: Option<Self>,
        (device, queue): (&RenderDevice, &RenderQueue),
        rect: UVec4,
    ) -> Self {
        let pixels = u64::from(rect.z) * u64::from(rect.w);
        let size = ARGUMENTS + STROKE * pixels.div_ceil(PIXELS).max(1);
        let list = before
            .filter(|list| is_reused(list.buffer.size(), size))
            .unwrap_or_else(|| {
                let drawn = BufferUsages::VERTEX | BufferUsages::INDIRECT;
                let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | drawn;
                Self {
                    buffer: buffer(device, "comics_strokes", size, usage),
                }
            });
        let empty: Vec<u8> = [4u32, 0, 0, 0, 0, 0, 0, 0].map(u32::to_le_bytes).concat();
        queue.write_buffer(&list.buffer, 0, &empty);
        list
    }

    /// The binding of `ends.wgsl`.
    pub fn entry(&self) -> BindGroupEntry<'_> {
        entry(30, self.buffer.as_entire_binding())
    }

    /// Draws the strokes.
    pub fn draw(&self, pass: &mut wgpu::RenderPass) {
        pass.set_vertex_buffer(0, *self.buffer.slice(ARGUMENTS..));
        pass.draw_indirect(&self.buffer, 0);
    }
}

/// An instance of `strokes.wgsl`.
pub(crate) fn stroke_layout() -> VertexBufferLayout {
    let formats = [VertexFormat::Float32x4, VertexFormat::Uint32x4];
    VertexBufferLayout::from_vertex_formats(VertexStepMode::Instance, formats)
}
