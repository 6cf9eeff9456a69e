//! The grid: the pixels of the depth texture that a view draws.

use bevy::{
    math::{IVec2, IVec4, UVec2, UVec4, Vec4},
    render::render_resource::ShaderType,
};

/// `Grid` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    pub rect: IVec4,
    pub from_viewport: Vec4,
    pub reach: i32,
    pub inked: i32,
    pub jump_least: f32,
    pub jump_radius: f32,
    pub words: IVec2,
    pub steps: i32,
    pub min_length: i32,
    pub gap_closing: i32,
    pub hold_frames: i32,
    pub past_size: IVec2,
    pub overshoot: f32,
}

/// Columns and rows of a block: an invocation of `walk.wgsl` walks through one.
const BLOCK: [u32; 2] = [4, 32];

/// Blocks in a workgroup, side by side.
pub(crate) const WORKGROUP: u32 = 32;

/// Number of blocks across and down a part of the depth texture.
pub(crate) fn blocks(rect: UVec4) -> UVec2 {
    UVec2::new(
        rect.z.div_ceil(BLOCK[0]).max(1),
        rect.w.div_ceil(BLOCK[1]).max(1),
    )
}

/// Words of 32 pixels across and down the part of the depth texture with this rectangle.
pub(crate) fn words(rect: UVec4) -> UVec2 {
    UVec2::new(rect.z.div_ceil(32), rect.w.div_ceil(32))
}
