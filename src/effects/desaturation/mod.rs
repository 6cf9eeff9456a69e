//! Removes saturation with distance (\[CS\] Eq. 5 to 7).

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{Equations, FieldRange},
};

/// Removes saturation with distance: the nearest geometry keeps its colors, the
/// farthest geometry and the sky turn gray (\[CS\] Eq. 5 to 7).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Desaturation {
    /// Fraction of the saturation that is lost at the far end of the depth map.
    /// Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// Fraction of the saturation that is lost at the near end. With the same `amount`, all distances
    /// lose the same. Range 0 to 1, default 0. At 0 for both, the effect is left out.
    #[reflect(@FieldRange::FRACTION)]
    pub amount_near: f32,
    /// Shapes the loss of saturation with distance: `(1 - D)` to the power of this
    /// exponent remains. Below 1, colors last longer and are lost late. Range 0.25
    /// to 4, default 1. Source: \[CS\] Eq. 6 (1) and Eq. 7 (0.5).
    #[reflect(@FieldRange::logarithmic(0.25, 4.0))]
    pub exponent: f32,
    /// Selects what stays constant while saturation is lost. [`Equations::Corrected`]
    /// keeps the luminance. [`Equations::Faithful`] keeps the HSV value, which makes full
    /// blue fourteen times as bright. Default: [`Equations::Corrected`]. Source of the
    /// faithful equations: \[CS\] Eq. 5.
    pub equations: Equations,
}

impl Default for Desaturation {
    fn default() -> Self {
        Self {
            amount: 1.0,
            amount_near: 0.0,
            exponent: 1.0,
            equations: Equations::Corrected,
        }
    }
}

impl Desaturation {
    /// Saturation falls linearly with the depth map; HSV value is kept (\[CS\] Eq. 6
    /// as printed).
    pub const LINEAR: Self = Self {
        amount: 1.0,
        amount_near: 0.0,
        exponent: 1.0,
        equations: Equations::Faithful,
    };
    /// Saturation falls with the square root of `1 - D`; HSV value is kept (\[CS\]
    /// Eq. 7 as printed).
    pub const SQUARE_ROOT: Self = Self {
        exponent: 0.5,
        ..Self::LINEAR
    };
}

impl Effect for Desaturation {
    const NAME: &'static str = "desaturation";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("desaturation", "Desaturation");
    type Uniform = DesaturationUniform;

    fn strength(&self) -> f32 {
        self.amount.max(self.amount_near)
    }

    fn faded(self, fraction: f32) -> Self {
        Self {
            amount: self.amount * fraction,
            amount_near: self.amount_near * fraction,
            ..self
        }
    }

    fn needs(&self) -> Needs {
        Needs::MAP
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.number("CURVE", self.curve());
        variants.flag("FAITHFUL", self.equations.is_faithful());
    }

    fn uniform(&self, _: &EffectContext) -> DesaturationUniform {
        DesaturationUniform {
            amount: self.amount,
            amount_near: self.amount_near,
            exponent: self.exponent,
            curve: self.curve(),
        }
    }
}

impl Desaturation {
    /// The number of the exponent's formula in `desaturation.wgsl`.
    fn curve(&self) -> u32 {
        match self.exponent {
            1.0 => 0,
            0.5 => 1,
            _ => 2,
        }
    }
}

/// The uniform: `Desaturation` in `desaturation.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct DesaturationUniform {
    amount: f32,
    amount_near: f32,
    exponent: f32,
    curve: u32,
}
