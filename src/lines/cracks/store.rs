//! Where the cracks of a view are stored.

use bevy::{
    prelude::*,
    render::{
        render_resource::{BindGroupEntry, Buffer, BufferUsages, CommandEncoder, IntoBinding},
        renderer::RenderDevice,
        texture::CachedTexture,
    },
};

use crate::{gpu, lines::request::words};

/// The cracks of a view.
pub(crate) enum CrackStore {
    /// Those of every pixel, drawn by `find.wgsl`.
    Texture(CachedTexture),
    /// Those of every pixel, written by `cells.wgsl` and completed by `settle.wgsl`.
    Buffers(CrackBuffers),
}

impl CrackStore {
    /// The bindings of `stored.wgsl`, after this number of copies of the planes.
    pub fn entries(&self, copies: usize) -> Vec<BindGroupEntry<'_>> {
        match self {
            Self::Texture(texture) => vec![gpu::entry(11, (&texture.default_view).into_binding())],
            Self::Buffers(buffers) => {
                let mut entries = vec![entry(11, &buffers.words), buffers.planes_entry(copies)];
                entries.extend(buffers.bends.as_ref().map(|bends| entry(19, bends)));
                entries
            }
        }
    }
}

fn entry(binding: u32, buffer: &Buffer) -> BindGroupEntry<'_> {
    gpu::entry(binding, buffer.as_entire_binding())
}

/// Bytes of the cracks of a pixel, and of how their lines leave them.
const CRACKS: u64 = 8;
const BENDS: u64 = 4;
/// Bytes of a word of a plane.
const WORD: u64 = 4;
/// Rows from a word of corners to the next one in a column.
const CORNER_ROWS: u32 = 4;

/// Bytes of the largest buffer of a view's cracks.
pub(crate) fn largest_buffer(rect: UVec4) -> u64 {
    CRACKS * u64::from(rect.z) * u64::from(rect.w)
}

/// On a view in the render world: the cracks of its last frame, the borders between pixels
/// that lines run along. Only with compute shaders.
///
/// The buffers can be others in every frame, and longer than what they hold. They can be
/// copied from. A pixel of the part of the depth texture that the main pass draws has a crack
/// to the east and one to the south, of four bytes each; pixels follow row by row. Only the
/// planes are cleared in every frame: what the other buffers hold of a pixel is of this frame
/// if one of its cracks was found or is a part of a line.
#[derive(Component, Clone, Debug)]
pub struct ViewCracks {
    /// The part of the depth texture: x, y, width, height in pixels.
    pub rect: UVec4,
    /// For each pixel the crack to the east, then that to the south; 0 for none. Bits 0 to
    /// 2: kinds (silhouette, crease, object edge; with an `EdgeStyle`, both of the first two are a
    /// convex crease); bit 3: the line belongs to the pixel itself, not to its neighbor; bits 4
    /// to 11: ink; 12 to 19: opacity, both from 0 to 255; 20 to 31: half the width.
    pub words: Buffer,
    /// Where cracks are: words of 32 pixels of a column, bit 0 at the top. Eight planes, each
    /// from left to right and then down: cracks to the east and to the south that are parts of
    /// lines, those that were found to the east and to the south, those to the east and to the
    /// south that only join lines, and silhouettes to the east and to the south. Of lines that
    /// are neither linked nor smooth nor weighted, only those that were found are stored: all of
    /// them are parts of lines. Behind the planes is what only the crate reads.
    pub planes: Buffer,
    /// For each pixel how the lines of its cracks leave them: the lower half of a word is
    /// that of the crack to the east. Bits 0 to 7: the offset across the crack in 256ths of a
    /// pixel, plus 128; bits 8 to 15: the slope in 64ths, plus 128. `None` if lines are not
    /// smooth.
    pub bends: Option<Buffer>,
}

/// The buffers of a view's cracks.
pub(crate) struct CrackBuffers {
    words: Buffer,
    /// Planes of bits, see `planes.wgsl`: a pass that links reads one and adds to the
    /// other.
    planes: [Buffer; 2],
    bends: Option<Buffer>,
    /// Bytes of the planes, and of the corners behind them.
    used: [u64; 2],
    /// Bytes of the cracks of lines: of the two planes by columns, which are the first ones, and of
    /// those to the south by rows, which are the last.
    lines: [u64; 2],
}

