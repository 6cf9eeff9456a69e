//! Draws the outlines as ink on paper (\[CL\] 3.2, Figure 8).

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use super::Outlines;
use crate::{
    effect::{AnyEffect, Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    lines::{LineFog, LineResponse},
    settings::{BlendField, FieldRange, color_serde, linear_rgb},
};

/// Replaces the picture by a drawing of its outlines: ink on paper (\[CL\] 3.2,
/// Figure 8).
///
/// The lines are those of [`Outlines`]; on a camera without that component,
/// silhouettes and creases are drawn. Every line is drawn with several strokes. Each
/// stroke is displaced by its own noise, which changes a few times a second, so that
/// the lines look hand-drawn.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sketch {
    /// How much of the drawing covers the picture and its outlines. Range 0 (the
    /// effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// Color of the paper. Default: sRGB (0.97, 0.955, 0.915), a warm white.
    /// Components are clamped to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub paper: Color,
    /// Color of the ink. Default: sRGB (0.13, 0.12, 0.14), a soft black. Components
    /// are clamped to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub ink: Color,
    /// How much the picture tints the paper, like a wash of color. Range 0 to 1,
    /// default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub wash: f32,
    /// Strengthens or weakens faint lines: the exponent on the ink. Below 1
    /// strengthens them, above 1 weakens them. Range 0.25 to 4, default 1.
    #[reflect(@FieldRange::logarithmic(0.25, 4.0))]
    pub gamma: f32,
    /// Number of strokes that draw each line. Range 1 to 3, default 2.
    #[reflect(@FieldRange::linear(1.0, 3.0), @BlendField::Switch)]
    pub strokes: u32,
    /// Largest displacement of a stroke from its line, per axis, in logical pixels.
    /// Range 0 to 8, default 1.5.
    #[reflect(@FieldRange::linear(0.0, 8.0).unit("px"))]
    pub jitter: f32,
    /// Length of a stroke's waves, in logical pixels. Range 2 to 256, default 40.
    #[reflect(@FieldRange::logarithmic(2.0, 256.0).unit("px"), @BlendField::Switch)]
    pub wavelength: f32,
    /// How many times per second the strokes are redrawn. Range 0 (they stand
    /// still) to 60, default 8.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"), @BlendField::Switch)]
    pub rate: f32,
    /// Variation of the pen's pressure along a stroke: the ink varies between 1 minus
    /// this and 1. Range 0 to 1, default 0.4.
    #[reflect(@FieldRange::FRACTION)]
    pub pressure: f32,
}

impl Default for Sketch {
    fn default() -> Self {
        Self {
            amount: 1.0,
            paper: Color::srgb(0.97, 0.955, 0.915),
            ink: Color::srgb(0.13, 0.12, 0.14),
            wash: 0.0,
            gamma: 1.0,
            strokes: 2,
            jitter: 1.5,
            wavelength: 40.0,
            rate: 8.0,
            pressure: 0.4,
        }
    }
}

impl Effect for Sketch {
    const NAME: &'static str = "sketch";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("sketch", "Sketch");
    const REPLACES: &'static [&'static str] = &[Outlines::NAME];
    type Uniform = SketchUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        Needs::LINES | Needs::LINES_ANYWHERE
    }

    fn implied(&self) -> Option<Box<dyn AnyEffect>> {
        Some(Box::new(Outlines {
            objects: None,
            width: 1.5,
            response: LineResponse::Ink,
            fog: LineFog::Ignore,
            ..Outlines::default()
        }))
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("FADES", self.amount < 1.0);
    }

    /// One pixel more than strokes are displaced: lines are interpolated between pixels.
    fn line_reach(&self, view: &EffectContext) -> Option<f32> {
        Some(self.jitter * view.scale_factor + 1.0)
    }

    fn uniform(&self, view: &EffectContext) -> SketchUniform {
        SketchUniform {
            paper: linear_rgb(self.paper),
            wash: self.wash,
            ink: linear_rgb(self.ink),
            gamma: self.gamma,
            jitter: self.jitter * view.scale_factor,
            wavelength: self.wavelength * view.scale_factor,
            pressure: self.pressure,
            strokes: self.strokes,
            drawing: view.animation_seed(self.rate),
            amount: self.amount,
            lines_below: if view.lines_implied { 0.0 } else { 1.0 },
        }
    }
}

/// The uniform: `Sketch` in `sketch.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct SketchUniform {
    paper: Vec3,
    wash: f32,
    ink: Vec3,
    gamma: f32,
    jitter: f32,
    wavelength: f32,
    pressure: f32,
    strokes: u32,
    drawing: u32,
    amount: f32,
    lines_below: f32,
}
