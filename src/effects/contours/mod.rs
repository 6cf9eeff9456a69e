//! Draws lines where the depth map jumps (\[CS\] 3.2).

use std::f32::consts::FRAC_1_SQRT_2;

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{AffectedArea, Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    lines::MapJumps,
    settings::{Equations, FieldRange, color_serde, linear_rgb},
};

/// Draws lines where the depth map jumps: around objects, and between near and far
/// ones (\[CS\] 3.2).
///
/// Contours are found in the depth prepass, which contains opaque and alpha-masked
/// geometry. The lines on a transparent surface are those of the geometry behind it, unless it
/// has the component `DepthWrite`.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Contours {
    /// Selects the edge detector. Default: [`ContourOperator::Prewitt`].
    pub operator: ContourOperator,
    /// Selects what is detected. [`Equations::Corrected`] finds departures from the plane
    /// through the pixel, so a plane has no lines even at a grazing angle.
    /// [`Equations::Faithful`] finds every change of the depth map, slopes included.
    /// Default: [`Equations::Corrected`]. Source of the faithful equations: \[CS\] 3.2.
    pub equations: Equations,
    /// Sets how large a depth jump must be to draw a line: at this jump, in units of
    /// the depth map, a line has half its opacity (0.02 is 2 % of the map's range).
    /// Range 1e-6 to 100, default 0.02.
    /// [`Equations::Faithful`] compares this threshold with the raw response of the
    /// operator, which for a straight jump is 3 times (Prewitt, Laplace), 4 times
    /// (Sobel) or 1.4 times (Roberts) the jump.
    #[reflect(@FieldRange::logarithmic(1e-6, 100.0))]
    pub threshold: f32,
    /// Width of a line in logical pixels, half of it on either side of the jump.
    /// Range 0.5 to 16, default 2.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Softness of the threshold: half the width of the transition, as a fraction of
    /// the threshold. At 0 a line is drawn fully or not at all; at 1 its opacity
    /// rises from no jump to twice the threshold. Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Color of the line. Default: black. Components are clamped to what a display
    /// shows; alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the line. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
    /// Fraction of the opacity that is lost at the far end of the depth map. Range 0
    /// to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity_fade: f32,
}

/// The edge detectors of the depth map.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ContourOperator {
    /// Even lines: first differences over three rows and three columns (\[CS\] 3.2).
    #[default]
    Prewitt,
    /// Slightly crisper lines: as Prewitt, with the middle row and column weighted
    /// double.
    Sobel,
    /// Emphasizes corners and thin things: second differences of all eight
    /// neighbors (\[CS\] 3.2).
    Laplace,
    /// Lighter, more broken lines: differences along the two diagonals only.
    Roberts,
}

impl Default for Contours {
    fn default() -> Self {
        Self {
            operator: ContourOperator::default(),
            equations: Equations::default(),
            threshold: 0.02,
            width: 2.0,
            softness: 0.5,
            color: Color::BLACK,
            opacity: 1.0,
            opacity_fade: 0.0,
        }
    }
}

impl Effect for Contours {
    const NAME: &'static str = "contours";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("contours", "Contours");
    type Uniform = ContoursUniform;

    fades_by!(opacity);

    fn needs(&self) -> Needs {
        Needs::MAP
    }

    fn variants(&self, view: &EffectContext, variants: &mut Variants) {
        let radius = self.radius(view);
        variants.number("OPERATOR", self.operator as u32);
        variants.flag("FAITHFUL", self.equations.is_faithful());
        variants.flag("WHOLE", radius.fract() == 0.0);
        variants.flag("SINGLE_RING", radius == 1.0 || radius == 2.0);
        variants.flag("STEADY", self.opacity_fade == 0.0);
    }

    /// The response is at most the square root of 2 times the largest departure: each
    /// component of a gradient is a mean of departures.
    fn affected_area(&self, view: &EffectContext) -> AffectedArea {
        if self.equations.is_faithful() {
            return AffectedArea::Everywhere;
        }
        AffectedArea::AtJumps(MapJumps {
            least: self.least_visible() * FRAC_1_SQRT_2,
            radius: self.radius(view),
        })
    }

    fn uniform(&self, view: &EffectContext) -> ContoursUniform {
        let half_ramp = self.half_ramp();
        ContoursUniform {
            color: linear_rgb(self.color),
            opacity: self.opacity,
            low: self.threshold - half_ramp,
            high: self.threshold + half_ramp,
            radius: self.radius(view),
            opacity_fade: self.opacity_fade,
            operator_kind: self.operator as u32,
        }
    }
}

impl Contours {
    /// The response below which no line is visible: less than half a code of eight bits of
    /// the ramp from its low to its high end.
    fn least_visible(&self) -> f32 {
        const INVISIBLE: f32 = 0.0257;
        self.threshold - (1.0 - 2.0 * INVISIBLE) * self.half_ramp()
    }

    /// Half the line's width in physical pixels.
    fn radius(&self, view: &EffectContext) -> f32 {
        (0.5 * self.width * view.scale_factor).clamp(0.125, 64.0)
    }

    /// Half of the responses over which a line becomes complete. `smoothstep` needs two
    /// different ends: a hard line rises within 0.1 % of the threshold on either side.
    fn half_ramp(&self) -> f32 {
        self.threshold * self.softness.max(1e-3)
    }
}

/// The uniform: `Contours` in `contours.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ContoursUniform {
    color: Vec3,
    opacity: f32,
    low: f32,
    high: f32,
    radius: f32,
    opacity_fade: f32,
    operator_kind: u32,
}
