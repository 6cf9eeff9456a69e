//! What a camera asks for: its components become one plan. Whatever is absent
//! from the plan is neither compiled, bound, packed nor dispatched.

use std::fmt::Debug;

use bevy::ecs::world::EntityRef;

use super::{AnyEffect, EffectType, Needs};
use crate::{
    depth::{DepthHistogram, DepthMap, VisibleDepthRange},
    diagnostics::{ComicsStage, LeftOut},
    finish::{DebugView, Finish, SplitView, StyleWeight},
    lines::{Creases, LineSettings, Silhouettes},
};

/// An effect that a camera draws with.
#[derive(Clone, Debug)]
struct Planned {
    /// Sanitised, of a strength above 0.
    effect: Box<dyn AnyEffect>,
    /// The camera has not got it itself.
    implied: bool,
    /// Another effect draws in its place.
    replaced: bool,
}

impl PartialEq for Planned {
    fn eq(&self, other: &Self) -> bool {
        self.effect.equals(other.effect.as_ref())
            && (self.implied, self.replaced) == (other.implied, other.replaced)
    }
}

/// What a camera draws.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Plan {
    pub depth_map: DepthMap,
    /// In the order of the chain.
    effects: Vec<Planned>,
    /// The other registered effects, and why they are not drawn.
    left_out: Vec<(&'static str, LeftOut)>,
    /// The lines that are found.
    pub lines: Option<LineSettings>,
    /// Objects have lines of their own, or none.
    pub object_styles: bool,
    /// The game reads the range.
    pub readback: bool,
    /// The game reads how the depths are distributed.
    pub histogram: bool,
    pub finish: Finish,
    /// What is shown instead of the picture.
    pub view: Option<DebugView>,
}

