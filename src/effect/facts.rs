//! The facts about a view that an effect can use.

use bevy::math::{Mat4, UVec2, UVec4, Vec2};

use crate::clock::drawing_seed;

/// Facts about a view that an effect can use when it selects its shader variants
/// and packs its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewFacts {
    /// The viewport in physical pixels: x and y of its top left corner in the
    /// render target, width, height.
    pub viewport: UVec4,
    /// Width and height of the render target in physical pixels.
    pub target_size: UVec2,
    /// Physical pixels per logical pixel.
    pub scale_factor: f32,
    /// World position from normalized device coordinates and the texel of the depth texture.
    pub world_from_clip: Mat4,
    /// Seconds of the app's default clock ([`Time`](bevy::time::Time)).
    pub seconds: f64,
    /// Where the object that effects point at ([`EffectTarget`](crate::EffectTarget)) is in
    /// the viewport, in physical pixels from its top left corner; `None` if the camera has
    /// none, or it is behind the camera.
    pub target: Option<Vec2>,
    /// The effect that requests the lines is not on the camera but implied by
    /// another one ([`Effect::implied`](crate::Effect::implied)). Also true if no
    /// effect requests lines.
    pub lines_implied: bool,
}

impl Default for ViewFacts {
    /// A view of 1280 by 720 physical pixels, at scale factor 1 and time 0, whose world
    /// positions are its normalized device coordinates.
    fn default() -> Self {
        Self {
            viewport: UVec4::new(0, 0, 1280, 720),
            target_size: UVec2::new(1280, 720),
            scale_factor: 1.0,
            world_from_clip: Mat4::IDENTITY,
            seconds: 0.0,
            target: None,
            lines_implied: false,
        }
    }
}

impl ViewFacts {
    /// Number of the drawing that is shown, as a seed for random numbers: 0 to 65535, then
    /// from 0 again. `rate`: drawings per second; at 0 there is one drawing for all time.
    ///
    /// What asks for it with the same rate changes in the same frame, and stands still while
    /// the game's clock does.
    pub fn drawing(&self, rate: f32) -> u32 {
        drawing_seed(self.seconds, rate)
    }
}