impl CrackBuffers {
    /// Buffers for a rectangle; those of `before` are used again if they fit.
    pub fn new(before: Option<Self>, device: &RenderDevice, rect: UVec4, bends: bool) -> Self {
        let words = words(rect);
        let pixels = u64::from(rect.z) * u64::from(rect.w);
        let columns = u64::from(words.y) * u64::from(rect.z);
        let rows = u64::from(words.x) * u64::from(rect.w);
        let corners = u64::from(rect.z + 1) * u64::from(rect.w / CORNER_ROWS + 2);
        let used = [8 * columns + rows, corners].map(|words| WORD * words);
        let lines = [2 * columns, rows].map(|words| WORD * words);
        let before = before.map(|b| (Some(b.words), Some(b.planes), b.bends));
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let take = |size: u64, label, old: Option<Buffer>| {
            let size = size.max(16);
            old.filter(|old| gpu::is_reused(old.size(), size))
                .unwrap_or_else(|| gpu::buffer(device, label, size, usage))
        };
        let (old_words, old_planes, old_bends) = before.unwrap_or_default();
        let old_planes = old_planes.map_or([None, None], |planes| planes.map(Some));
        Self {
            words: take(CRACKS * pixels, "comics_cracks", old_words),
            planes: old_planes.map(|old| take(used.iter().sum(), "comics_crack_planes", old)),
            bends: bends.then(|| take(BENDS * pixels, "comics_crack_bends", old_bends)),
            used,
            lines,
        }
    }

    /// The buffers after this number of copies of the planes.
    pub fn shown(&self, rect: UVec4, copies: usize) -> ViewCracks {
        ViewCracks {
            rect,
            words: self.words.clone(),
            planes: self.planes[copies % 2].clone(),
            bends: self.bends.clone(),
        }
    }

    /// Removes all cracks.
    pub fn clear(&self, encoder: &mut CommandEncoder) {
        encoder.clear_buffer(&self.planes[0], 0, Some(self.used[0]));
    }

    /// Removes all corners, after this number of copies of the planes.
    pub fn clear_corners(&self, encoder: &mut CommandEncoder, copies: usize) {
        let [planes, corners] = self.used;
        encoder.clear_buffer(&self.planes[copies % 2], planes, Some(corners));
    }

    /// Copies the planes of a buffer to the other, after this number of copies. Later passes only add to
    /// the cracks of lines, so all other planes are copied once.
    pub fn copy_planes(&self, encoder: &mut CommandEncoder, copies: usize) {
        let [from, to] = [copies, copies + 1].map(|i| &self.planes[i % 2]);
        let [columns, rows] = self.lines;
        let by_rows = self.used[0] - rows;
        let by_columns = if copies == 0 { by_rows } else { columns };
        encoder.copy_buffer_to_buffer(from, 0, to, 0, by_columns);
        encoder.copy_buffer_to_buffer(from, by_rows, to, by_rows, rows);
    }

    /// The bindings of `cells.wgsl`.
    pub fn cell_entries(&self) -> [BindGroupEntry<'_>; 2] {
        [entry(18, &self.words), entry(21, &self.planes[0])]
    }

    /// The bindings of `link.wgsl`, which reads the planes `from` a buffer.
    pub fn link_entries(&self, from: usize) -> [BindGroupEntry<'_>; 2] {
        [
            entry(20, &self.planes[from]),
            entry(21, &self.planes[1 - from]),
        ]
    }

    /// The bindings of `close_gaps.wgsl`, which reads the planes `from` a buffer.
    pub fn gaps_entries(&self, from: usize) -> [BindGroupEntry<'_>; 3] {
        let [read, written] = self.link_entries(from);
        [read, written, entry(18, &self.words)]
    }

    /// The planes, of which `from` is the number of copies so far.
    pub fn planes_entry(&self, from: usize) -> BindGroupEntry<'_> {
        entry(20, &self.planes[from % 2])
    }

    /// The planes for a pass that reads and adds to them.
    pub fn written_planes(&self, copies: usize) -> BindGroupEntry<'_> {
        entry(21, &self.planes[copies % 2])
    }

    /// The bindings of `settle.wgsl`, which reads the planes `from` a buffer.
    pub fn settle_entries(&self, from: usize) -> Vec<BindGroupEntry<'_>> {
        let bends = self.bends.as_ref().map(|bends| entry(22, bends));
        [entry(18, &self.words), self.planes_entry(from)]
            .into_iter()
            .chain(bends)
            .collect()
    }
}
