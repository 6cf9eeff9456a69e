//! Fills steep slopes and dark areas with solid ink (\[CS\] 3.2, Figure 4).

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{BlendField, FieldRange, NotFinite, color_serde, linear_rgb, mix_fields},
};

/// Fills steep slopes of the depth map and dark areas with solid ink (\[CS\] 3.2,
/// Figure 4).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BlackFlats {
    /// Fills places where the depth map is steeper than this: where its Prewitt
    /// response is above this threshold. On an even slope the response is six times
    /// the change of the map over 1/512 of the viewport's height. Range 1e-6 to 100,
    /// default `None` (no slope is filled). Source: the larger threshold of \[CS\]
    /// 3.2.
    #[reflect(@FieldRange::logarithmic(1e-6, 100.0), @NotFinite(0.02), @BlendField::Fields)]
    pub slope: Option<f32>,
    /// Fills areas of the unstyled picture whose HSV value, in display codes, is
    /// below this threshold; `None` fills no dark areas. Range 0 to 1, default 0.25.
    #[reflect(@FieldRange::FRACTION)]
    pub value: Option<f32>,
    /// How much the threshold `value` decreases with distance: at 1 it is
    /// `value * (1 - D)`, so that dark areas are filled in the foreground only.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub depth_weight: f32,
    /// Softness of the edges of an area: half the width of the transition, as a
    /// fraction of the threshold. Range 0 to 1, default 0.1.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Color of the ink. Default: black. Components are clamped to what a display
    /// shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the ink. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

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
    /// Whether the effect reads the depth map: it fills slopes, or its threshold for
    /// dark areas depends on distance.
    pub fn depends_on_depth(&self) -> bool {
        self.slope.is_some() || (self.value.is_some() && self.depth_weight > 0.0)
    }
}

impl Effect for BlackFlats {
    const NAME: &'static str = "black_flats";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("black_flats", "BlackFlats");
    type Uniform = BlackFlatsUniform;

    fn strength(&self) -> f32 {
        if self.slope.is_none() && self.value.unwrap_or(0.0) == 0.0 {
            0.0
        } else {
            self.opacity
        }
    }

    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn needs(&self) -> Needs {
        let mut needs = Needs::empty();
        needs.set(Needs::MAP, self.depends_on_depth());
        needs.set(Needs::TONES, self.value.unwrap_or(0.0) > 0.0);
        needs
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

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("STEEP", self.slope.is_some());
    }

    fn uniform(&self, view: &EffectContext) -> BlackFlatsUniform {
        // smoothstep needs two different ends: a hard edge rises within 0.1 % of the
        // threshold on either side.
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
        Self {
            value: (self.value.is_some() || other.value.is_some())
                .then(|| values[0].lerp(values[1], t)),
            ..mix_fields(self, other, t)
        }
    }
}

/// The uniform: `BlackFlats` in `black_flats.wgsl`.
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
