//! Divides the effects of a plan into passes.

use crate::effect::{AnyEffect, EffectStage, Needs};
use std::ops::Range;

use super::Plan;
use crate::composite::DebugView;

/// Which of the drawn effects of a plan a pass applies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pass {
    /// Positions in [`Plan::drawn`].
    pub effects: Range<usize>,
    /// The pass starts from the picture that the one before has drawn.
    pub continued: bool,
    /// Draws that picture for the next pass; else the view's picture.
    pub is_earlier: bool,
    /// What its first effect reads besides the picture before it.
    pub reads: Option<Reads>,
}

/// What an effect reads besides the picture before it, with the effect's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reads {
    /// Means over boxes of that picture.
    BoxStatistics(&'static str),
    /// A number of its own at every pixel.
    AuxScalar(&'static str),
}

/// The passes of a plan, in order: one, and one more for each effect that reads the picture
/// before it at other places. A debug view ends with the pass of its effect.
pub(crate) fn passes(plan: &Plan) -> Vec<Pass> {
    let count = plan.drawn().count();
    let mut starts = vec![0];
    starts.extend(
        plan.drawn()
            .enumerate()
            .filter_map(|(i, effect)| reads_picture(effect).then_some(i)),
    );
    let shown = plan.view.map(|view| last_shown(plan, view));
    starts.retain(|start| *start == 0 || shown.is_none_or(|shown| *start <= shown));
    let ends = starts.iter().copied().skip(1).chain([count]);
    let last = starts.len() - 1;
    starts
        .iter()
        .copied()
        .zip(ends)
        .enumerate()
        .map(|(i, (start, end))| Pass {
            effects: start..end,
            continued: i > 0,
            is_earlier: i < last,
            reads: reads(plan, start).filter(|_| i > 0),
        })
        .collect()
}

/// Whether an effect reads the picture before it at other places.
fn reads_picture(effect: &dyn AnyEffect) -> bool {
    let picture = Needs::PICTURE | Needs::BOX_STATISTICS | Needs::AUX_SCALAR;
    effect.any_needs().intersects(picture)
}

/// What the effect at this position of [`Plan::drawn`] reads.
fn reads(plan: &Plan, at: usize) -> Option<Reads> {
    let effect = plan.drawn().nth(at)?;
    let (needs, of) = (effect.any_needs(), effect.effect_type());
    if needs.contains(Needs::BOX_STATISTICS) {
        of.half_box.then_some(Reads::BoxStatistics(of.name))
    } else if needs.contains(Needs::AUX_SCALAR) {
        of.aux_scalar.then_some(Reads::AuxScalar(of.name))
    } else {
        None
    }
}

/// The last effect that a debug view depends on, as a position in [`Plan::drawn`].
fn last_shown(plan: &Plan, view: DebugView) -> usize {
    let at = |name| plan.drawn().position(|e| e.name() == name);
    match view {
        DebugView::Effect(name) => at(name).unwrap_or(0),
        DebugView::Difference => usize::MAX,
        // An effect that reads the picture keeps no saturation.
        DebugView::Saturation => plan
            .drawn()
            .enumerate()
            .filter(|(_, e)| e.effect_type().stage <= EffectStage::Color && !reads_picture(*e))
            .map(|(i, _)| i)
            .last()
            .unwrap_or(0),
        _ => 0,
    }
}

impl DebugView {
    /// The inputs that the view reads.
    pub(crate) fn needs(self) -> Needs {
        match self {
            Self::DepthMap | Self::RawRange => Needs::MAP,
            Self::Silhouettes | Self::Creases => Needs::LINES,
            Self::ObjectIds => Needs::IDS,
            Self::Saturation | Self::Difference | Self::Effect(_) => Needs::empty(),
        }
    }
}

impl Plan {
    /// Whether the colors are printed: the view is then styled after FXAA and SMAA.
    pub(crate) fn runs_after_anti_aliasing(&self) -> bool {
        self.drawn().any(AnyEffect::any_runs_after_anti_aliasing)
    }
}

#[cfg(test)]
mod tests {
    use bevy::ecs::{bundle::Bundle, world::World};

    use super::*;
    use crate::{
        Desaturation, Halftone, Misregistration, Outlines, Paint,
        effect::EffectRegistry,
        effects::{PaintKernel, ScreenSampling},
        objects::ObjectChanges,
    };

    fn divided(camera: impl Bundle) -> Vec<(Range<usize>, bool, bool)> {
        let mut world = World::new();
        let camera = world.spawn(camera).id();
        let types = EffectRegistry::built_in().types();
        let plan = Plan::new(world.entity(camera), &[], &types, ObjectChanges::default());
        passes(&plan.expect("a plan"))
            .into_iter()
            .map(|pass| (pass.effects, pass.continued, pass.is_earlier))
            .collect()
    }

    const CELLS: ScreenSampling = ScreenSampling::Cell;

    #[test]
    fn only_effects_that_read_the_picture_elsewhere_divide_the_pass() {
        let colors = (Desaturation::default(), Outlines::default());
        assert_eq!(
            divided((colors, Halftone::default())),
            [(0..3, false, false)]
        );
        assert_eq!(
            divided((colors, Misregistration::default(), Halftone::default())),
            [(0..1, false, true), (1..4, true, false)]
        );
        let cells = Halftone {
            sampling: CELLS,
            ..Default::default()
        };
        assert_eq!(
            divided((colors, Misregistration::default(), cells)),
            [(0..1, false, true), (1..2, true, true), (2..4, true, false)]
        );
        // The first effect reads the picture: the first pass only copies it.
        assert_eq!(divided(cells), [(0..0, false, true), (0..1, true, false)]);
    }

    #[test]
    fn means_are_drawn_for_the_pass_that_reads_them() {
        let reads = |form| {
            let mut world = World::new();
            let paint = Paint {
                kernel: form,
                ..Default::default()
            };
            let camera = world.spawn((Desaturation::default(), paint, Misregistration::default()));
            let camera = camera.id();
            let types = EffectRegistry::built_in().types();
            let plan = Plan::new(world.entity(camera), &[], &types, ObjectChanges::default());
            let passes = passes(&plan.expect("a plan"));
            passes.iter().map(|pass| pass.reads).collect::<Vec<_>>()
        };
        let means = Some(Reads::BoxStatistics("paint"));
        assert_eq!(reads(PaintKernel::Box), [None, means, None]);
        assert_eq!(reads(PaintKernel::Anisotropic), [None; 3]);
    }

    #[test]
    fn debug_views_end_with_what_they_show() {
        let styled = (Desaturation::default(), Misregistration::default());
        for view in [DebugView::DepthMap, DebugView::Saturation] {
            assert_eq!(divided((styled, view)), [(0..2, false, false)]);
        }
        assert_eq!(divided((styled, DebugView::Difference)).len(), 2);
        let painted = (Desaturation::default(), Paint::default());
        assert_eq!(divided((painted, DebugView::Saturation)).len(), 1);
    }
}
