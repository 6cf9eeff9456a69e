//! The depth map and the range it spans: what the styles know about distance.

pub(crate) mod frame;
mod ping_pong;
pub(crate) mod plugin;
pub(crate) mod prepare;
mod range;
pub(crate) mod readback;
mod reduce;
pub(crate) mod request;
pub(crate) mod smoothing;
pub(crate) mod view;

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

pub use frame::ProjectionKind;
pub(crate) use frame::{DepthFrame, RawDepth};
pub use readback::{DepthBin, DepthHistogram, VisibleDepthRange};
pub use smoothing::{CameraCut, RangeSmoothing};

use crate::settings::{FieldRange, bounded, ordered_planes};

/// How a camera turns distance into the depth map `D`, which is 0 at the
/// nearest and 1 at the farthest end of a range and drives every depth style.
///
/// Without this component a camera uses the default: the range of what is
/// visible (\[CS\] Eq. 4), smoothed over time so that it does not flicker.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DepthMap {
    /// Which distances become 0 and 1, and what lies between.
    /// Default: [`DepthMapping::MinMax`].
    pub mapping: DepthMapping,
    /// Exchanges near and far for the colour styles: the literal reading of
    /// \[CS\] Eq. 6 to 11, in which the foreground takes the atmosphere.
    /// Contours do not change. Default: `false`.
    pub flip: bool,
    /// How far behind the farthest geometry the sky counts, in units of the
    /// depth map; without it the farthest object has no contour.
    /// Range 0 to 10, default 0.05.
    #[reflect(@FieldRange::linear(0.0, 10.0))]
    pub sky_gap: f32,
    /// The smallest range that is spread over the map, as a share of the
    /// nearest distance's reciprocal: a flat wall stays flat instead of showing
    /// the noise of the depth buffer. Range 0 to 1, default 2^-14.
    #[reflect(@FieldRange::logarithmic(0.0, 1.0))]
    pub floor: f32,
    /// The same under an orthographic projection, in world units.
    /// Range 0 to 1e6, default 1e-4.
    #[reflect(@FieldRange::logarithmic(0.0, 1e6).unit("units"))]
    pub orthographic_floor: f32,
    /// How the visible range is found. Every method gives the same bits.
    /// Default: [`ReductionMethod::Auto`].
    pub reduction: ReductionMethod,
    /// Keeps the visible range from flickering; `None` takes the range of every
    /// single frame, as the paper does. A view that stands still has the same
    /// range either way. Default: [`RangeSmoothing::default`]; what it brings and
    /// costs is measured in `docs/report`.
    pub smoothing: Option<RangeSmoothing>,
    /// Holds the visible range as it is, whatever enters or leaves the view,
    /// until this is `false` again: for a scene that must not change its look,
    /// or a photograph. A camera that has not seen anything yet locks onto the
    /// first thing that it sees; when its near or far plane changes, it locks
    /// anew. The reduction still runs; [`DepthMapping::Fixed`] spares it.
    /// Default: `false`.
    pub locked: bool,
}

impl Default for DepthMap {
    fn default() -> Self {
        Self {
            mapping: DepthMapping::default(),
            flip: false,
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
    /// is not finite replaced by its default, near and far in order.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            mapping: self.mapping.sanitized(),
            sky_gap: bounded(self.sky_gap, default.sky_gap, 0.0, 10.0),
            floor: bounded(self.floor, default.floor, 0.0, 1.0),
            orthographic_floor: bounded(
                self.orthographic_floor,
                default.orthographic_floor,
                0.0,
                1e6,
            ),
            smoothing: self
                .smoothing
                .map(RangeSmoothing::sanitized)
                .filter(|smoothing| !smoothing.is_negligible()),
            ..self
        }
    }
}

/// Which distances the depth map spans. Distances are view depths in world
/// units: along the camera's forward axis, not along the ray.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum DepthMapping {
    /// \[CS\] Eq. 4: the nearest visible distance becomes 0, the farthest 1,
    /// linear in between.
    #[default]
    MinMax,
    /// The visible range, logarithmic in between: equal ratios of distance are
    /// equal steps, so that a large landscape keeps contours and colours apart
    /// in its foreground.
    MinMaxLogarithmic,
    /// \[CS\] Eq. 2: linear between the camera's near and far plane, whatever is
    /// visible. The paper's counter-example.
    Linear,
    /// \[CS\] Eq. 3: logarithmic between the camera's near and far plane. Under
    /// an orthographic projection, distances below 1e-4 of the distance between
    /// the planes count as that.
    Logarithmic,
    /// Linear between two distances of your own; no reduction runs.
    Fixed {
        /// The distance that becomes 0, world units. Range 1e-6 to 1e30;
        /// default 0.1 where it is not a number.
        #[reflect(@FieldRange::logarithmic(1e-6, 1e30).unit("units"))]
        near: f32,
        /// The distance that becomes 1, world units; at least 1.001 times
        /// `near`. The two change places when given the other way round.
        #[reflect(@FieldRange::logarithmic(1e-6, 1e36).unit("units"))]
        far: f32,
    },
    /// Logarithmic between two distances of your own; no reduction runs.
    FixedLogarithmic {
        /// As in [`DepthMapping::Fixed`].
        #[reflect(@FieldRange::logarithmic(1e-6, 1e30).unit("units"))]
        near: f32,
        /// As in [`DepthMapping::Fixed`].
        #[reflect(@FieldRange::logarithmic(1e-6, 1e36).unit("units"))]
        far: f32,
    },
}

impl DepthMapping {
    /// Whether the range is that of the visible geometry, found by the
    /// reduction.
    pub fn follows_visible_range(self) -> bool {
        matches!(self, Self::MinMax | Self::MinMaxLogarithmic)
    }

    /// Whether equal ratios of distance are equal steps of the map.
    pub fn is_logarithmic(self) -> bool {
        matches!(
            self,
            Self::MinMaxLogarithmic | Self::Logarithmic | Self::FixedLogarithmic { .. }
        )
    }

    fn sanitized(self) -> Self {
        match self {
            Self::Fixed { near, far } => {
                let (near, far) = ordered_planes(near, far);
                Self::Fixed { near, far }
            }
            Self::FixedLogarithmic { near, far } => {
                let (near, far) = ordered_planes(near, far);
                Self::FixedLogarithmic { near, far }
            }
            other => other,
        }
    }
}

/// How the visible range is found. The result is the same to the bit; the time
/// is not.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ReductionMethod {
    /// [`BarrierFree`](Self::BarrierFree) on CPU adapters, else
    /// [`Subgroup`](Self::Subgroup).
    #[default]
    Auto,
    /// One compute dispatch in which every invocation walks a strip of its own:
    /// no barrier, two atomics a strip.
    BarrierFree,
    /// One compute dispatch with subgroup maxima. Where the adapter has no
    /// subgroups, [`SharedMemory`](Self::SharedMemory) runs.
    Subgroup,
    /// One compute dispatch with a tree in workgroup memory.
    SharedMemory,
    /// The paper's own chain of fragment passes, each half the size of the one
    /// before (\[CS\] 3.1). Needs no compute shaders; slower. Where the adapter
    /// has no compute shaders, every method is this one.
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
