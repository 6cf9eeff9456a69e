//! Colours fade with distance (\[CS\] Eq. 5 to 7).

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Needs, Variants, ViewFacts},
    settings::{FieldRange, Form, bounded},
};

/// Takes saturation away with distance: the nearest geometry keeps its colours,
/// the farthest and the sky turn grey (\[CS\] Eq. 6 and 7).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Desaturation {
    /// How much of the saturation goes at the far end. Range 0 (none, and the
    /// pass leaves the style out) to 1 (all). Default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// The exponent on `1 - D`: 1 is Eq. 6, 0.5 is Eq. 7, which keeps colours
    /// longer and drops them late. Range 0.25 to 4, default 1.
    #[reflect(@FieldRange::logarithmic(0.25, 4.0))]
    pub exponent: f32,
    /// What stays while the colour goes. [`Form::Corrected`] keeps the
    /// luminance of the light; [`Form::Faithful`] keeps HSV value
    /// (Eq. 5), which makes full blue fourteen times as bright.
    pub form: Form,
}

impl Default for Desaturation {
    fn default() -> Self {
        Self {
            amount: 1.0,
            exponent: 1.0,
            form: Form::Corrected,
        }
    }
}

impl Desaturation {
    /// \[CS\] Eq. 6 as printed.
    pub const LINEAR: Self = Self {
        amount: 1.0,
        exponent: 1.0,
        form: Form::Faithful,
    };
    /// \[CS\] Eq. 7 as printed.
    pub const QUADRATIC: Self = Self {
        amount: 1.0,
        exponent: 0.5,
        form: Form::Faithful,
    };
}

impl Effect for Desaturation {
    const NAME: &'static str = "desaturation";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::desaturation",
        source: include_str!("desaturation.wgsl"),
        settings: Some("Desaturation"),
    };
    type Uniform = DesaturationUniform;

    fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            amount: bounded(self.amount, default.amount, 0.0, 1.0),
            exponent: bounded(self.exponent, default.exponent, 0.25, 4.0),
            ..self
        }
    }

    fn strength(&self) -> f32 {
        self.amount
    }

    fn faded(self, fraction: f32) -> Self {
        Self {
            amount: self.amount * fraction,
            ..self
        }
    }

    fn needs(&self) -> Needs {
        Needs::MAP
    }

    fn variants(&self, _: &ViewFacts, variants: &mut Variants) {
        variants.number("CURVE", self.curve());
        variants.number("FAITHFUL", u32::from(self.is_faithful()));
    }

    fn uniform(&self, _: &ViewFacts) -> DesaturationUniform {
        DesaturationUniform {
            amount: self.amount,
            exponent: self.exponent,
            curve: self.curve(),
            faithful: u32::from(self.is_faithful()),
        }
    }
}

impl Desaturation {
    /// How the exponent is applied: as it is, as a root, as a power.
    fn curve(&self) -> u32 {
        match self.exponent {
            1.0 => 0,
            0.5 => 1,
            _ => 2,
        }
    }

    fn is_faithful(&self) -> bool {
        self.form == Form::Faithful
    }
}

/// `Desaturation` of `desaturation.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct DesaturationUniform {
    amount: f32,
    exponent: f32,
    curve: u32,
    faithful: u32,
}
