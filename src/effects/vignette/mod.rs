//! Mixes a color into the corners of the picture.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage},
    settings::{FieldRange, color_serde, linear_rgb},
};

/// Mixes a color into the picture towards the corners of the viewport, over lines
/// too: a spotlight, an old film, the edge of a panel.
///
/// Distances are fractions of the distance from the center of the viewport to its
/// corners. The vignette is an ellipse with the viewport's aspect ratio.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Vignette {
    /// How much of the color is mixed in outside the ellipse. Range 0 (the effect is
    /// left out) to 1 (the color alone), default 0.6.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// Distance from the center at which half of the amount is mixed in, as a
    /// fraction of the distance to the corners. Range 0 to 1, default 0.8.
    #[reflect(@FieldRange::FRACTION)]
    pub radius: f32,
    /// Width of the transition, in the unit of `radius`. Range 0 (a hard edge) to 1,
    /// default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Color that is mixed in. Default: black. Components are clamped to what a
    /// display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
}

impl Default for Vignette {
    fn default() -> Self {
        Self {
            amount: 0.6,
            radius: 0.8,
            softness: 0.5,
            color: Color::BLACK,
        }
    }
}

impl Effect for Vignette {
    const NAME: &'static str = "vignette";
    const STAGE: EffectStage = EffectStage::Page;
    const SHADER: EffectShader = shader!("vignette", "Vignette");
    type Uniform = VignetteUniform;

    fades_by!(amount);

    fn uniform(&self, view: &EffectContext) -> VignetteUniform {
        let size = Vec2::new(view.viewport.z as f32, view.viewport.w as f32).max(Vec2::ONE);
        // smoothstep needs two different ends: a hard edge has a width of 0.001.
        let half = 0.5 * self.softness.max(1e-3);
        VignetteUniform {
            color: linear_rgb(self.color),
            amount: self.amount,
            scale: 2.0 / size,
            low: self.radius - half,
            high: self.radius + half,
        }
    }
}

/// The uniform: `Vignette` in `vignette.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct VignetteUniform {
    color: Vec3,
    amount: f32,
    scale: Vec2,
    low: f32,
    high: f32,
}
