//! The service of the depth map: the range of visible depths, and the map that
//! effects read distance from.

mod axis;
mod bends;
pub(crate) mod follow;
pub(crate) mod frame;
pub(crate) mod passes;
mod ping_pong;
pub(crate) mod plugin;
pub(crate) mod prepare;
pub(crate) mod range;
mod range_of;
pub(crate) mod readback;
mod reduce;
pub(crate) mod request;
pub(crate) mod smoothing;
pub(crate) mod surfaces;
pub(crate) mod view;
pub(crate) mod view_pass;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

pub use axis::DepthAxis;
pub use frame::ProjectionKind;
pub(crate) use frame::{DepthFrame, RawDepth};
pub use readback::{DepthBin, DepthHistogram, VisibleDepthRange};
pub use smoothing::{CameraCut, RangeSmoothing};

use crate::settings::{BlendField, FieldRange, NotFinite, clamp_fields};

/// Whether some material reads the smoothed range of each view that has a plan.
#[derive(Resource, Default)]
pub(crate) struct MaterialsReadRange(pub bool);

/// How a camera turns distance into the depth map `D`: 0 at the near end of a
/// range of distances, 1 at its far end. Every effect that depends on distance
/// reads it.
///
/// A camera without this component uses the default: the visible range, as in
/// \[CS\] Eq. 4, but smoothed over time so that it does not flicker.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthMap {
    /// Distances that map to 0 and 1, and the scale between them.
    /// Default: [`DepthMapping::MinMax`].
    #[reflect(@BlendField::Fields)]
    pub mapping: DepthMapping,
    /// Exchanges near and far for the effects that read `D` as a gradient, such as desaturation and
    /// colorization, so that the atmosphere is in the foreground. Contours and outlines do not
    /// change. Default: `false`. `true` is the literal reading of \[CS\] Eq. 6 to 11.
    pub flip: bool,
    /// Distance from which on geometry counts as sky, in world units: it has no lines, is at the far end of the
    /// map and does not belong to the visible range. For skies and horizons that are meshes; single meshes
    /// can have a `Backdrop` instead. Range 0.001 to 1e30; `None` is nowhere. Default: `None`.
    #[reflect(@FieldRange::logarithmic(1e-3, 1e30).unit("units"))]
    pub sky_beyond: Option<f32>,
    /// Distance from the farthest geometry to the sky for contours, in units of the
    /// depth map. At 0 the farthest object has no contour against the sky.
    /// Range 0 to 10, default 0.05.
    #[reflect(@FieldRange::linear(0.0, 10.0))]
    pub sky_gap: f32,
    /// Smallest range that fills the whole map, as a fraction of its far distance:
    /// `1 - near / far`. It keeps the noise of the depth buffer invisible where
    /// all geometry is at nearly the same distance, for example a flat wall.
    /// Range 0 to 1, default 2^-14. `orthographic_floor` replaces it under an
    /// orthographic projection.
    #[reflect(@FieldRange::logarithmic(0.0, 1.0))]
    pub floor: f32,
    /// Smallest range that fills the whole map under an orthographic projection,
    /// in world units. Range 0 to 1e6, default 1e-4.
    #[reflect(@FieldRange::logarithmic(0.0, 1e6).unit("units"))]
    pub orthographic_floor: f32,
    /// Method that computes the visible range. Every method gives the same result,
    /// bit for bit. Default: [`ReductionMethod::Auto`].
    pub reduction: ReductionMethod,
    /// Smooths the visible range over time so that it does not flicker; `None`
    /// uses the range of each single frame, as the paper does. In a view that does not
    /// change for some seconds, both are the same unless `outliers` is above 0.
    /// Default: [`RangeSmoothing::default`]. Its benefit and its cost are measured
    /// in `docs/report`.
    pub smoothing: Option<RangeSmoothing>,
    /// Holds the visible range, whatever enters or leaves the view, until this is
    /// `false` again: for a scene whose colors must not change, or a photograph.
    /// Default: `false`.
    ///
    /// If the camera has not seen any geometry yet, it holds the range of the first
    /// frame that shows some. A change of its near plane, or of the far plane of an
    /// orthographic projection, takes a new range.
    /// The reduction still runs; [`DepthMapping::Fixed`] avoids it. Needs compute
    /// shaders.
    pub locked: bool,
}

impl Default for DepthMap {
    fn default() -> Self {
        Self {
            mapping: DepthMapping::default(),
            flip: false,
            sky_beyond: None,
            sky_gap: 0.05,
            floor: 1.0 / 16384.0,
            orthographic_floor: 1e-4,
            reduction: ReductionMethod::default(),
            smoothing: Some(RangeSmoothing::default()),
            locked: false,
        }
    }
}

