//! Why a camera's plan leaves a stage out.

use super::{EffectType, plan::Plan};
use crate::diagnostics::{ComicsStage, LeftOut};

impl Plan {
    /// The stage of every effect, in the order of the chain, and why it does not
    /// run; `None` if it is drawn.
    pub fn effect_stages(
        &self,
        types: &[&'static EffectType],
    ) -> Vec<(ComicsStage, Option<LeftOut>)> {
        let reason = |name: &str| {
            let left = self.left_out.iter().rev().find(|(known, _)| *known == name);
            let planned = self
                .effects
                .iter()
                .find(|p| p.effect.effect_type().name == name);
            match (left, planned) {
                (_, Some(p)) if p.replaced && p.implied => Some(LeftOut::NotRequested),
                (_, Some(p)) if p.replaced => Some(LeftOut::Replaced),
                (_, Some(_)) => None,
                (Some((_, reason)), None) => Some(*reason),
                (None, None) => Some(LeftOut::NotRequested),
            }
        };
        types
            .iter()
            .map(|t| (ComicsStage::Effect(t.name), reason(t.name)))
            .collect()
    }

    /// The reason that is reported if a stage does not run for this plan.
    pub fn reason(&self, stage: ComicsStage) -> LeftOut {
        let lines = self.lines.is_some();
        let maps = self.reads_map() || self.lines_read_map();
        match stage {
            ComicsStage::Effect(_) | ComicsStage::RangeReadback | ComicsStage::MarkedObjects => {
                LeftOut::NotRequested
            }
            ComicsStage::DepthPrepass => LeftOut::NoDepthStyle,
            ComicsStage::TransparentDepth if self.lacks.depth_copies => LeftOut::NoDepthCopies,
            ComicsStage::ObjectIds | ComicsStage::TransparentDepth if self.lacks.object_ids => {
                LeftOut::NoStorageBuffers
            }
            ComicsStage::TransparentDepth if self.needs_depth() => LeftOut::NoSuchMeshes,
            ComicsStage::TransparentDepth => LeftOut::NoDepthStyle,
            ComicsStage::NormalPrepass
            | ComicsStage::ObjectIds
            | ComicsStage::ResolveSamples
            | ComicsStage::SearchTiles
            | ComicsStage::FindLines
            | ComicsStage::DrawLines => LeftOut::NoSuchLines,
            ComicsStage::RangeSmoothing
                if self.depth_map.smoothing.is_none() && !self.depth_map.locked =>
            {
                LeftOut::NotRequested
            }
            ComicsStage::RangeSmoothing if self.lacks.compute_shaders && self.smooths() => {
                LeftOut::NoComputeShaders
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if maps => LeftOut::FixedRange,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if lines => LeftOut::NoMapStyle,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing => LeftOut::NoDepthStyle,
            ComicsStage::Stylize => LeftOut::NothingToDraw,
        }
    }
}
