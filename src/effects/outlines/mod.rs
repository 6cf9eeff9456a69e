//! Draws the outlines of the geometry: silhouettes from depth, creases from normals,
//! edges between objects from their ids (\[CL\] 2.1, after Decaudin).

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    math::FloatExt,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Extent, Needs, NoUniform, ViewFacts},
    lines::{
        Creases, LineBoil, LineColor, LineFog, LineResponse, LineSettings, LineWeight, ObjectEdges,
        Silhouettes,
    },
    settings::{Blend, FieldRange, bounded},
};

/// Draws outlines: silhouettes, where one surface hides another; creases, where a
/// surface bends sharply; and edges between objects (\[CL\] 2.1).
///
/// The three kinds are found separately, and where they overlap the strongest is
/// drawn. By default the same settings fit a tabletop and a landscape, whatever the
/// near and far planes. `Form::Faithful`, which silhouettes and creases have each,
/// computes the paper's equations instead.
///
/// Geometry that is not in the depth prepass has no outlines: over a transparent
/// surface, the lines of the geometry behind it are drawn, unless it has the component
/// `DepthWrite`. The components `OutlineStyle` and `NoOutlines` change the lines of single
/// objects.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Draws lines where a surface ends in front of another one or of the sky;
    /// `None` draws none. Default: [`Silhouettes::default`].
    pub silhouettes: Option<Silhouettes>,
    /// Draws lines along creases; `None` draws none and saves the normal prepass.
    /// Default: [`Creases::default`].
    pub creases: Option<Creases>,
    /// Draws lines where two objects meet, whatever their depths and normals; `None`
    /// draws none. Without the crate's feature `objects`, none are drawn either.
    /// Default: [`ObjectEdges::default`].
    pub objects: Option<ObjectEdges>,
    /// Width of the lines in logical pixels. Range 0.5 to 16, default 2. Lines in the
    /// faithful form are four physical pixels wide instead.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Fraction of the width that is lost at the far end of the depth map. Range 0 to
    /// 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub width_fade: f32,
    /// Fraction of the opacity that is lost at the far end of the depth map. Range 0
    /// to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity_fade: f32,
    /// How far lines continue along weak edges, in logical pixels: an edge that responds
    /// below `edge_limit`, but not below `continuity_level`, has a line if it continues
    /// one (hysteresis, Canny 1986). At most 64 physical pixels. Range 0 (not at all) to
    /// 32, default 8.
    #[reflect(@FieldRange::linear(0.0, 32.0).unit("px"))]
    pub continuity: f32,
    /// Response from which an edge continues a line, as a fraction of the kind's
    /// `edge_limit`. Range 0.1 to 1 (only what responds above the limit), default 0.5.
    #[reflect(@FieldRange::linear(0.1, 1.0))]
    pub continuity_level: f32,
    /// Leaves out pieces of line of fewer borders of pixels than this, at scale factor 1:
    /// noise. Closed lines and pieces that meet others stay, however short they are. Range 1
    /// (leaves out nothing) to 8, default 7.
    #[reflect(@FieldRange::linear(1.0, 8.0))]
    pub specks: u32,
    /// Closes gaps in lines, where nothing responds between two parts of a row or column of
    /// borders of pixels: up to this many physical pixels, as along wires that are thinner than a
    /// pixel. Real gaps are closed too. Needs compute shaders. Range 0 (closes none) to 3,
    /// default 0. Morphological closing along the line.
    #[reflect(@FieldRange::linear(0.0, 3.0).unit("px"))]
    pub bridge: u32,
    /// For how many frames a line stays where its edge has become weak: one that responds below
    /// `edge_limit`, but not below `continuity_level`, has a line if there was one at most a pixel
    /// away in the last frame (hysteresis in time). So lines flicker less in motion. What moves
    /// by more than a pixel per frame is followed where the engine draws motion vectors, in views
    /// with one sample. Lines are forgotten at a `CameraCut`. Needs `continuity` and compute
    /// shaders. Range 0 (off) to 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0))]
    pub persistence: u32,
    /// What a line loses where an edge is weak. Default: [`LineResponse::Width`].
    pub response: LineResponse,
    /// Whether lines run straight through the steps of pixels; otherwise they follow the
    /// borders of pixels. Needs compute shaders. Default: `true`.
    pub smooth: bool,
    /// By how much lines go on beyond their loose ends, in their direction there, as strokes of a
    /// draughtsman do; in logical pixels. A stroke is at most as long as its line. Closed lines
    /// and lines that meet others have no loose ends. With `weight.taper`, lines become thinner
    /// towards the end of the stroke. Needs `smooth` lines. At most 64 physical pixels. Range 0
    /// (off) to 16, default 0.
    #[reflect(@FieldRange::linear(0.0, 16.0).unit("px"))]
    pub overshoot: f32,
    /// How wide lines are in different places. Default: [`LineWeight::EVEN`].
    pub weight: LineWeight,
    /// Fraction of an area that lines may cover where they crowd, as on foliage or in the
    /// distance: there they are thinner, and below 0.6 physical pixels fainter. Areas have
    /// 24x32 physical pixels, and their middle counts most; a line that is alone in its area
    /// keeps its width. Lines of the faithful forms have no budget. Needs compute shaders.
    /// Range 0.05 to 1 (no limit), default 0.35.
    #[reflect(@FieldRange::linear(0.05, 1.0))]
    pub budget: f32,
    /// How lines move: as if each drawing of a film had been inked anew. Default:
    /// [`LineBoil::STILL`].
    pub boil: LineBoil,
    /// Where the colour of lines comes from. Default: [`LineColor::Ink`].
    pub color: LineColor,
    /// Under temporal anti-aliasing, lines remember the frames before, so that they do not
    /// tremble: the fraction of each frame. They forget where lines move fast, where
    /// something else comes into view, and at a `CameraCut`. Lines that boil have no memory,
    /// nor have views without the engine's motion vectors. Range 1/32 to 1 (no memory), default 1/8.
    #[reflect(@FieldRange::linear(0.03125, 1.0))]
    pub memory: f32,
    /// What happens to lines in the engine's `DistanceFog`, if the camera has it. Default:
    /// [`LineFog::Fade`].
    pub fog: LineFog,
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
            continuity: 8.0,
            continuity_level: 0.5,
            specks: 7,
            bridge: 0,
            persistence: 0,
            overshoot: 0.0,
            response: LineResponse::Width,
            smooth: true,
            weight: LineWeight::EVEN,
            budget: 0.35,
            boil: LineBoil::STILL,
            color: LineColor::Ink,
            memory: 0.125,
            fog: LineFog::Fade,
        }
    }
}

