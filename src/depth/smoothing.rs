//! Smooths the visible range over time, so that the picture does not flicker:
//! settings and event. \[CS\] leaves this as future work.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, impl_sanitized};

/// Smooths the visible range of a [`DepthMap`](crate::DepthMap) over time, so that it
/// does not flicker when something small or short-lived enters or leaves the view.
///
/// There are four stages, in this order: percentiles, the median of three frames,
/// hysteresis, and an exponential approach. A setting of 0 (or `false`) leaves its
/// stage out. While the range lags behind the scene, distances outside of it map to
/// 0 or 1.
///
/// In a still view, the range settles to exactly that of the view, bit for bit, whatever was shown
/// before. An end that hysteresis holds beside the visible geometry waits until everything that it
/// saw for 4 seconds was on one side of it. Then it moves to the middle of that with a time
/// constant of 2 seconds (or its own, if that is longer): at 60 frames per second by at most 1 % of
/// the hysteresis per frame. If the geometry moves back and forth around the end, the end does not
/// move.
///
/// The state is one per camera and stays on the GPU. It starts with the first frame
/// that shows geometry, and anew after a [`CameraCut`], when the size of the view
/// changes, and when the projection gives raw depth another meaning: when the near
/// plane changes, or the far plane of an orthographic projection. An oblique near plane
/// may move. Without compute shaders there is no smoothing.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RangeSmoothing {
    /// Fraction of the visible geometry, in pixels, that may be outside of the
    /// range at each end, so that a few pixels do not stretch the range.
    /// Range 0 to 0.2, default 0; 0.005 is a good first value.
    ///
    /// Where geometry that covers about this fraction comes and goes, the range
    /// flickers more than with 0 (measured in `docs/report`). Has no effect with
    /// `ReductionMethod::PingPong`.
    ///
    /// The fraction is found in bins (see [`DepthHistogram`](crate::depth::DepthHistogram)) and
    /// interpolated inside of a bin. In perspective a bin is a ninth of a distance or
    /// less. Under an orthographic projection it is 0.8 % of the distance between the
    /// nearest and the farthest geometry, less towards both; there the bins are those of
    /// the frame before, so that the first frame of a view uses the extremes.
    #[reflect(@FieldRange::linear(0.0, 0.2))]
    pub outliers: f32,
    /// Takes the median of the last three frames, so that geometry that is visible
    /// for one frame changes nothing. Delays the range by one frame.
    /// Default: `true`.
    pub despike: bool,
    /// Change of distance, in octaves, that an end of the range ignores for some seconds. An end
    /// that has begun to move follows the scene until it is within a quarter of this, then comes to
    /// rest. Under an orthographic projection the unit is the length of the range. Range 0 to 4,
    /// default 0.07 (5 % of a distance).
    #[reflect(@FieldRange::linear(0.0, 4.0).unit("oct"))]
    pub hysteresis: f32,
    /// Time constant with which the range grows, in seconds of real time: 63 % of a
    /// change is made up after this time, 95 % after three times this time, at any
    /// frame rate (within 0.4 % of the time, up to 1000 frames per second). Range 0 to
    /// 60, default 0.1.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("s"))]
    pub expand: f32,
    /// Time constant with which the range shrinks, in seconds of real time.
    /// Range 0 to 60, default 1.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("s"))]
    pub shrink: f32,
}

impl Default for RangeSmoothing {
    fn default() -> Self {
        Self {
            outliers: 0.0,
            despike: true,
            hysteresis: 0.07,
            expand: 0.1,
            shrink: 1.0,
        }
    }
}

impl RangeSmoothing {
    /// No smoothing: the range of each single frame.
    pub const OFF: Self = Self {
        outliers: 0.0,
        despike: false,
        hysteresis: 0.0,
        expand: 0.0,
        shrink: 0.0,
    };

    /// Whether it changes nothing.
    pub fn is_negligible(&self) -> bool {
        *self == Self::OFF
    }
}

impl_sanitized!(RangeSmoothing);

/// Tells a camera that its next frame does not continue the last one, after a cut or
/// a teleport. Its smoothed range starts anew.
///
/// ```
/// # use bevy::ecs::prelude::*;
/// # use bevy_comics::CameraCut;
/// fn cut(mut commands: Commands, camera: Entity) {
///     commands.trigger(CameraCut { entity: camera });
/// }
/// ```
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
pub struct CameraCut {
    /// The camera that was cut.
    pub entity: Entity,
}

/// Number of cuts of a camera so far.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CameraCuts(pub u32);

pub(crate) fn count_cut(
    cut: On<CameraCut>,
    mut cameras: Query<Option<&mut CameraCuts>, With<Camera>>,
    mut commands: Commands,
) {
    match cameras.get_mut(cut.entity) {
        Ok(Some(mut cuts)) => cuts.0 = cuts.0.wrapping_add(1),
        Ok(None) => {
            commands.entity(cut.entity).insert(CameraCuts(1));
        }
        Err(_) => warn_once!("CameraCut: {} is not a camera", cut.entity),
    }
}
