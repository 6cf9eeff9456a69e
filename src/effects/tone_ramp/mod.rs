//! Tones by the lightness of the picture, which change with depth.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs},
    settings::{FieldRange, color_serde, oklab},
};

/// Maps the lightness of the picture to three tones, with one set of tones for near and one for far
/// (X-Toon: Barla, Thollot and Markosian 2006). It is the [`Ramp`](crate::toon::Ramp) of cameras
/// whose scenes do not have a [`ToonMaterial`](crate::ToonMaterial).
///
/// Between near and far, edges move and soften, and colors are mixed in `OKLab`. Distant tones
/// with soft edges and pale colors are an aerial perspective; equal distant tones are an
/// abstraction.
///
/// Bevy's cameras dither by default. On a flat area whose lightness is within 4/255 of a place
/// where a tone begins, a hard edge turns a code of dither into up to a fifth of the difference of
/// both tones, which shows as dots: add `DebandDither::Disabled` to the camera, or use soft edges.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ToneRamp {
    /// Tone of what is dark, near. Default: a deep violet. Components of all colors are clamped
    /// to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub dark: Color,
    /// Tone between dark and light, near. Default: a grayish violet.
    #[serde(with = "color_serde")]
    pub middle: Color,
    /// Tone of what is light, near. Default: white.
    #[serde(with = "color_serde")]
    pub light: Color,
    /// Lightness where the middle tone begins, near: the square root of the luminance. Range 0 to
    /// 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub middle_at: f32,
    /// Lightness where the light tone begins, near. Range 0 to 1, default 0.55.
    #[reflect(@FieldRange::FRACTION)]
    pub light_at: f32,
    /// Width of the edges, near, in lightness. 0 is as hard as pixels and dither allow. Range 0 to
    /// 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Tone of what is dark, far away. Default: a pale blue.
    #[serde(with = "color_serde")]
    pub distant_dark: Color,
    /// Tone between dark and light, far away. Default: a paler blue.
    #[serde(with = "color_serde")]
    pub distant_middle: Color,
    /// Tone of what is light, far away. Default: a nearly white blue.
    #[serde(with = "color_serde")]
    pub distant_light: Color,
    /// Lightness where the middle tone begins, far away. Range 0 to 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub distant_middle_at: f32,
    /// Lightness where the light tone begins, far away. Range 0 to 1, default 0.55.
    #[reflect(@FieldRange::FRACTION)]
    pub distant_light_at: f32,
    /// Width of the edges, far away, in lightness. Range 0 to 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub distant_softness: f32,
    /// Place in the depth map that has the near tones alone. The distant tones increase on both
    /// sides of it. Range 0 to 1, default 0, the nearest.
    #[reflect(@FieldRange::FRACTION)]
    pub focus: f32,
    /// Distance from `focus`, in the depth map, from which on only the distant tones are left.
    /// Range 0.01 to 1, default 1.
    #[reflect(@FieldRange::linear(0.01, 1.0))]
    pub reach: f32,
    /// How much of the colors of things is kept: the tones are multiplied by it. Range 0 (the
    /// tones alone) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub keep_color: f32,
    /// How much of the tones is mixed into the picture. Range 0 (the effect is left out) to 1,
    /// default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

impl Default for ToneRamp {
    fn default() -> Self {
        Self {
            dark: Color::srgb(0.33, 0.27, 0.48),
            middle: Color::srgb(0.72, 0.68, 0.84),
            light: Color::WHITE,
            middle_at: 0.3,
            light_at: 0.55,
            softness: 0.0,
            distant_dark: Color::srgb(0.66, 0.74, 0.86),
            distant_middle: Color::srgb(0.79, 0.85, 0.93),
            distant_light: Color::srgb(0.93, 0.95, 0.98),
            distant_middle_at: 0.3,
            distant_light_at: 0.55,
            distant_softness: 0.3,
            focus: 0.0,
            reach: 1.0,
            keep_color: 1.0,
            amount: 1.0,
        }
    }
}

impl Effect for ToneRamp {
    const NAME: &'static str = "tone_ramp";
    const STAGE: EffectStage = EffectStage::Tone;
    const SHADER: EffectShader = shader!("tone_ramp", "ToneRamp");
    const DIVIDES_TONES: bool = true;
    type Uniform = ToneRampUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        let mut needs = Needs::LIGHTNESS_CHANGE | Needs::TONES;
        needs.set(Needs::MAP, self != &self.without_distance());
        needs
    }

    fn without(self, missing: Needs) -> Option<Self> {
        let left = if missing.contains(Needs::MAP) {
            self.without_distance()
        } else {
            self
        };
        (!left.needs().intersects(missing)).then_some(left)
    }

    fn uniform(&self, _: &EffectContext) -> ToneRampUniform {
        ToneRampUniform {
            dark: oklab(self.dark),
            middle_at: self.middle_at,
            middle: oklab(self.middle),
            light_at: self.light_at,
            light: oklab(self.light),
            softness: self.softness,
            distant_dark: oklab(self.distant_dark),
            distant_middle_at: self.distant_middle_at,
            distant_middle: oklab(self.distant_middle),
            distant_light_at: self.distant_light_at,
            distant_light: oklab(self.distant_light),
            distant_softness: self.distant_softness,
            focus: self.focus,
            reach: self.reach,
            keep_color: self.keep_color,
            amount: self.amount,
        }
    }
}

impl ToneRamp {
    /// The same with the near tones at every distance.
    fn without_distance(&self) -> Self {
        Self {
            distant_dark: self.dark,
            distant_middle: self.middle,
            distant_light: self.light,
            distant_middle_at: self.middle_at,
            distant_light_at: self.light_at,
            distant_softness: self.softness,
            ..*self
        }
    }
}

/// The uniform: `ToneRamp` in `tone_ramp.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ToneRampUniform {
    dark: Vec3,
    middle_at: f32,
    middle: Vec3,
    light_at: f32,
    light: Vec3,
    softness: f32,
    distant_dark: Vec3,
    distant_middle_at: f32,
    distant_middle: Vec3,
    distant_light_at: f32,
    distant_light: Vec3,
    distant_softness: f32,
    focus: f32,
    reach: f32,
    keep_color: f32,
    amount: f32,
}
