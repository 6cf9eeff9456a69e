//! Leaves what is nearer or farther than a distance out of focus.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{AffectedArea, Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    lines::{LineFade, LineModifiers},
    settings::FieldRange,
};

/// Puts one distance into focus: what is nearer or farther is blurred, painted, printed out of
/// register or in dots, or loses its lines. Drawn after the effects of color, before prints and
/// lines.
///
/// As in a comic, and unlike with a lens, the boundary between sharp and blurred areas stays sharp:
/// a sharp figure does not bleed into the blurred background, and a blurred foreground does not
/// bleed over a sharp figure. Only areas that are both out of focus blend into each other.
///
/// How far something is out of focus depends on the ratio of its distance to that of the
/// focus, so it does not depend on the unit of the world. In an orthographic view it depends on
/// the difference, as a fraction of the distance from which a perspective view of 45 degrees
/// shows the same height. The sky is out of focus unless it is what is looked at.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Focus {
    /// What is in focus. Default: [`FocusAt::Target`].
    pub at: FocusAt,
    /// How things out of focus look. Default: [`FocusStyle::Blur`].
    pub style: FocusStyle,
    /// Distance of the focus along the view's axis, in world units. Range 0.01 to 100000, default
    /// 10.
    #[reflect(@FieldRange::logarithmic(0.01, 100_000.0))]
    pub distance: f32,
    /// Distances around the focus at which everything is sharp, as the natural logarithm of the ratio
    /// of distances: 0.15 is from 14 % nearer to 16 % farther. Range 0 to 4, default 0.15.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub clear: f32,
    /// How far beyond that range the largest radius is reached, in the unit of `clear`: 1 is a
    /// factor of 2.7 in distance. Range 0.05 (at once) to 8, default 1.
    #[reflect(@FieldRange::linear(0.05, 8.0))]
    pub ramp: f32,
    /// Largest radius in logical pixels. Range 0 (the effect is left out) to 24, default 6. At
    /// most 256 physical pixels. [`FocusStyle::Dots`] and [`FocusStyle::Lines`] have their whole
    /// effect from 6 on.
    #[reflect(@FieldRange::linear(0.0, 24.0).unit("px"))]
    pub radius: f32,
    /// Size of the cells of [`FocusStyle::Dots`] in logical pixels. Range 2.5 to 40, default 6.
    #[reflect(@FieldRange::logarithmic(2.5, 40.0).unit("px"))]
    pub cell_size: f32,
}

/// What is in focus.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum FocusAt {
    /// The camera's [`EffectTarget`](crate::effect::EffectTarget). While it has none, or it is
    /// behind the camera: as [`FocusAt::Distance`].
    #[default]
    Target,
    /// What is at [`Focus::distance`].
    Distance,
    /// What the middle of the view shows: the median of 25 places in a square of 2 % of the view's
    /// height (at least 5 pixels of the main pass), with a time constant of 0.15 s. Between things and
    /// the sky it jumps. Without compute shaders, what the middle pixel shows.
    Center,
}

/// How things out of focus look.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum FocusStyle {
    /// Blurred. Reads 12 pixels around each one, and one more for every physical pixel of the
    /// radius.
    #[default]
    Blur,
    /// Printed with red and blue apart along a diagonal, by up to twice the radius.
    Offset,
    /// Painted as by [`Paint`](crate::Paint), whose brush has the radius. Two more passes. Before a
    /// background that varies as much as its outline, a sharp figure's color may be in the paint
    /// beside it.
    Paint,
    /// Printed in dots of four ideal inks, which keep the mean color; between sharp and out of
    /// focus, plain tones become dots. Reads no other pixels. The view is styled after FXAA and
    /// SMAA. A [`Halftone`](crate::Halftone) of the camera prints over it.
    Dots,
    /// Colors stay sharp; lines become thinner and fainter until they vanish. Lines of the
    /// faithful equations do not. Needs compute shaders.
    Lines,
}

impl Default for Focus {
    fn default() -> Self {
        Self {
            at: FocusAt::Target,
            style: FocusStyle::Blur,
            distance: 10.0,
            clear: 0.15,
            ramp: 1.0,
            radius: 6.0,
            cell_size: 6.0,
        }
    }
}

