//! Divides the picture into areas of uniform tone (\[CL\] 3.1, Eq. 6).

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, EffectView, Needs, Variants},
    settings::{Equations, FieldRange},
};

/// Reduces the tones of the picture to a few flat bands, however the scene is lit
/// (\[CL\] 3.1).
///
/// Bevy's cameras dither by default. On an area whose tone lies exactly between two
/// bands, the dither shows as faint dots; `DebandDither::Disabled` on the camera
/// removes them. A style of a [`Comic`](crate::Comic) does that by itself.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ToneBands {
    /// Selects how tones are banded. [`Equations::Corrected`] moves the lightness (the
    /// square root of the luminance) to the middle of its band and keeps hue and
    /// saturation. [`Equations::Faithful`] compresses each channel of the display color
    /// separately in three ranges; white becomes 0.83. Default: [`Equations::Corrected`].
    /// Source of the faithful equations: \[CL\] Eq. 6, without its gaps at 0.33 and 0.66.
    pub equations: Equations,
    /// Number of bands. Range 2 to 8, default 4. [`Equations::Faithful`] always has three.
    #[reflect(@FieldRange::linear(2.0, 8.0))]
    pub levels: u32,
    /// Width of the step between two bands, in logical pixels: 1 is anti-aliased,
    /// more is softer. Range 0 to 16, default 1. A step spans at least two display
    /// codes, so that the dither of a flat area does not speckle, and at most one
    /// band. [`Equations::Faithful`] has hard steps.
    #[reflect(@FieldRange::linear(0.0, 16.0).unit("px"))]
    pub softness: f32,
    /// Fraction of the banded picture in the mix with the original. Range 0 (the
    /// effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

impl Default for ToneBands {
    fn default() -> Self {
        Self {
            equations: Equations::default(),
            levels: 4,
            softness: 1.0,
            amount: 1.0,
        }
    }
}

impl Effect for ToneBands {
    const NAME: &'static str = "tone_bands";
    const STAGE: EffectStage = EffectStage::Tone;
    const SHADER: EffectShader = shader!("tone_bands", "ToneBands");
    const VIEW: Option<EffectView> = Some(EffectView {
        label: "Tone bands",
        explanation: "The lightness of the picture after banding.",
    });
    const DIVIDES_TONES: bool = true;
    type Uniform = ToneBandsUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        Needs::LIGHTNESS_CHANGE | Needs::TONES
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("FAITHFUL", self.equations.is_faithful());
    }

    fn uniform(&self, view: &EffectContext) -> ToneBandsUniform {
        ToneBandsUniform {
            levels: self.levels as f32,
            softness: self.softness * view.scale_factor,
            amount: self.amount,
        }
    }
}

/// The uniform: `ToneBands` in `tone_bands.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ToneBandsUniform {
    levels: f32,
    softness: f32,
    amount: f32,
}
