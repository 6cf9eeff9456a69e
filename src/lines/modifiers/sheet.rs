//! The sheet that lines are drawn on.

use bevy::{math::Vec2, render::render_resource::ShaderType};

/// The sheet that the ink of a view is on: lines, and the dots of a
/// [`Halftone`](crate::Halftone).
///
/// Its height is `sheet_height` of `bevy_comics::effect::sheet` in WGSL, from -1 in its deepest
/// valleys to 1 on its highest hills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Width of the band in which the edges of ink vary, in physical pixels, 0 or more: half of
    /// it outwards in the valleys, and half of it inwards on the hills.
    pub ink_bleed: f32,
    /// How much ink wide lines lose in streaks, 0 to 1.
    pub dry_brush: f32,
    /// Where the sheet begins, in physical pixels from the render target's top left corner.
    pub corner: Vec2,
    /// Places on the sheet per physical pixel, as `sheet_height` takes them.
    pub scale: f32,
    /// Physical pixels per logical pixel.
    pub unit: f32,
    /// Number of the sheet.
    pub seed: u32,
}

/// Of half the width of a line, the part by which its edges may move.
const MOST_SPREAD: f32 = 0.75;

impl Sheet {
    /// The largest half width that a line has anywhere. `half_width`: where the height is 0, in
    /// physical pixels.
    pub(crate) fn largest(&self, half_width: f32) -> f32 {
        half_width + (0.5 * self.ink_bleed).min(MOST_SPREAD * half_width)
    }

    /// As shaders take it. `origin`: the corner of the viewport in the render target.
    pub(crate) fn uniform(self, origin: Vec2) -> SheetUniform {
        SheetUniform {
            origin: origin - self.corner,
            ink_bleed: self.ink_bleed,
            dry_brush: self.dry_brush,
            scale: self.scale,
            unit: self.unit,
            seed: self.seed,
            unused: 0,
        }
    }
}

/// `Sheet` of `sheet.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SheetUniform {
    origin: Vec2,
    pub ink_bleed: f32,
    pub dry_brush: f32,
    scale: f32,
    unit: f32,
    seed: u32,
    unused: u32,
}
