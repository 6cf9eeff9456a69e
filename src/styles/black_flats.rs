//! Areas of solid ink: steep slopes and deep shadows (\[CS\] 3.2, Figure 4).

use bevy::{
    color::{Color, ColorToComponents},
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec3,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use super::{FieldRange, file_color};
use crate::sanitize::{bounded, bounded_option, displayable};

/// Fills slopes of the depth map and dark areas with flat ink.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct BlackFlats {
    /// Fill where the Prewitt response of the depth map, slopes included, is
    /// above this: the paper's second threshold. Measured as on a map of 512
    /// rows, so that it does not depend on the size of the window. Range 1e-6
    /// to 100; `None` fills no slopes. Default: `None`.
    #[reflect(@FieldRange::logarithmic(1e-6, 100.0))]
    pub slope: Option<f32>,
    /// Fill where the value V of the display colour is below this. Range 0 to
    /// 1; `None` fills no shadows. Default: 0.25.
    #[reflect(@FieldRange::SHARE)]
    pub value: Option<f32>,
    /// How much the value threshold shrinks with distance: at 1 it is
    /// `value * (1 - D)`, so that only the foreground is inked. Range 0 to 1,
    /// default 0.
    #[reflect(@FieldRange::SHARE)]
    pub depth_weight: f32,
    /// Softness of the edge of an area, as a share of its threshold. Range 0
    /// to 1, default 0.1.
    #[reflect(@FieldRange::SHARE)]
    pub feather: f32,
    /// Colour of the ink. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the ink. Range 0 (none, and the pass leaves the style out)
    /// to 1. Default 1.
    #[reflect(@FieldRange::SHARE)]
    pub opacity: f32,
}

const DEFAULT_SLOPE: f32 = 0.02;
const DEFAULT_VALUE: f32 = 0.25;

impl Default for BlackFlats {
    fn default() -> Self {
        Self {
            slope: None,
            value: Some(DEFAULT_VALUE),
            depth_weight: 0.0,
            feather: 0.1,
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

impl BlackFlats {
    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default (0.02 for a slope).
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            slope: bounded_option(self.slope, DEFAULT_SLOPE, 1e-6, 100.0),
            value: bounded_option(self.value, DEFAULT_VALUE, 0.0, 1.0),
            depth_weight: bounded(self.depth_weight, default.depth_weight, 0.0, 1.0),
            feather: bounded(self.feather, default.feather, 0.0, 1.0),
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
        }
    }

    /// Whether slopes are filled, or dark areas by their distance.
    pub fn depends_on_depth(&self) -> bool {
        self.slope.is_some() || (self.value.is_some() && self.depth_weight > 0.0)
    }

    pub(crate) fn is_negligible(&self) -> bool {
        self.opacity == 0.0 || (self.slope.is_none() && self.value.unwrap_or(0.0) == 0.0)
    }

    /// `rows` is the height of the viewport in pixels.
    pub(crate) fn uniform(&self, rows: u32) -> BlackFlatsUniform {
        // smoothstep needs its ends apart: a hard edge rises over a thousandth.
        let feather = self.feather.max(1e-3);
        let slope = self.slope.unwrap_or(1e30);
        BlackFlatsUniform {
            color: Vec3::from_array(self.color.to_linear().to_f32_array_no_alpha()),
            opacity: self.opacity,
            slope_low: slope * (1.0 - feather),
            slope_high: slope * (1.0 + feather),
            value: self.value.unwrap_or(0.0),
            feather,
            depth_weight: self.depth_weight,
            slope_scale: rows.max(1) as f32 / 512.0,
        }
    }
}

/// `BlackFlats` of `black_flats.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BlackFlatsUniform {
    color: Vec3,
    opacity: f32,
    slope_low: f32,
    slope_high: f32,
    value: f32,
    feather: f32,
    depth_weight: f32,
    slope_scale: f32,
}
