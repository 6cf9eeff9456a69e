//! Fewer tones, lines and strokes, and paler colors, for what is far away.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use super::Granularity;
use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, EffectView, Needs, Variants},
    lines::{LineModifiers, LineSimplification},
    settings::FieldRange,
};

/// Sets how abstract the picture is at every distance, from 0 (all detail) to 1. Tone bands, lines,
/// hatching and saturation follow this value (after X-Toon, Barla et al. 2006).
///
/// Detail appears gradually as things come nearer: bands split in two, so that existing borders
/// stay where they are; new strokes grow between the old ones; and lines become stronger with their
/// edges.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Abstraction {
    /// Abstraction at the near end of the depth map. Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub at_near: f32,
    /// Abstraction at the far end of the depth map. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub at_far: f32,
    /// Exponent of the depth map on the way from `at_near` to `at_far`: above 1, more of the
    /// foreground is as it is near. Range 0.25 to 4, default 1.
    #[reflect(@FieldRange::logarithmic(0.25, 4.0))]
    pub exponent: f32,
    /// Whether an object as a whole is as abstract as its center, with all of its tones, strokes
    /// and lines, or as its [`ObjectSimplification`](crate::objects::ObjectSimplification) says.
    /// Default: [`Granularity::Object`]. Without compute shaders, lines follow pixels.
    pub granularity: Granularity,
    /// How many times the bands of [`ToneBands`](crate::ToneBands) split between full abstraction,
    /// where there are `levels` of them, and none: 1 doubles their number. Needs the corrected
    /// equations. Range 0 to 3, default 1.
    #[reflect(@FieldRange::linear(0.0, 3.0))]
    pub band_splits: f32,
    /// Factor of [`Hatching::spacing`](crate::Hatching::spacing) at full abstraction. Range 1 to 4,
    /// default 2. Hatching that is drawn after paint, focus or a misregistration does not change.
    #[reflect(@FieldRange::logarithmic(1.0, 4.0))]
    pub spacing: f32,
    /// Factor of the saturation at full abstraction. Range 0 to 1, default 0.7.
    #[reflect(@FieldRange::FRACTION)]
    pub saturation: f32,
    /// How many times as strong an edge must be at full abstraction to have a line. Range 1 to 8,
    /// default 2. Object edges and faithful lines do not change.
    #[reflect(@FieldRange::logarithmic(1.0, 8.0))]
    pub line_threshold: f32,
    /// Factor of the opacity of creases at full abstraction. Needs compute shaders. Range 0 to 1,
    /// default 0.4.
    #[reflect(@FieldRange::FRACTION)]
    pub crease_opacity: f32,
}

impl Default for Abstraction {
    fn default() -> Self {
        Self {
            at_near: 0.0,
            at_far: 1.0,
            exponent: 1.0,
            granularity: Granularity::Object,
            band_splits: 1.0,
            spacing: 2.0,
            saturation: 0.7,
            line_threshold: 2.0,
            crease_opacity: 0.4,
        }
    }
}

impl Effect for Abstraction {
    const NAME: &'static str = "abstraction";
    const STAGE: EffectStage = EffectStage::Tone;
    const SHADER: EffectShader = shader!("abstraction", "Abstraction");
    const VIEW: Option<EffectView> = Some(EffectView {
        label: "Abstraction",
        explanation: "Black: all detail. White: full abstraction.",
    });
    type Uniform = AbstractionUniform;

    /// The largest abstraction; with bands that split, also where there is none.
    fn strength(&self) -> f32 {
        self.at_near.max(self.at_far).max(self.band_splits.min(1.0))
    }

    fn faded(self, fraction: f32) -> Self {
        Self {
            at_near: self.at_near * fraction,
            at_far: self.at_far * fraction,
            band_splits: self.band_splits * fraction,
            ..self
        }
    }

    fn needs(&self) -> Needs {
        let mut needs = Needs::MAP | Needs::DEPTH;
        needs.set(
            Needs::OBJECT_DEPTHS,
            self.granularity == Granularity::Object,
        );
        needs
    }

    fn line_modifiers(&self, _: &EffectContext) -> LineModifiers {
        let changes = self.line_threshold > 1.0 || self.crease_opacity < 1.0;
        LineModifiers {
            simplification: changes.then(|| LineSimplification {
                at_near: self.at_near,
                at_far: self.at_far,
                exponent: self.exponent,
                threshold: self.line_threshold,
                crease_opacity: self.crease_opacity,
                by_objects: self.granularity == Granularity::Object,
            }),
            ..LineModifiers::default()
        }
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("OBJECTS", self.granularity == Granularity::Object);
    }

    fn uniform(&self, _: &EffectContext) -> AbstractionUniform {
        AbstractionUniform {
            at_near: self.at_near,
            at_far: self.at_far,
            exponent: self.exponent,
            splits: self.band_splits,
            spacing: self.spacing.log2(),
            saturation: self.saturation,
        }
    }
}

/// The uniform: `Abstraction` in `abstraction.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct AbstractionUniform {
    at_near: f32,
    at_far: f32,
    exponent: f32,
    splits: f32,
    spacing: f32,
    saturation: f32,
}
