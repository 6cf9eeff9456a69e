//! The second axis of a ramp.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use super::RampStop;
use crate::settings::{FieldRange, NotFinite, impl_sanitized};

/// A second ramp of a [`Ramp`](crate::toon::Ramp), and where it is used: the ramp itself applies
/// where there is full detail, this one where there is none (X-Toon: Barla, Thollot and Markosian
/// 2006).
///
/// Between the two, stops move, soften and change their colors, which are mixed in `OKLab`. The
/// first stop becomes the first one, and so on. The shorter ramp's last tone takes the place of
/// those that it lacks.
#[derive(Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RampDetail {
    /// The tones where there is no detail, as [`Ramp::stops`](crate::toon::Ramp::stops). Default:
    /// one tone, white.
    #[reflect(@FieldRange::linear(1.0, 8.0))]
    pub plain: Vec<RampStop>,
    /// Where there is detail. Default: [`DetailAxis::Depth`].
    pub axis: DetailAxis,
}

/// Where a ramp has detail.
///
/// Distances are along the axis of the view, in world units.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum DetailAxis {
    /// Near the eye: `1 - ln(z / from) / ln ratio`.
    Depth {
        /// All detail is nearer than this. Range 1e-4 to 1e6, default 1.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6).unit("units"), @NotFinite(1.0))]
        from: f32,
        /// No detail is farther than this multiple of `from`. Range 1.01 to 1e6, default 10.
        #[reflect(@FieldRange::logarithmic(1.01, 1e6), @NotFinite(10.0))]
        ratio: f32,
    },
    /// At a distance: `1 - (|ln(z / distance)| - ln(1 + clear)) / ln ratio`.
    Focus {
        /// What is in focus. Range 1e-4 to 1e6, default 5.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6).unit("units"), @NotFinite(5.0))]
        distance: f32,
        /// Full detail reaches from `distance / (1 + clear)` to `distance * (1 + clear)`. Range 0 to
        /// 10, default 0.15.
        #[reflect(@FieldRange::linear(0.0, 10.0), @NotFinite(0.15))]
        clear: f32,
        /// Ratio of distances over which detail falls to none, counted from the end of that range.
        /// Range 1.01 to 1e6, default 3.
        #[reflect(@FieldRange::logarithmic(1.01, 1e6), @NotFinite(3.0))]
        ratio: f32,
    },
    /// Where surfaces face the eye: `|n.v|^power`. The second ramp is that of rims.
    Rim {
        /// Range 0.05 to 8, default 1. The larger, the wider is the rim.
        #[reflect(@FieldRange::logarithmic(0.05, 8.0), @NotFinite(1.0))]
        power: f32,
    },
    /// Where surfaces reflect the light: `max(r.v, 0)^power`, with the reflected light `r`. The
    /// second ramp is that outside of highlights. In
    /// [`RampMode::LightFraction`](crate::toon::RampMode::LightFraction), the mean of all lights.
    Highlight {
        /// Range 1 to 200, default 20. The larger, the smaller is the highlight.
        #[reflect(@FieldRange::logarithmic(1.0, 200.0), @NotFinite(20.0))]
        power: f32,
    },
    /// The same everywhere.
    Constant(
        /// 1 is all detail, 0 none. Range 0 to 1, default 1.
        #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
        f32,
    ),
    /// Near the eye, between the nearest and the farthest thing that the camera sees:
    /// `1 - ln(z / nearest) / ln(farthest / nearest)`.
    ///
    /// The range is that of the depth map, smoothed as [`DepthMap::smoothing`] says; where it is
    /// smaller than [`DepthMap::floor`], that is the range. It is found for cameras that have any
    /// component of this crate which reads depth or draws, such as an effect or
    /// [`VisibleDepthRange`], up to 64 of them. In other views, such as those of a camera without
    /// effects, and where nothing is seen in the depth prepass, there is all detail. Cameras with
    /// the same viewport, place, axis and field of view on several targets have one range.
    ///
    /// [`DepthMap::smoothing`]: crate::DepthMap::smoothing
    /// [`DepthMap::floor`]: crate::DepthMap::floor
    /// [`VisibleDepthRange`]: crate::depth::VisibleDepthRange
    VisibleRange,
}

impl Default for RampDetail {
    fn default() -> Self {
        Self {
            plain: vec![RampStop::default()],
            axis: DetailAxis::default(),
        }
    }
}

impl Default for DetailAxis {
    fn default() -> Self {
        Self::Depth {
            from: 1.0,
            ratio: 10.0,
        }
    }
}

impl DetailAxis {
    pub(super) fn definition(self) -> &'static str {
        match self {
            Self::Depth { .. } => "DETAIL_DEPTH",
            Self::Focus { .. } => "DETAIL_FOCUS",
            Self::Rim { .. } => "DETAIL_RIM",
            Self::Highlight { .. } => "DETAIL_HIGHLIGHT",
            Self::Constant(_) => "DETAIL_CONSTANT",
            Self::VisibleRange => "DETAIL_VISIBLE",
        }
    }
}

impl_sanitized!(DetailAxis);

/// `Detail` in `detail.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DetailUniform {
    distance: f32,
    per_log: f32,
    clear: f32,
    number: f32,
}

impl From<DetailAxis> for DetailUniform {
    fn from(axis: DetailAxis) -> Self {
        let none = Self::default();
        match axis.sanitized() {
            DetailAxis::Depth { from, ratio } => Self {
                distance: from,
                per_log: ratio.ln().recip(),
                ..none
            },
            DetailAxis::Focus {
                distance,
                clear,
                ratio,
            } => Self {
                distance,
                per_log: ratio.ln().recip(),
                clear: clear.ln_1p(),
                ..none
            },
            DetailAxis::Rim { power: number }
            | DetailAxis::Highlight { power: number }
            | DetailAxis::Constant(number) => Self { number, ..none },
            DetailAxis::VisibleRange => none,
        }
    }
}
