//! Requests for a view's visible range.

use bevy::prelude::*;

use super::{DepthMap, RangeSmoothing, RawDepth, follow::Followed, frame::DepthProjection};

/// On a view in the render world: a request for its visible range, written in every
/// frame by [`PrepareComics::Choose`](crate::schedule::PrepareComics::Choose).
#[derive(Component, Clone, Debug)]
pub(crate) struct RangeRequest {
    pub camera: Entity,
    pub map: DepthMap,
    pub projection: DepthProjection,
    pub raw: RawDepth,
    /// Size of the viewport in physical pixels.
    pub viewport: UVec2,
    /// The part of the depth texture that the main pass draws: x, y, width,
    /// height.
    pub rect: UVec4,
    /// Samples per pixel of the depth texture.
    pub samples: u32,
    /// The depth map spans a smoothed or locked range, not that of this frame alone.
    pub smooths: bool,
    /// The camera whose range this view takes.
    pub leader: Option<Entity>,
    /// The camera has a `VisibleDepthRange`.
    pub readback: bool,
    /// The camera has a `DepthHistogram`.
    pub histogram: bool,
    /// Divide the visible depths into near, middle and far.
    pub borders: bool,
    /// Find the depth in the middle.
    pub middle: bool,
    /// Some material reads the range.
    #[cfg(feature = "toon")]
    pub materials: bool,
    /// Real time since the last frame, in seconds.
    pub seconds: f32,
    /// Number of cuts of the camera so far.
    pub cuts: u32,
}

impl RangeRequest {
    /// How the range is smoothed.
    pub fn followed(&self) -> Followed {
        Followed {
            smoothing: self.map.smoothing.unwrap_or(RangeSmoothing::OFF),
            locked: self.map.locked,
            projection: self.projection,
            origin: (self.cuts, self.viewport),
            seconds: self.seconds,
        }
    }

    /// Whether the smoothed range is bounded by percentiles.
    pub fn has_outliers(&self) -> bool {
        self.smooths && self.map.smoothing.is_some_and(|s| s.outliers > 0.0)
    }
}
