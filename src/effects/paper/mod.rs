//! The sheet that the picture is printed on.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage},
    lines::{LineModifiers, Sheet},
    settings::{FieldRange, color_serde, linear_rgb},
};

/// Prints the picture on paper: its grain shows in the tones between bare paper and solid ink, its
/// relief shades the page, and its color tints it.
///
/// The sheet is fixed to the render target, so that the views of a split screen are printed
/// on one sheet, unless [`anchor`](Self::anchor) gives each its own. Grain, shading and
/// [`ink_bleed`](Self::ink_bleed) keep the mean tone of a flat area within 1 %, in linear light. Light
/// above 1 (HDR) and the background of a transparent camera have no grain. Reads no texture.
///
/// The views of cameras with this effect are styled after FXAA and SMAA, which would smear the
/// grain.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Paper {
    /// How much of the effect is mixed in. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// How unevenly the paper takes ink, which gathers in its valleys: tones between paper and
    /// solid ink vary by up to this fraction of `k (1 - k)`, where k is the darkness. Range 0
    /// to 1, default 0.3.
    #[reflect(@FieldRange::FRACTION)]
    pub grain: f32,
    /// How much the light on the page varies with the height of the sheet: the difference
    /// between its hills and its valleys. Range 0 to 0.3, default 0.08.
    #[reflect(@FieldRange::linear(0.0, 0.3))]
    pub shading: f32,
    /// Size of the grain: the finest grains are 1.5 logical pixels times this. Range 0.5 to
    /// 8, default 1.
    #[reflect(@FieldRange::logarithmic(0.5, 8.0))]
    pub size: f32,
    /// How far ink runs into the valleys of the sheet, in logical pixels: edges of outlines, of
    /// sketches and of the dots of a [`Halftone`](crate::Halftone) vary within a band of this
    /// width. The mean width of a line stays within 0.05 pixels; a line that is thin for the spread
    /// varies by at most three quarters of its width, so that it never vanishes. Lines of the
    /// faithful equations, contours and outlines around highlighted objects stay smooth. Range 0 to 2,
    /// default 0.
    #[reflect(@FieldRange::linear(0.0, 2.0).unit("px"))]
    pub ink_bleed: f32,
    /// How dry the brush is that draws wide outlines: it leaves out streaks along the stroke, 1.6
    /// logical pixels wide and 8 times as long, fixed to the sheet. Lines narrower than 3 logical
    /// pixels have none, and lines from 6 on have all of them. Range 0 (wet: whole lines) to 1
    /// (almost nothing is left), default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub dry_brush: f32,
    /// Color of the sheet; the page is multiplied by it. Default: warm white. Components are
    /// clamped to what a display shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Sheets per second, as if each drawing of a film were on paper of its own. Range 0 (one
    /// sheet for all time) to 60, default 0.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"))]
    pub rate: f32,
    /// Where the sheet is fixed. Default: [`PaperAnchor::Window`].
    pub anchor: PaperAnchor,
}

/// Where the sheet of a [`Paper`] is fixed.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum PaperAnchor {
    /// At the corner of the render target: in a split screen, all views are on one sheet.
    #[default]
    Window,
    /// At the corner of the viewport: each view is on a sheet of its own, which moves with it.
    View,
}

impl Default for Paper {
    fn default() -> Self {
        Self {
            amount: 1.0,
            grain: 0.3,
            shading: 0.08,
            size: 1.0,
            ink_bleed: 0.0,
            dry_brush: 0.0,
            color: Color::srgb_u8(251, 247, 236),
            rate: 0.0,
            anchor: PaperAnchor::Window,
        }
    }
}

impl Effect for Paper {
    const NAME: &'static str = "paper";
    const STAGE: EffectStage = EffectStage::Page;
    const SHADER: EffectShader = shader!("paper", "Paper");
    type Uniform = PaperUniform;

    fades_by!(amount);

    fn line_modifiers(&self, view: &EffectContext) -> LineModifiers {
        let inked = self.ink_bleed > 0.0 || self.dry_brush > 0.0;
        let sheet = || Sheet {
            ink_bleed: self.amount * self.ink_bleed * view.scale_factor,
            dry_brush: self.amount * self.dry_brush,
            corner: self.corner(view),
            scale: self.scale(view),
            unit: view.scale_factor,
            seed: view.animation_seed(self.rate),
        };
        LineModifiers {
            sheet: inked.then(sheet),
            ..LineModifiers::default()
        }
    }

    fn runs_after_anti_aliasing(&self) -> bool {
        true
    }

    fn uniform(&self, view: &EffectContext) -> PaperUniform {
        PaperUniform {
            color: linear_rgb(self.color),
            amount: self.amount,
            grain: self.grain,
            shading: 0.5 * self.shading,
            scale: self.scale(view),
            seed: view.animation_seed(self.rate),
            corner: self.corner(view),
        }
    }
}

impl Paper {
    /// Places on the sheet per physical pixel.
    fn scale(&self, view: &EffectContext) -> f32 {
        1.0 / (self.size * view.scale_factor)
    }

    /// Where the sheet begins in the render target, in physical pixels.
    fn corner(&self, view: &EffectContext) -> Vec2 {
        match self.anchor {
            PaperAnchor::Window => Vec2::ZERO,
            PaperAnchor::View => view.viewport.xy().as_vec2(),
        }
    }
}

/// The uniform: `Paper` in `paper.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct PaperUniform {
    color: Vec3,
    amount: f32,
    grain: f32,
    shading: f32,
    scale: f32,
    seed: u32,
    corner: Vec2,
}
