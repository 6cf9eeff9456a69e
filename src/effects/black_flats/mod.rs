//! Areas of solid ink: steep slopes and deep shadows (\[CS\] 3.2, Figure 4).

use bevy::{
    color::Color,
    ecs::{component::Component, reflect::ReflectComponent},
    math::{FloatExt, Vec3},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Needs, Variants, ViewFacts},
    settings::{
        FieldRange, blend_color, blend_ratio, bounded, bounded_option, displayable, file_color,
        linear_rgb,
    },
};

/// Fills slopes of the depth map and dark areas with flat ink.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
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
    #[reflect(@FieldRange::FRACTION)]
    pub value: Option<f32>,
    /// How much the value threshold shrinks with distance: at 1 it is
    /// `value * (1 - D)`, so that only the foreground is inked. Range 0 to 1,
    /// default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub depth_weight: f32,
    /// Softness of the edge of an area, as a share of its threshold. Range 0
    /// to 1, default 0.1.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Colour of the ink. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the ink. Range 0 (none, and the pass leaves the style out)
    /// to 1. Default 1.
    #[reflect(@FieldRange::FRACTION)]
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
            softness: 0.1,
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

impl BlackFlats {
    /// Whether slopes are filled, or dark areas by their distance.
    pub fn depends_on_depth(&self) -> bool {
        self.slope.is_some() || (self.value.is_some() && self.depth_weight > 0.0)
    }
}

impl Effect for BlackFlats {
    const NAME: &'static str = "black_flats";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::black_flats",
        source: include_str!("black_flats.wgsl"),
        settings: Some("BlackFlats"),
    };
    type Uniform = BlackFlatsUniform;

    fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            // A slope that is no number becomes 0.02.
            slope: bounded_option(self.slope, DEFAULT_SLOPE, 1e-6, 100.0),
            value: bounded_option(self.value, DEFAULT_VALUE, 0.0, 1.0),
            depth_weight: bounded(self.depth_weight, default.depth_weight, 0.0, 1.0),
            softness: bounded(self.softness, default.softness, 0.0, 1.0),
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
        }
    }

    fn strength(&self) -> f32 {
        if self.slope.is_none() && self.value.unwrap_or(0.0) == 0.0 {
            0.0
        } else {
            self.opacity
        }
    }

    fn faded(self, fraction: f32) -> Self {
        Self {
            opacity: self.opacity * fraction,
            ..self
        }
    }

    fn needs(&self) -> Needs {
        if self.depends_on_depth() {
            Needs::MAP
        } else {
            Needs::empty()
        }
    }

    fn without(self, missing: Needs) -> Option<Self> {
        if !missing.intersects(self.needs()) {
            return Some(self);
        }
        Some(Self {
            slope: None,
            depth_weight: 0.0,
            ..self
        })
    }

    fn variants(&self, _: &ViewFacts, variants: &mut Variants) {
        variants.flag("STEEP", self.slope.is_some());
    }

    fn uniform(&self, view: &ViewFacts) -> BlackFlatsUniform {
        // smoothstep needs its ends apart: a hard edge rises over a thousandth.
        let softness = self.softness.max(1e-3);
        let slope = self.slope.unwrap_or(1e30);
        BlackFlatsUniform {
            color: linear_rgb(self.color),
            opacity: self.opacity,
            slope_low: slope * (1.0 - softness),
            slope_high: slope * (1.0 + softness),
            value: self.value.unwrap_or(0.0),
            softness,
            depth_weight: self.depth_weight,
            slope_scale: view.viewport.w.max(1) as f32 / 512.0,
        }
    }

    fn same_modes(&self, other: &Self) -> bool {
        self.slope.is_some() == other.slope.is_some()
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        let values = [self.value, other.value].map(|value| value.unwrap_or(0.0));
        let slopes = self.slope.zip(other.slope);
        Self {
            slope: slopes.map_or(self.slope, |(a, b)| Some(blend_ratio(a, b, t))),
            value: (self.value.is_some() || other.value.is_some())
                .then(|| values[0].lerp(values[1], t)),
            depth_weight: self.depth_weight.lerp(other.depth_weight, t),
            softness: self.softness.lerp(other.softness, t),
            color: blend_color(self.color, other.color, t),
            opacity: self.opacity.lerp(other.opacity, t),
        }
    }
}

/// `BlackFlats` of `black_flats.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct BlackFlatsUniform {
    color: Vec3,
    opacity: f32,
    slope_low: f32,
    slope_high: f32,
    value: f32,
    softness: f32,
    depth_weight: f32,
    slope_scale: f32,
}
