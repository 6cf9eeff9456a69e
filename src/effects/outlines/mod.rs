//! Draws the outlines of the geometry: silhouettes from depth, creases from normals,
//! edges between objects from their ids (\[CL\] 2.1, after Decaudin).

pub use crate::lines::Outlines;

use crate::{
    effect::{
        AffectedArea, Effect, EffectContext, EffectShader, EffectStage, Needs, NoUniform,
        mix_fields,
    },
    lines::{Creases, EdgeStyle, LineWeight, ObjectEdges, Silhouettes},
    settings::{Blend, clamp_fields},
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

    fn sanitized(self) -> Self {
        Self {
            silhouettes: self.silhouettes.map(Silhouettes::sanitized),
            creases: self.creases.map(Creases::sanitized),
            objects: self.objects.map(ObjectEdges::sanitized),
            color: self.color.sanitized(),
            ..clamp_fields(self)
        }
    }

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
        let later = if t < 0.5 { self } else { other };
        Self {
            silhouettes: Silhouettes::blend(self.silhouettes, other.silhouettes, t),
            creases: Creases::blend(self.creases, other.creases, t),
            objects: ObjectEdges::blend(self.objects, other.objects, t),
            weight: self.weight.mixed(other.weight, t),
            boil: self.boil.mixed(other.boil, t),
            color: self.color.mixed(other.color, t),
            min_length: later.min_length,
            gap_closing: later.gap_closing,
            hold_frames: later.hold_frames,
            response: later.response,
            smooth: later.smooth,
            edge: later.edge,
            fog: later.fog,
            ..mix_fields(self, other, t)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers of any size are clamped to their documented ranges.
    #[test]
    fn counts_are_clamped() {
        for n in [0, 1, 2, 3, 4, 8, 9, u32::MAX] {
            let outlines = Outlines {
                min_length: n,
                gap_closing: n,
                hold_frames: n,
                ..Outlines::default()
            };
            let found = outlines.sanitized();
            assert_eq!(found.min_length, n.clamp(1, 8));
            assert_eq!(found.gap_closing, n.min(3));
            assert_eq!(found.hold_frames, n.min(8));
        }
    }
}