impl Outlines {
    /// Silhouettes only, the one kind that \[CL\] 3.2 implements, in the corrected
    /// form.
    pub const SILHOUETTES: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        creases: None,
        objects: None,
        width: 2.0,
        width_fade: 0.0,
        opacity_fade: 0.0,
        continuity: 8.0,
        continuity_level: 0.5,
        specks: 7,
        bridge: 0,
        persistence: 0,
        overshoot: 0.0,
        response: LineResponse::Width,
        smooth: true,
        weight: LineWeight::EVEN,
        budget: 0.35,
        boil: LineBoil::STILL,
        color: LineColor::Ink,
        memory: 0.125,
        fog: LineFog::Fade,
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
            continuity: bounded(self.continuity, default.continuity, 0.0, 32.0),
            continuity_level: bounded(self.continuity_level, default.continuity_level, 0.1, 1.0),
            specks: self.specks.clamp(1, 8),
            bridge: self.bridge.min(3),
            persistence: self.persistence.min(8),
            overshoot: bounded(self.overshoot, default.overshoot, 0.0, 16.0),
            response: self.response,
            smooth: self.smooth,
            weight: self.weight.sanitized(),
            budget: bounded(self.budget, default.budget, 0.05, 1.0),
            boil: self.boil.sanitized(),
            color: self.color.sanitized(),
            memory: bounded(self.memory, default.memory, 0.03125, 1.0),
            fog: self.fog,
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
        if !missing.contains(Needs::NORMALS) {
            return Some(self);
        }
        let weight = LineWeight {
            shade: 0.0,
            lit: 0.0,
            ..self.weight
        };
        Some(Self {
            creases: None,
            weight,
            ..self
        })
    }

    fn lines(&self) -> Option<LineSettings> {
        Some(self.settings())
    }

    fn extent(&self, _: &ViewFacts) -> Extent {
        Extent::AtLines
    }

    fn line_reach(&self, _: &ViewFacts) -> Option<f32> {
        Some(0.0)
    }

    fn uniform(&self, _: &ViewFacts) -> NoUniform {
        NoUniform::default()
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        let later = if t < 0.5 { self } else { other };
        Self {
            silhouettes: Silhouettes::blend(self.silhouettes, other.silhouettes, t),
            creases: Creases::blend(self.creases, other.creases, t),
            objects: ObjectEdges::blend(self.objects, other.objects, t),
            width: self.width.lerp(other.width, t),
            width_fade: self.width_fade.lerp(other.width_fade, t),
            opacity_fade: self.opacity_fade.lerp(other.opacity_fade, t),
            continuity: self.continuity.lerp(other.continuity, t),
            continuity_level: self.continuity_level.lerp(other.continuity_level, t),
            specks: later.specks,
            bridge: later.bridge,
            persistence: later.persistence,
            overshoot: self.overshoot.lerp(other.overshoot, t),
            response: later.response,
            smooth: later.smooth,
            weight: self.weight.mixed(other.weight, t),
            budget: self.budget.lerp(other.budget, t),
            boil: self.boil.mixed(other.boil, t),
            color: self.color.mixed(other.color, t),
            memory: self.memory.lerp(other.memory, t),
            fog: later.fog,
        }
    }

    /// Always true: [`Effect::mixed`] fades each kind separately when its mode
    /// changes.
    fn same_modes(&self, _: &Self) -> bool {
        true
    }

    fn map_faded(self, fraction: f32) -> Self {
        Self {
            width_fade: self.width_fade * fraction,
            opacity_fade: self.opacity_fade * fraction,
            weight: LineWeight {
                perspective: self.weight.perspective * fraction,
                ..self.weight
            },
            ..self
        }
    }

    fn report_name(&self) -> Option<String> {
        let kinds = (&self.silhouettes, &self.creases, &self.objects);
        Some(String::from(match kinds {
            (Some(_), Some(_), Some(_)) => "all outlines",
            (Some(_), Some(_), None) => "silhouettes + creases",
            (Some(_), None, None) => "silhouettes",
            _ => "other kinds of outline",
        }))
    }
}

impl Outlines {
    /// The kinds of line that can be seen, and how they are drawn.
    fn settings(&self) -> LineSettings {
        LineSettings {
            silhouettes: self.silhouettes,
            creases: self.creases,
            objects: self.objects,
            width: self.width,
            width_fade: self.width_fade,
            opacity_fade: self.opacity_fade,
            continuity: self.continuity,
            continuity_level: self.continuity_level,
            specks: self.specks,
            bridge: self.bridge,
            persistence: self.persistence,
            overshoot: self.overshoot,
            response: self.response,
            smooth: self.smooth,
            weight: self.weight,
            budget: self.budget,
            boil: self.boil,
            color: self.color,
            memory: self.memory,
            fog: self.fog,
        }
        .visible()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers of any size are clamped to their documented ranges.
    #[test]
    fn counts_are_clamped() {
        for n in [0, 1, 2, 3, 4, 8, 9, u32::MAX] {
            let outlines = Outlines {
                specks: n,
                bridge: n,
                persistence: n,
                ..Outlines::default()
            };
            let found = outlines.sanitized();
            assert_eq!(found.specks, n.clamp(1, 8));
            assert_eq!(found.bridge, n.min(3));
            assert_eq!(found.persistence, n.min(8));
        }
    }
}
