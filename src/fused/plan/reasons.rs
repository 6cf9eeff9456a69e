//! Why a camera's plan leaves a stage out.

use super::Plan;
use crate::diagnostics::{ComicsStage, SkipReason};
use crate::effect::EffectType;

impl Plan {
    /// The stage of every effect, in the order of the chain, and why it does not
    /// run; `None` if it is drawn.
    pub fn effect_stages(
        &self,
        types: &[&'static EffectType],
    ) -> Vec<(ComicsStage, Option<SkipReason>)> {
        let reason = |name: &str| {
            let left = self.left_out.iter().rev().find(|(known, _)| *known == name);
            let planned = self.effects.iter().find(|p| p.effect.name() == name);
            match (left, planned) {
                (_, Some(p)) if p.replaced && p.implied => Some(SkipReason::NotRequested),
                (_, Some(p)) if p.replaced => Some(SkipReason::Replaced),
                (_, Some(_)) => None,
                (Some((_, reason)), None) => Some(*reason),
                (None, None) => Some(SkipReason::NotRequested),
            }
        };
        types
            .iter()
            .map(|t| (ComicsStage::Effect(t.name), reason(t.name)))
            .collect()
    }

    /// The reason that is reported if a stage does not run for this plan.
    pub fn reason(&self, stage: ComicsStage) -> SkipReason {
        let lines = self.lines.is_some();
        let maps = self.reads_map() || self.lines_read_map();
        match stage {
            ComicsStage::Effect(_)
            | ComicsStage::RangeReadback
            | ComicsStage::HighlightedObjects
            | ComicsStage::Tones => SkipReason::NotRequested,
            ComicsStage::DepthPrepass => SkipReason::NoDepthStyle,
            ComicsStage::TransparentDepth if self.lacks.depth_copies => SkipReason::NoDepthCopies,
            ComicsStage::ObjectIds | ComicsStage::TransparentDepth if self.lacks.object_ids => {
                SkipReason::NoStorageBuffers
            }
            ComicsStage::TransparentDepth if self.needs_depth() => SkipReason::NoSuchMeshes,
            ComicsStage::TransparentDepth => SkipReason::NoDepthStyle,
            ComicsStage::NormalPrepass
            | ComicsStage::ObjectIds
            | ComicsStage::ResolveSamples
            | ComicsStage::SearchTiles
            | ComicsStage::FindLines
            | ComicsStage::DrawLines => SkipReason::NoSuchLines,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing
                if self.range_of.is_some() && !self.lacks.compute_shaders =>
            {
                SkipReason::RangeOf
            }
            ComicsStage::RangeSmoothing
                if self.depth_map.smoothing.is_none() && !self.depth_map.locked =>
            {
                SkipReason::NotRequested
            }
            ComicsStage::RangeSmoothing if self.lacks.compute_shaders && self.smooths() => {
                SkipReason::NoComputeShaders
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if maps => SkipReason::FixedRange,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if lines => {
                SkipReason::NoMapStyle
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing => SkipReason::NoDepthStyle,
            ComicsStage::Stylize => SkipReason::NothingToDraw,
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::world::World;

    use super::*;
    use crate::{
        BlackFlats, ToneRange, effect::EffectRegistry, fused::DeviceLacks, objects::ObjectChanges,
    };

    /// Tones are brought into a range where an effect divides them and compute shaders find it, and
    /// as far as that effect is seen.
    #[test]
    fn a_range_of_tones_is_left_out_where_nothing_divides_or_finds_it() {
        let types = EffectRegistry::built_in().types();
        for (value, compute_shaders, opacity, expected) in [
            (Some(0.2), false, 1.0, Ok(1.0)),
            (Some(0.2), false, 0.125, Ok(0.5)),
            (Some(0.2), true, 1.0, Err(SkipReason::NoComputeShaders)),
            (None, false, 1.0, Err(SkipReason::NoToneStyle)),
        ] {
            let flats = BlackFlats {
                slope: Some(0.1),
                value,
                opacity,
                ..BlackFlats::default()
            };
            let mut world = World::new();
            let camera = world.spawn((ToneRange::default(), flats)).id();
            let lacks = DeviceLacks {
                compute_shaders,
                ..DeviceLacks::default()
            };
            let plan = Plan::new(world.entity(camera), &[], &types, ObjectChanges::default());
            let plan = plan.expect("effects").on_device(lacks);
            assert_eq!(plan.tones().map(|range| range.amount), expected.ok());
            let stage = (ComicsStage::of::<ToneRange>(), expected.err());
            assert!(plan.effect_stages(&types).contains(&stage), "{stage:?}");
        }
    }
}
