//! Where it is stored how densely the lines of a view lie.

use bevy::{
    prelude::*,
    render::{
        render_resource::{BindGroupEntry, Buffer, BufferUsages},
        renderer::RenderDevice,
    },
};

use crate::gpu::{buffer, entry};

/// Pixels along the sides of the squares that a workgroup of `density.wgsl` begins with: 8 x 8
/// squares, of 8 pixels and then of 64.
const GROUPS: [u32; 2] = [64, 512];
/// Pixels along the side of the smallest squares.
const SQUARE: u32 = 8;

/// The lengths of lines per area in squares of 8 to 512 pixels, see `budget.wgsl`.
pub(crate) struct LineDensities {
    buffer: Buffer,
    /// Size of the grid in pixels.
    size: UVec2,
}

impl LineDensities {
    /// Densities for a rectangle; the buffer of `before` is used again if it is large enough.
    pub fn new(before: Option<Self>, device: &RenderDevice, rect: UVec4) -> Self {
        let size = rect.zw();
        let squares = |pixels: u32| u64::from(pixels.div_ceil(SQUARE).max(1));
        // See `square_index`.
        let bytes = 4 * squares(size.x) * (2 * squares(size.y) + 8);
        let before = before.map(|before| before.buffer);
        let buffer = before
            .filter(|buffer| buffer.size() >= bytes)
            .unwrap_or_else(|| buffer(device, "comics_densities", bytes, BufferUsages::STORAGE));
        Self { buffer, size }
    }

    pub fn entry(&self) -> BindGroupEntry<'_> {
        entry(33, self.buffer.as_entire_binding())
    }

    /// Dispatches a pass of `density.wgsl`.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, coarse: bool) {
        let side = GROUPS[usize::from(coarse)];
        let groups = (self.size + side - 1) / side;
        pass.dispatch_workgroups(groups.x, groups.y, 1);
    }
}
