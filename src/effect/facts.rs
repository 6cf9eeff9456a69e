//! What an effect may know about the view that it is packed for.

use bevy::math::UVec4;

/// What an effect may know about a view when it packs its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewFacts {
    /// Origin and size of the viewport: x, y, width, height in physical pixels.
    pub viewport: UVec4,
    /// Physical pixels per logical pixel.
    pub scale_factor: f32,
    /// Seconds of the app's default clock ([`Time`](bevy::time::Time)).
    pub seconds: f64,
    /// The effect that requests the lines is implied, not on the camera
    /// ([`Effect::implied`](crate::Effect::implied)).
    pub lines_implied: bool,
}

impl Default for ViewFacts {
    /// A view of 1280 by 720 pixels at time 0.
    fn default() -> Self {
        Self {
            viewport: UVec4::new(0, 0, 1280, 720),
            scale_factor: 1.0,
            seconds: 0.0,
            lines_implied: false,
        }
    }
}