impl DepthMap {
    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default, near and far in order, smoothing
    /// that changes nothing replaced by `None`.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let map = clamp_fields(Self {
            sky_beyond: self.sky_beyond.filter(|distance| distance.is_finite()),
            ..self
        });
        Self {
            mapping: map.mapping.ordered(),
            smoothing: (map.smoothing).filter(|smoothing| !smoothing.is_negligible()),
            ..map
        }
    }
}

/// Which distances the depth map spans, and on which scale.
///
/// Distances are view depths in world units, measured along the camera's forward
/// axis, not along the ray. Under an orthographic projection, logarithmic scales
/// treat distances below 1e-4 of the distance between the camera's planes as that
/// distance.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum DepthMapping {
    /// Linear from the nearest visible distance (0) to the farthest (1).
    /// \[CS\] Eq. 4.
    #[default]
    MinMax,
    /// Logarithmic from the nearest visible distance (0) to the farthest (1): equal
    /// ratios of distance are equal steps, so that contours and colors stay
    /// distinct in the foreground of a large landscape.
    MinMaxLogarithmic,
    /// Linear from the camera's near plane (0) to its far plane (1), whatever is
    /// visible. \[CS\] Eq. 2, the paper's counter-example.
    Linear,
    /// Logarithmic from the camera's near plane (0) to its far plane (1), whatever
    /// is visible. \[CS\] Eq. 3.
    Logarithmic,
    /// Linear between two given distances; no reduction runs.
    Fixed {
        /// Distance that maps to 0, in world units. Range 1e-6 to 1e30; 0.1 if it
        /// is not finite.
        #[reflect(@FieldRange::logarithmic(1e-6, 1e30).unit("units"), @NotFinite(0.1))]
        from: f32,
        /// Distance that maps to 1, in world units. Range 1e-6 to 1e36, at least
        /// 1.001 times `from`; 1000 if it is not finite. If it is below `from`, the
        /// two are exchanged.
        #[reflect(@FieldRange::logarithmic(1e-6, 1e36).unit("units"), @NotFinite(1000.0))]
        to: f32,
    },
    /// Logarithmic between two given distances; no reduction runs.
    FixedLogarithmic {
        /// Distance that maps to 0, as in [`DepthMapping::Fixed`].
        #[reflect(@FieldRange::logarithmic(1e-6, 1e30).unit("units"), @NotFinite(0.1))]
        from: f32,
        /// Distance that maps to 1, as in [`DepthMapping::Fixed`].
        #[reflect(@FieldRange::logarithmic(1e-6, 1e36).unit("units"), @NotFinite(1000.0))]
        to: f32,
    },
}

impl DepthMapping {
    /// Whether the map spans the visible range, which the reduction computes in
    /// every frame.
    pub fn follows_visible_range(self) -> bool {
        matches!(self, Self::MinMax | Self::MinMaxLogarithmic)
    }

    /// Whether the scale is logarithmic: equal ratios of distance are equal steps.
    pub fn is_logarithmic(self) -> bool {
        matches!(
            self,
            Self::MinMaxLogarithmic | Self::Logarithmic | Self::FixedLogarithmic { .. }
        )
    }

    /// With near and far in order, and apart.
    fn ordered(mut self) -> Self {
        if let Self::Fixed { from, to } | Self::FixedLogarithmic { from, to } = &mut self {
            let (near, far) = (f32::min(*from, *to), f32::max(*from, *to));
            (*from, *to) = (near, far.max(near * (1.0 + 1e-3)));
        }
        self
    }
}

/// Method that computes the visible range. Results are identical, bit for bit; only
/// the times differ.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ReductionMethod {
    /// `BarrierFree` on CPU adapters, otherwise `Subgroup`.
    #[default]
    Auto,
    /// One compute dispatch without barriers: every invocation reduces a strip of
    /// 256 by 2 pixels and writes the result with two atomic operations.
    BarrierFree,
    /// One compute dispatch that reduces with subgroup operations. Where the
    /// adapter has none, `SharedMemory` runs instead.
    Subgroup,
    /// One compute dispatch that reduces as a tree in workgroup memory.
    SharedMemory,
    /// A chain of fragment passes, each of which reduces blocks of 2 by 2. Slower,
    /// but needs no compute shaders: where the adapter has none, it runs instead of
    /// every other method. \[CS\] 3.1.
    PingPong,
}

impl ReductionMethod {
    /// The method's name in reports and diagnostics.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "Auto",
            Self::BarrierFree => "BarrierFree",
            Self::Subgroup => "Subgroup",
            Self::SharedMemory => "SharedMemory",
            Self::PingPong => "PingPong",
        }
    }
}
