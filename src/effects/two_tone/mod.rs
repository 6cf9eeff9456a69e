//! Two tones, divided by lightness.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs},
    settings::{FieldRange, color_serde, linear_rgb},
};

/// Paints the picture, lines included, with two colors: one where it is darker than a
/// threshold, one where it is lighter. [`Impact`](crate::Impact) uses it for a few drawings.
/// Flat areas at the threshold show the engine's dither as dots: add
/// `DebandDither::Disabled` to the camera.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TwoTone {
    /// Lightness that divides the tones: the square root of the luminance (Hunter 1948). Range 0 to
    /// 1, default 0.45, which differs from the middle tone (0.5) of three
    /// [`ToneBands`](crate::ToneBands).
    #[reflect(@FieldRange::FRACTION)]
    pub threshold: f32,
    /// Color where the picture is darker. Default: black. Components are clamped to what a
    /// display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub dark: Color,
    /// Color where the picture is lighter. Default: white. Components are clamped to what a
    /// display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub light: Color,
    /// Whether the two colors are exchanged. Default: `false`.
    pub invert: bool,
    /// Width of the edge between the tones in logical pixels. Range 0 to 16, default 1.5.
    #[reflect(@FieldRange::linear(0.0, 16.0).unit("px"))]
    pub softness: f32,
    /// How much of the two tones is mixed into the picture. Range 0 (the effect is left out)
    /// to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

impl Default for TwoTone {
    fn default() -> Self {
        Self {
            threshold: 0.45,
            dark: Color::BLACK,
            light: Color::WHITE,
            invert: false,
            softness: 1.5,
            amount: 1.0,
        }
    }
}

impl TwoTone {
    /// The color of ink over the tones: one of the two tones is exchanged as they are.
    pub(crate) fn shown(&self, ink: Color) -> Color {
        if self.invert && ink == self.dark {
            self.light
        } else if self.invert && ink == self.light {
            self.dark
        } else {
            ink
        }
    }
}

impl Effect for TwoTone {
    const NAME: &'static str = "two_tone";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("two_tone", "TwoTone");
    const DIVIDES_TONES: bool = true;
    type Uniform = TwoToneUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        Needs::LIGHTNESS_CHANGE | Needs::TONES
    }

    fn uniform(&self, view: &EffectContext) -> TwoToneUniform {
        let (dark, light) = if self.invert {
            (self.light, self.dark)
        } else {
            (self.dark, self.light)
        };
        TwoToneUniform {
            dark: linear_rgb(dark),
            threshold: self.threshold,
            light: linear_rgb(light),
            softness: self.softness * view.scale_factor,
            amount: self.amount,
        }
    }
}

/// The uniform: `TwoTone` in `two_tone.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoToneUniform {
    dark: Vec3,
    threshold: f32,
    light: Vec3,
    softness: f32,
    amount: f32,
}

#[test]
fn the_edge_is_in_logical_pixels() {
    let view = EffectContext {
        scale_factor: 2.0,
        ..EffectContext::default()
    };
    assert_eq!(TwoTone::default().uniform(&view).softness, 3.0);
}