impl Plan {
    /// The plan of a camera; `None` if none of its components asks for anything.
    /// `object_styles`: some object has lines of its own, or none.
    pub fn new(
        camera: EntityRef,
        types: &[&'static EffectType],
        object_styles: bool,
    ) -> Option<Self> {
        let mut plan = Self {
            depth_map: camera
                .get::<DepthMap>()
                .copied()
                .unwrap_or_default()
                .sanitized(),
            object_styles,
            readback: camera.contains::<VisibleDepthRange>(),
            histogram: camera.contains::<DepthHistogram>(),
            finish: Finish::new(camera.get::<StyleWeight>(), camera.get::<SplitView>()),
            view: camera.get::<DebugView>().copied().filter(|view| {
                let known = |name| types.iter().any(|t| t.name == name && t.view.is_some());
                match view {
                    DebugView::Effect(name) => known(*name),
                    view => !view.reads_ids() || cfg!(feature = "objects"),
                }
            }),
            ..Self::default()
        };
        let asked = plan.collect(camera, types);
        if !(asked || plan.readback || plan.histogram || plan.view.is_some()) {
            return None;
        }
        plan.show(types);
        if plan.view.is_none() && (plan.finish.weight == 0.0 || plan.finish.split >= 1.0) {
            plan.effects.clear();
            plan.left_out = types
                .iter()
                .map(|t| (t.name, LeftOut::Negligible))
                .collect();
        }
        plan.resolve();
        Some(plan)
    }

    /// Takes the effects of the camera; whether it has any, negligible or not.
    fn collect(&mut self, camera: EntityRef, types: &[&'static EffectType]) -> bool {
        let own: Vec<_> = types
            .iter()
            .map(|effect| (effect.get)(camera).map(AnyEffect::any_sanitized))
            .collect();
        let implied: Vec<_> = own
            .iter()
            .flatten()
            .filter(|effect| effect.any_strength() > 0.0)
            .filter_map(|effect| effect.any_implied())
            .collect();
        let asked = own.iter().any(Option::is_some);
        for (effect, own) in types.iter().zip(own) {
            let is_own = own.is_some();
            let found = own.or_else(|| {
                let name = effect.name;
                let mut implied = implied.iter();
                implied.find(|i| i.effect_type().name == name).cloned()
            });
            match found {
                Some(found) if found.any_strength() > 0.0 => self.effects.push(Planned {
                    effect: found,
                    implied: !is_own,
                    replaced: false,
                }),
                Some(_) if is_own => self.left_out.push((effect.name, LeftOut::Negligible)),
                _ => self.left_out.push((effect.name, LeftOut::NotRequested)),
            }
        }
        asked
    }

    /// Adds what a debug view shows, whether an effect asks for it or not.
    fn show(&mut self, types: &[&'static EffectType]) {
        let Some(view) = self.view else {
            return;
        };
        self.finish.weight = 1.0;
        let DebugView::Effect(name) = view else {
            return;
        };
        if self
            .effects
            .iter()
            .any(|p| p.effect.effect_type().name == name)
        {
            return;
        }
        if let Some(effect) = types.iter().find(|effect| effect.name == name) {
            let at = |name| types.iter().position(|t| t.name == name);
            let own = at(name);
            let before = self
                .effects
                .partition_point(|p| at(p.effect.effect_type().name) < own);
            let effect = (effect.default)();
            self.effects.insert(
                before,
                Planned {
                    effect,
                    implied: true,
                    replaced: false,
                },
            );
            self.left_out.retain(|(known, _)| *known != name);
        }
    }

    /// Decides what follows from the effects that are left.
    fn resolve(&mut self) {
        let asked = self.effects.iter().find_map(|p| p.effect.any_lines());
        self.lines = asked.map(LineSettings::visible).filter(|l| !l.is_empty());
        self.show_lines();
        let found = self.lines.is_some();
        let needs_lines = Needs::LINES | Needs::LINES_ANYWHERE;
        self.leave_out(|effect| {
            let lost = !found && effect.any_needs().intersects(needs_lines);
            lost.then_some(LeftOut::NoSuchLines)
        });
        let replaced: Vec<&str> = self
            .effects
            .iter()
            .flat_map(|p| p.effect.effect_type().replaces)
            .copied()
            .collect();
        for planned in &mut self.effects {
            planned.replaced = replaced.contains(&planned.effect.effect_type().name);
        }
        self.object_styles &= self.lines.is_some();
        // A view of an effect that is not drawn has nothing to show.
        if let Some(DebugView::Effect(name)) = self.view
            && !self.drawn().any(|effect| effect.effect_type().name == name)
        {
            self.view = None;
        }
    }

    /// The lines that a debug view shows.
    fn show_lines(&mut self) {
        let lines = self.lines.unwrap_or(LineSettings::NONE);
        match self.view {
            Some(DebugView::Silhouettes) => {
                let silhouettes = lines.silhouettes.or(Some(Silhouettes::default()));
                self.lines = Some(LineSettings {
                    silhouettes,
                    ..lines
                });
            }
            Some(DebugView::Creases) => {
                let creases = lines.creases.or(Some(Creases::default()));
                self.lines = Some(LineSettings { creases, ..lines });
            }
            _ => {}
        }
    }

    fn leave_out(&mut self, reason: impl Fn(&dyn AnyEffect) -> Option<LeftOut>) {
        let left_out = &mut self.left_out;
        self.effects.retain(|planned| {
            let Some(reason) = reason(planned.effect.as_ref()) else {
                return true;
            };
            left_out.push((planned.effect.effect_type().name, reason));
            false
        });
    }

    /// The plan on a view that has no depth prepass, or no normal prepass (yet).
    pub fn without(&self, missing: Prepasses) -> Self {
        let mut plan = self.clone();
        let (needs, reason) = match missing {
            Prepasses::Depth => (
                Needs::all().difference(Needs::LIGHTNESS_CHANGE),
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
            }
            Prepasses::Normals => {
                plan.view = plan.view.filter(|v| *v != DebugView::Creases);
            }
        }
        plan.resolve();
        plan
    }

    /// The effects that the fused pass applies, in order.
    pub fn drawn(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.effects
            .iter()
            .filter(|planned| !planned.replaced)
            .map(|planned| planned.effect.as_ref())
    }

    /// True if the effect that requests the lines is implied, not on the camera.
    pub fn lines_implied(&self) -> bool {
        self.effects
            .iter()
            .find(|p| p.effect.any_lines().is_some())
            .is_none_or(|p| p.implied)
    }

    /// What the fused pass reads.
    pub fn needs(&self) -> Needs {
        let effects = self.drawn().map(AnyEffect::any_needs);
        let needs = effects.fold(Needs::empty(), |all, one| all | one);
        // LINES_ANYWHERE includes LINES.
        let needs = if needs.contains(Needs::LINES_ANYWHERE) {
            needs | Needs::LINES
        } else {
            needs
        };
        needs | self.view.map_or(Needs::empty(), DebugView::needs)
    }

    /// Whether anything is drawn.
    pub fn draws(&self) -> bool {
        self.drawn().next().is_some() || self.view.is_some()
    }

    fn reads_map(&self) -> bool {
        self.needs().contains(Needs::MAP)
    }

    /// Whether the fused pass reads the visible range.
    pub fn draws_with_range(&self) -> bool {
        self.reads_map() && self.depth_map.mapping.follows_visible_range()
    }

    fn lines_fade(&self) -> bool {
        self.lines.is_some_and(|lines| lines.fades())
    }

    /// Whether the range that is drawn with is more than this frame's own.
    pub fn smooths(&self) -> bool {
        (self.reads_map() || self.lines_fade())
            && self.depth_map.mapping.follows_visible_range()
            && (self.depth_map.smoothing.is_some() || self.depth_map.locked)
    }

    pub fn needs_range(&self) -> bool {
        let map = self.reads_map() || self.lines_fade();
        self.readback || self.histogram || (map && self.depth_map.mapping.follows_visible_range())
    }

    pub fn needs_depth(&self) -> bool {
        let read = Needs::MAP | Needs::DEPTH | Needs::NORMALS | Needs::IDS;
        let view = self.view.is_some_and(DebugView::needs_depth);
        self.readback
            || self.histogram
            || self.lines.is_some()
            || self.needs().intersects(read)
            || view
    }

    pub fn needs_normals(&self) -> bool {
        self.lines.is_some_and(|lines| lines.creases.is_some())
            || self.needs().contains(Needs::NORMALS)
    }

    /// Whether the ids of objects are drawn for this camera.
    pub fn draws_ids(&self) -> bool {
        let lines = self
            .lines
            .is_some_and(|lines| lines.objects.is_some() || self.object_styles);
        cfg!(feature = "objects") && (lines || self.needs().contains(Needs::IDS))
    }

    /// Every effect's stage and why it does not run, in the order of the chain;
    /// `None` if it is drawn.
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

    /// Why a service does not run for this plan, if it does not.
    pub fn reason(&self, stage: ComicsStage) -> LeftOut {
        let lines = self.lines.is_some();
        let maps = self.reads_map() || self.lines_fade();
        match stage {
            ComicsStage::Effect(_) | ComicsStage::RangeReadback => LeftOut::NotRequested,
            ComicsStage::DepthPrepass => LeftOut::NoDepthStyle,
            ComicsStage::NormalPrepass | ComicsStage::ObjectIds | ComicsStage::OutlineEdges => {
                LeftOut::NoSuchLines
            }
            ComicsStage::LineFlood if lines => LeftOut::NarrowLines,
            ComicsStage::LineFlood => LeftOut::NoSuchLines,
            ComicsStage::RangeSmoothing
                if self.depth_map.smoothing.is_none() && !self.depth_map.locked =>
            {
                LeftOut::NotRequested
            }
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if maps => LeftOut::FixedRange,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing if lines => LeftOut::NoMapStyle,
            ComicsStage::DepthRange | ComicsStage::RangeSmoothing => LeftOut::NoDepthStyle,
            ComicsStage::Stylize => LeftOut::NothingToDraw,
        }
    }
}

/// The engine's prepasses that this crate reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Prepasses {
    Depth,
    Normals,
}