impl Effect for Focus {
    const NAME: &'static str = "focus";
    const STAGE: EffectStage = EffectStage::Color;
    const SHADER: EffectShader = shader!("focus", "Focus");
    const HALF_BOX: bool = true;
    const AUX_SCALAR: bool = true;
    type Uniform = FocusUniform;

    fn strength(&self) -> f32 {
        if self.radius > 0.0 { 1.0 } else { 0.0 }
    }

    fn faded(self, fraction: f32) -> Self {
        let radius = self.radius * fraction;
        Self { radius, ..self }
    }

    fn needs(&self) -> Needs {
        let middle = match self.at {
            FocusAt::Center => Needs::MIDDLE_DEPTH,
            FocusAt::Target | FocusAt::Distance => Needs::empty(),
        };
        let picture = match self.style {
            FocusStyle::Paint => Needs::BOX_STATISTICS,
            FocusStyle::Blur | FocusStyle::Offset => Needs::AUX_SCALAR,
            FocusStyle::Dots => Needs::empty(),
            FocusStyle::Lines => return middle,
        };
        picture | middle | Needs::DEPTH
    }

    fn variants(&self, view: &EffectContext, variants: &mut Variants) {
        variants.number("STYLE", self.style as u32);
        variants.number("PARALLEL", u32::from(view.depth_reference.is_some()));
    }

    fn affected_area(&self, _: &EffectContext) -> AffectedArea {
        match self.style {
            // The lines are drawn by other effects.
            FocusStyle::Lines => AffectedArea::AtLines,
            _ => AffectedArea::Everywhere,
        }
    }

    fn max_radius(&self, view: &EffectContext) -> Option<u32> {
        // Boxes of up to 7 pixels, for the default radius; not one pipeline for every radius.
        let half = (0.5 * self.physical_radius(view) + 0.5).floor();
        (half <= 3.0).then_some(3)
    }

    fn line_modifiers(&self, view: &EffectContext) -> LineModifiers {
        LineModifiers {
            fade: (self.style == FocusStyle::Lines).then(|| LineFade {
                distance: self.focus_distance(view),
                clear: self.clear,
                ramp: self.ramp,
                amount: self.whole(),
            }),
            ..LineModifiers::default()
        }
    }

    fn runs_after_anti_aliasing(&self) -> bool {
        self.style == FocusStyle::Dots
    }

    fn uniform(&self, view: &EffectContext) -> FocusUniform {
        let cell_size = view.cell_size(self.cell_size);
        let shown = ((cell_size - 1.5) / (2.5 - 1.5)).clamp(0.0, 1.0);
        let middle = view.viewport.xy() + view.viewport.zw() / 2;
        FocusUniform {
            axis: view.depth_axis,
            distance: self.focus_distance(view).unwrap_or(0.0),
            reference: view.depth_reference.unwrap_or(0.0),
            clear: self.clear,
            steepness: 1.0 / self.ramp,
            radius: self.physical_radius(view),
            at_center: u32::from(self.at == FocusAt::Center),
            center: middle.as_vec2() + 0.25,
            cell_size,
            amount: self.whole() * shown * shown * (3.0 - 2.0 * shown),
        }
    }
}

impl Focus {
    /// Distance of the focus; `None` if it is at what the middle of the view shows.
    fn focus_distance(&self, view: &EffectContext) -> Option<f32> {
        match self.at {
            FocusAt::Target => Some(view.target_depth.unwrap_or(self.distance)),
            FocusAt::Distance => Some(self.distance),
            FocusAt::Center => None,
        }
    }

    fn physical_radius(&self, view: &EffectContext) -> f32 {
        (self.radius * view.scale_factor).min(256.0)
    }

    /// How much of the dots is seen, and of the lines lost, where all is out of focus.
    fn whole(&self) -> f32 {
        (self.radius / 6.0).min(1.0)
    }
}

/// The uniform: `Focus` in `focus.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct FocusUniform {
    axis: Vec2,
    distance: f32,
    reference: f32,
    clear: f32,
    steepness: f32,
    radius: f32,
    at_center: u32,
    center: Vec2,
    cell_size: f32,
    amount: f32,
}
