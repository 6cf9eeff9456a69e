//! The history of lines: what is kept of the frames before.

use bevy::render::render_resource::ShaderType;

/// Frames that a line may be missing in: the same in `history.wgsl`.
const MISSING: u32 = 16;

/// `History` of `history.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HistoryUniform {
    blend_factor: f32,
    spacing: i32,
    tile_frames: u32,
    unused: u32,
}

/// The history of a view's lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HistoryRequest {
    /// Fraction of each frame where lines move.
    pub blend_factor: f32,
    /// Number of camera cuts so far.
    pub cuts: u32,
}

impl HistoryRequest {
    /// The settings as shaders take them. `reach`: pixels of the grid within which lines are
    /// drawn around their owners.
    pub fn uniform(&self, reach: i32, is_new: bool) -> HistoryUniform {
        HistoryUniform {
            blend_factor: if is_new { 1.0 } else { self.blend_factor },
            spacing: (reach / 2).max(1),
            tile_frames: MISSING + 1,
            unused: 0,
        }
    }
}
