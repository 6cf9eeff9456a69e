//! Draws the outlines of the geometry: silhouettes from depth, creases from normals,
//! edges between objects from their ids (\[CL\] 2.1, after Decaudin).

pub use crate::lines::Outlines;

use crate::{
    effect::{AffectedArea, Effect, EffectContext, EffectShader, EffectStage, Needs, NoUniform},
    lines::{Creases, EdgeStyle, LineWeight, ObjectEdges, Silhouettes},
    settings::{Blend, blend_fields},
};

impl Effect for Outlines {
    const NAME: &'static str = "outlines";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::outlines",
        source: include_str!("outlines.wgsl"),
        settings: None,
    };
    type Uniform = NoUniform;

    fn strength(&self) -> f32 {
        let lines = self.visible();
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
        let lit = |edge: EdgeStyle| EdgeStyle {
            unlit_opacity: 1.0,
            ..edge
        };
        let by_meshes = |creases: Creases| Creases {
            convex: creases.convex.map(lit),
            concave: creases.concave.map(lit),
            ..creases
        };
        let creases = self.creases.filter(|_| !self.finds_by_normals());
        Some(Self {
            creases: creases.map(by_meshes),
            weight,
            ..self
        })
    }

    fn lines(&self) -> Option<Outlines> {
        Some(self.visible())
    }

    fn affected_area(&self, _: &EffectContext) -> AffectedArea {
        AffectedArea::AtLines
    }

    fn line_reach(&self, _: &EffectContext) -> Option<f32> {
        Some(0.0)
    }

    fn uniform(&self, _: &EffectContext) -> NoUniform {
        NoUniform::default()
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        Self {
            silhouettes: Silhouettes::blend(self.silhouettes, other.silhouettes, t),
            creases: Creases::blend(self.creases, other.creases, t),
            objects: ObjectEdges::blend(self.objects, other.objects, t),
            ..blend_fields(self, other, t)
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
}
