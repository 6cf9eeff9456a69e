//! Plans of views that lack a prepass.

use super::{Needs, Plan, plan::Planned};
use crate::{diagnostics::LeftOut, finish::DebugView};

/// The engine's prepasses that this crate reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Prepasses {
    Depth,
    Normals,
}

impl Plan {
    /// The plan for a view that does not have this prepass, or does not have it yet.
    pub fn without(&self, missing: Prepasses) -> Self {
        let mut plan = self.clone();
        let (needs, reason) = match missing {
            Prepasses::Depth => (
                Needs::all().difference(Needs::WITHOUT_PREPASSES),
                LeftOut::NoDepthPrepass,
            ),
            Prepasses::Normals => (Needs::NORMALS, LeftOut::NoNormalPrepass),
        };
        for planned in std::mem::take(&mut plan.effects) {
            let name = planned.effect.effect_type().name;
            match planned.effect.any_without(needs) {
                Some(effect)
                    if effect.any_strength() > 0.0 && !effect.any_needs().intersects(needs) =>
                {
                    plan.effects.push(Planned { effect, ..planned });
                }
                _ => plan.left_out.push((name, reason)),
            }
        }
        match missing {
            Prepasses::Depth => {
                plan.view = plan.view.filter(|v| !v.needs_depth());
                plan.histogram = false;
                plan.readback = false;
                plan.unstyled = false;
            }
            Prepasses::Normals => {
                plan.view = plan.view.filter(|v| *v != DebugView::Creases);
            }
        }
        plan.resolve();
        plan
    }
}
