//! Turns the picture into flat strokes of paint with firm edges.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::FieldRange,
};

/// Paints the picture: areas become flat patches of one color, their edges stay sharp, and
/// detail that is finer than the brush is gone. Drawn after the effects of color, before
/// prints and lines, which stay as they are.
///
/// Around each pixel lie eight overlapping areas. The pixel takes the mean of those whose
/// lightness varies least (Kuwahara 1976), so no color crosses an edge. Nothing is painted
/// where the background of a transparent camera shows through.
///
/// The brush is `at_near` wide at the near end of the depth map, and `at_far` wide at its far end.
/// The depth map is read if they differ.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Paint {
    /// How the areas lie. Default: [`PaintKernel::Box`].
    pub kernel: PaintKernel,
    /// Radius of the brush at the near end of the depth map, in logical pixels. Range 0 (not
    /// painted) to 12, default 4.
    #[reflect(@FieldRange::linear(0.0, 12.0).unit("px"))]
    pub at_near: f32,
    /// The same at the far end. Range 0 (not painted) to 12, default 4.
    #[reflect(@FieldRange::linear(0.0, 12.0).unit("px"))]
    pub at_far: f32,
    /// How strongly areas of even lightness are preferred: the exponent of their deviation. Range 1
    /// (soft, as seen through frosted glass) to 16 (patches with hard borders), default 8.
    #[reflect(@FieldRange::linear(1.0, 16.0))]
    pub sharpness: f32,
    /// Whether paint keeps to the outline of objects even where their colors are alike: an area
    /// whose middle lies on another object has an eighth of the weight. Object ids are drawn; needs
    /// the crate's feature `objects`. Default: `false`.
    pub figures: bool,
    /// How much of the paint is seen over the picture. Range 0 (the effect is left out) to 1,
    /// default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

/// How the areas of [`Paint`] lie around a pixel.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum PaintKernel {
    /// Squares: the same effort for every radius. Two more passes average the picture, to two
    /// textures of the viewport's size with 16 bytes a pixel.
    #[default]
    Box,
    /// Sectors of an ellipse that follows the picture: strokes run along edges. 89 reads of
    /// the picture per pixel; for photographs (Kyprianidis, Kang and Döllner 2009).
    Anisotropic,
}

impl Default for Paint {
    fn default() -> Self {
        Self {
            kernel: PaintKernel::Box,
            at_near: 4.0,
            at_far: 4.0,
            sharpness: 8.0,
            figures: false,
            amount: 1.0,
        }
    }
}

impl Effect for Paint {
    const NAME: &'static str = "paint";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("paint", "Paint");
    const HALF_BOX: bool = true;
    type Uniform = PaintUniform;

    fn strength(&self) -> f32 {
        if self.at_near == 0.0 && self.at_far == 0.0 {
            0.0
        } else {
            self.amount
        }
    }

    fn faded(self, fraction: f32) -> Self {
        let amount = self.amount * fraction;
        Self { amount, ..self }
    }

    fn needs(&self) -> Needs {
        let mut needs = match self.kernel {
            PaintKernel::Box => Needs::BOX_STATISTICS,
            PaintKernel::Anisotropic => Needs::PICTURE,
        };
        needs.set(Needs::MAP, self.at_near != self.at_far);
        needs.set(Needs::IDS, self.keeps_figures());
        needs
    }

    fn without(self, missing: Needs) -> Option<Self> {
        // Without the map, the brush is as at its far end, as for the sky.
        let at_near = if missing.contains(Needs::MAP) {
            self.at_far
        } else {
            self.at_near
        };
        let figures = self.figures && !missing.contains(Needs::IDS);
        Some(Self {
            at_near,
            figures,
            ..self
        })
    }

    fn variants(&self, view: &EffectContext, variants: &mut Variants) {
        variants.flag("ANISOTROPIC", self.kernel == PaintKernel::Anisotropic);
        variants.flag("FIGURES", self.keeps_figures());
        variants.number("EIGHTH", u32::from(self.sharpness == 8.0));
        variants.flag("WHOLE", self.is_whole(view));
    }

    fn max_radius(&self, view: &EffectContext) -> Option<u32> {
        let half = 0.5 * physical(self.at_near.max(self.at_far), view);
        if self.is_whole(view) {
            Some(half as u32)
        } else {
            // Not every move of a slider compiles a pipeline.
            (half <= 3.0).then_some(3)
        }
    }

    fn map_faded(self, fraction: f32) -> Self {
        let at_near = self.at_far + (self.at_near - self.at_far) * fraction;
        Self { at_near, ..self }
    }

    fn uniform(&self, view: &EffectContext) -> PaintUniform {
        PaintUniform {
            at_near: physical(self.at_near, view),
            at_far: physical(self.at_far, view),
            half_sharpness: 0.5 * self.sharpness,
            amount: self.amount,
        }
    }
}

/// A radius in physical pixels.
fn physical(radius: f32, view: &EffectContext) -> f32 {
    (radius * view.scale_factor).min(256.0)
}

impl Paint {
    /// Whether all boxes reach the same whole number of pixels from their middle.
    fn is_whole(&self, view: &EffectContext) -> bool {
        self.at_near == self.at_far && (0.5 * physical(self.at_near, view)).fract() == 0.0
    }

    /// Whether object ids are read.
    fn keeps_figures(&self) -> bool {
        self.figures && cfg!(feature = "objects")
    }
}

/// The uniform: `Paint` in `paint.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct PaintUniform {
    at_near: f32,
    at_far: f32,
    half_sharpness: f32,
    amount: f32,
}
