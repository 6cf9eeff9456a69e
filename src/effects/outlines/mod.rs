//! Outlines of the geometry ([CL] 2.1, after Decaudin): silhouettes from depth,
//! creases from normals, edges between objects from their ids.

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    math::FloatExt,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Needs, NoUniform, ViewFacts},
    lines::{Creases, LineSettings, ObjectEdges, Silhouettes},
    settings::{Blend, FieldRange, bounded},
};

/// Draws the outlines of things: where one surface hides another, where a
/// surface folds, where two objects touch.
///
/// The three kinds are found separately and the strongest is drawn
/// (\[CL\] Eq. 5). They are measured so that the same settings fit a tabletop
/// and a landscape, whatever the near and far planes; the papers' own form is
/// [`Form::Faithful`](crate::Form::Faithful), kind by kind.
///
/// What has no depth in the prepass has no outline: transparent surfaces are
/// drawn over by the lines of what lies behind them. [`OutlineStyle`] and
/// [`NoOutlines`] change the lines of single objects.
///
/// [`OutlineStyle`]: crate::OutlineStyle
/// [`NoOutlines`]: crate::NoOutlines
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Lines where a surface ends in front of another or of the sky.
    /// `None` draws none. Default: [`Silhouettes::default`].
    pub silhouettes: Option<Silhouettes>,
    /// Lines where a surface folds. `None` draws none and spares the normal
    /// prepass. Default: [`Creases::default`].
    pub creases: Option<Creases>,
    /// Lines where two objects meet, whatever their depth and normals. `None`
    /// draws none. Needs the crate's feature `objects`, without which the lines
    /// are missing. Default: [`ObjectEdges::default`].
    pub objects: Option<ObjectEdges>,
    /// Width of the lines in logical pixels. Range 0.5 to 16, default 2.
    /// [`Form::Faithful`](crate::Form::Faithful) lines have the paper's four columns instead.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Share of the width that is lost at the far end of the depth map.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub width_fade: f32,
    /// Share of the opacity that is lost at the far end of the depth map.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity_fade: f32,
}

impl Default for Outlines {
    fn default() -> Self {
        Self {
            silhouettes: Some(Silhouettes::default()),
            creases: Some(Creases::default()),
            objects: Some(ObjectEdges::default()),
            width: 2.0,
            width_fade: 0.0,
            opacity_fade: 0.0,
        }
    }
}

impl Outlines {
    /// Silhouettes alone, as \[CL\] draws them.
    pub const SILHOUETTES: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        creases: None,
        objects: None,
        width: 2.0,
        width_fade: 0.0,
        opacity_fade: 0.0,
    };
}

impl Effect for Outlines {
    const NAME: &'static str = "outlines";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::outlines",
        source: include_str!("outlines.wgsl"),
        settings: None,
    };
    type Uniform = NoUniform;

    fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            silhouettes: self.silhouettes.map(Silhouettes::sanitized),
            creases: self.creases.map(Creases::sanitized),
            objects: self.objects.map(ObjectEdges::sanitized),
            width: bounded(self.width, default.width, 0.5, 16.0),
            width_fade: bounded(self.width_fade, default.width_fade, 0.0, 1.0),
            opacity_fade: bounded(self.opacity_fade, default.opacity_fade, 0.0, 1.0),
        }
    }

    fn strength(&self) -> f32 {
        let lines = self.settings();
        let opacities = [
            lines.silhouettes.map(|s| s.opacity),
            lines.creases.map(|c| c.opacity),
            lines.objects.map(|o| o.opacity),
        ];
        opacities.into_iter().flatten().fold(0.0, f32::max)
    }

    fn faded(self, fraction: f32) -> Self {
        let silhouettes = self.silhouettes.map(|s| s.faded(fraction));
        let creases = self.creases.map(|c| c.faded(fraction));
        let objects = self.objects.map(|o| o.faded(fraction));
        Self {
            silhouettes,
            creases,
            objects,
            ..self
        }
    }

    fn needs(&self) -> Needs {
        Needs::LINES
    }

    fn without(self, missing: Needs) -> Option<Self> {
        if missing.contains(Needs::DEPTH) {
            return None;
        }
        let creases = self.creases.filter(|_| !missing.contains(Needs::NORMALS));
        Some(Self { creases, ..self })
    }

    fn lines(&self) -> Option<LineSettings> {
        Some(self.settings())
    }

    fn uniform(&self, _: &ViewFacts) -> NoUniform {
        NoUniform::default()
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        Self {
            silhouettes: Silhouettes::blend(self.silhouettes, other.silhouettes, t),
            creases: Creases::blend(self.creases, other.creases, t),
            objects: ObjectEdges::blend(self.objects, other.objects, t),
            width: self.width.lerp(other.width, t),
            width_fade: self.width_fade.lerp(other.width_fade, t),
            opacity_fade: self.opacity_fade.lerp(other.opacity_fade, t),
        }
    }

    /// The kinds have modes of their own, which [`Effect::mixed`] knows.
    fn same_modes(&self, _: &Self) -> bool {
        true
    }

    fn map_faded(self, fraction: f32) -> Self {
        Self {
            width_fade: self.width_fade * fraction,
            opacity_fade: self.opacity_fade * fraction,
            ..self
        }
    }

    fn report_name(&self) -> Option<String> {
        let kinds = (&self.silhouettes, &self.creases, &self.objects);
        Some(String::from(match kinds {
            (Some(_), Some(_), Some(_)) => "all outlines",
            (Some(_), Some(_), None) => "silhouettes + creases",
            (Some(_), None, None) => "silhouettes",
            _ => "another choice of kinds",
        }))
    }
}

impl Outlines {
    fn settings(&self) -> LineSettings {
        LineSettings {
            silhouettes: self.silhouettes,
            creases: self.creases,
            objects: self.objects,
            width: self.width,
            width_fade: self.width_fade,
            opacity_fade: self.opacity_fade,
        }
        .visible()
    }
}
