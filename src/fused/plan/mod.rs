//! The plan of a camera, made from its components. Whatever is not in the plan is
//! neither compiled, bound, packed nor dispatched.

pub(super) mod device;
pub(super) mod missing;
pub(super) mod passes;
mod reasons;
pub(super) mod view_plan;

use crate::effect::{AnyEffect, EffectStage, EffectType, Needs};
use std::fmt::Debug;

use bevy::ecs::{entity::Entity, world::EntityRef};

use self::device::DeviceLacks;
use crate::{
    composite::{BeyondPrepass, Composite, DebugView, OwnPixels, SplitView, StyleWeight},
    depth::{DepthHistogram, DepthMap, VisibleDepthRange},
    diagnostics::SkipReason,
    lines::{CreaseSource, Creases, LineFog, Outlines, Silhouettes, has_fog},
    objects::ObjectChanges,
    page::PageHeight,
    tones::ToneRange,
};

/// An effect in a camera's plan.
#[derive(Clone, Debug)]
pub(super) struct Planned {
    /// Sanitized; its strength is above 0.
    pub effect: Box<dyn AnyEffect>,
    /// Not a component of the camera: another effect or the debug view implies it.
    pub implied: bool,
    /// Another effect of the plan replaces it.
    pub replaced: bool,
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
    pub(super) effects: Vec<Planned>,
    /// The other registered effects, and why they are not drawn.
    pub(super) left_out: Vec<(&'static str, SkipReason)>,
    /// The lines to find.
    pub lines: Option<Outlines>,
    /// The components of objects that it follows.
    pub objects: ObjectChanges,
    /// Borders of sections are creases.
    pub sections: bool,
    /// Lines fade into the camera's distance fog.
    pub fog: bool,
    pub lacks: DeviceLacks,
    /// The game reads the visible range.
    pub readback: bool,
    /// The game reads the histogram of depths.
    pub histogram: bool,
    /// Some material reads the smoothed visible range.
    pub materials: bool,
    /// The camera whose visible range this one takes.
    pub range_of: Option<Entity>,
    /// Another camera takes the visible range of this one.
    pub lends: bool,
    /// The app has a `WorldOrigin`.
    pub has_origin: bool,
    /// Effects change only the pixels that the camera has drawn.
    pub own_pixels: Option<OwnPixels>,
    pub beyond: BeyondPrepass,
    pub composite: Composite,
    /// The debug view that replaces the picture.
    pub view: Option<DebugView>,
}

impl Plan {
    /// The plan of a camera; `None` if none of its components requests anything.
    /// `shown`: effects that are drawn instead of the camera's own of the same type.
    pub fn new(
        camera: EntityRef,
        shown: &[Box<dyn AnyEffect>],
        types: &[&'static EffectType],
        objects: ObjectChanges,
    ) -> Option<Self> {
        let mut plan = Self {
            depth_map: camera
                .get::<DepthMap>()
                .copied()
                .unwrap_or_default()
                .sanitized(),
            objects,
            fog: has_fog(camera),
            readback: camera.contains::<VisibleDepthRange>(),
            histogram: camera.contains::<DepthHistogram>(),
            beyond: camera.get().copied().unwrap_or_default(),
            composite: Composite::new(camera.get::<StyleWeight>(), camera.get::<SplitView>()),
            view: camera.get::<DebugView>().copied().filter(|view| {
                let known = |name| types.iter().any(|t| t.name == name && t.view.is_some());
                match view {
                    DebugView::Effect(name) => known(*name),
                    view => !view.reads_ids() || cfg!(feature = "objects"),
                }
            }),
            ..Self::default()
        };
        let asked = plan.collect(camera, shown, types);
        if !(asked
            || plan.objects.highlights
            || plan.readback
            || plan.histogram
            || plan.view.is_some()
            // Materials have its lengths.
            || camera.contains::<PageHeight>())
        {
            return None;
        }
        plan.show(types);
        if plan.view.is_none() && (plan.composite.weight == 0.0 || plan.composite.split >= 1.0) {
            plan.effects.clear();
            plan.left_out = types
                .iter()
                .map(|t| (t.name, SkipReason::Negligible))
                .collect();
        }
        plan.resolve();
        Some(plan)
    }

    /// Adds the effects of the camera and those that they imply. Returns whether
    /// the camera has any effect, negligible ones included.
    fn collect(
        &mut self,
        camera: EntityRef,
        shown: &[Box<dyn AnyEffect>],
        types: &[&'static EffectType],
    ) -> bool {
        let of_camera = |effect: &&EffectType| {
            let instead = shown.iter().find(|s| s.name() == effect.name);
            let own = || (effect.get)(camera).map(AnyEffect::any_sanitized);
            instead.cloned().or_else(own)
        };
        let own: Vec<_> = types.iter().map(of_camera).collect();
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
                implied.find(|i| i.name() == name).cloned()
            });
            match found {
                Some(found) if found.any_strength() > 0.0 => self.effects.push(Planned {
                    effect: found,
                    implied: !is_own,
                    replaced: false,
                }),
                Some(_) if is_own => self.left_out.push((effect.name, SkipReason::Negligible)),
                _ => self.left_out.push((effect.name, SkipReason::NotRequested)),
            }
        }
        asked
    }

    /// Adds the effect that a debug view shows, if the camera does not have it.
    fn show(&mut self, types: &[&'static EffectType]) {
        let Some(view) = self.view else {
            return;
        };
        self.composite.weight = 1.0;
        let DebugView::Effect(name) = view else {
            return;
        };
        if self.effects.iter().any(|p| p.effect.name() == name) {
            return;
        }
        if let Some(effect) = types.iter().find(|effect| effect.name == name) {
            let at = |name| types.iter().position(|t| t.name == name);
            let own = at(name);
            let before = self.effects.partition_point(|p| at(p.effect.name()) < own);
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

    /// Derives the lines, and the effects that are left out or replaced.
    pub(super) fn resolve(&mut self) {
        let asked = self.effects.iter().find_map(|p| p.effect.any_lines());
        let has_ids = self.has_ids();
        let has_sections = has_ids && !self.lacks.primitive_index;
        self.lines = asked
            .map(Outlines::visible)
            .map(|lines| Outlines {
                objects: lines.objects.filter(|_| has_ids),
                creases: lines.creases.map(|creases| Creases {
                    source: if has_sections {
                        creases.source
                    } else {
                        CreaseSource::Normals
                    },
                    ..creases
                }),
                ..lines
            })
            .filter(|l| !l.is_empty());
        self.show_lines();
        let lost = self.lines.is_none();
        let needs_lines = Needs::LINES | Needs::LINES_ANYWHERE;
        self.leave_out(|effect| {
            (lost && effect.any_needs().intersects(needs_lines)).then_some(SkipReason::NoSuchLines)
        });
        let replaced: Vec<&str> = self
            .effects
            .iter()
            .flat_map(|p| p.effect.effect_type().replaces)
            .copied()
            .collect();
        for planned in &mut self.effects {
            planned.replaced = replaced.contains(&planned.effect.name());
        }
        let left_as_found = self.leaves_tones();
        self.leave_out(|effect| left_as_found.filter(|_| effect.any_tones().is_some()));
        self.objects.any &= self.lines.is_some();
        self.sections = has_sections && self.has_section_borders();
        self.objects.widths &= self.lines.is_some_and(|lines| lines.has_wide_lines());
        let color = |effect: &dyn AnyEffect| effect.effect_type().stage <= EffectStage::Print;
        let colors = self.drawn().any(color);
        self.objects.unstyled &= colors;
        self.fog = self.lines.is_some_and(|lines| match lines.fog {
            LineFog::Ignore => false,
            LineFog::Fade => self.fog,
            LineFog::Visibility { .. } => true,
        });
        // The debug view of an effect that is not drawn shows nothing.
        if let Some(DebugView::Effect(name)) = self.view
            && !self.drawn().any(|effect| effect.name() == name)
        {
            self.view = None;
        }
    }

    /// Whether borders of sections are creases, on a device that can draw sections. If ids are drawn
    /// anyway they are before any mesh is divided: then no pipeline is made anew, and no line is missing.
    fn has_section_borders(&self) -> bool {
        let Some(lines) = self.lines.filter(Outlines::has_measured_creases) else {
            return false;
        };
        let found = self.objects.sections || lines.objects.is_some();
        self.objects.asked_sections || (found && lines.divides_meshes())
    }

    /// Adds the lines that a debug view shows.
    fn show_lines(&mut self) {
        let lines = self.lines.unwrap_or(Outlines::BARE);
        match self.view {
            Some(DebugView::Silhouettes) => {
                let silhouettes = lines.silhouettes.or(Some(Silhouettes::default()));
                self.lines = Some(Outlines {
                    silhouettes,
                    ..lines
                });
            }
            Some(DebugView::Creases) => {
                let creases = lines.creases.or(Some(Creases::default()));
                self.lines = Some(Outlines { creases, ..lines });
            }
            _ => {}
        }
    }

    /// Why no tones are brought into a range; `None` if they can be.
    fn leaves_tones(&self) -> Option<SkipReason> {
        if self.lacks.compute_shaders {
            return Some(SkipReason::NoComputeShaders);
        }
        self.divides_tones()
            .next()
            .is_none()
            .then_some(SkipReason::NoToneStyle)
    }

    /// The drawn effects that divide tones or shade by them.
    fn divides_tones(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.drawn()
            .filter(|effect| effect.any_needs().contains(Needs::TONES))
    }

    /// The range that tones are brought into. It fades with the effects that divide them.
    pub fn tones(&self) -> Option<ToneRange> {
        let range = self.drawn().find_map(AnyEffect::any_tones)?;
        let strengths = self.divides_tones().map(AnyEffect::any_strength);
        Some(range.for_strength(strengths.fold(0.0, f32::max)))
    }

    /// Removes the effects for which there is a reason, and records it.
    fn leave_out(&mut self, reason: impl Fn(&dyn AnyEffect) -> Option<SkipReason>) {
        let left_out = &mut self.left_out;
        self.effects.retain(|planned| {
            let Some(reason) = reason(planned.effect.as_ref()) else {
                return true;
            };
            left_out.push((planned.effect.name(), reason));
            false
        });
    }

    /// The effects that the fused pass applies, in order.
    pub fn drawn(&self) -> impl Iterator<Item = &dyn AnyEffect> {
        self.effects
            .iter()
            .filter(|planned| !planned.replaced)
            .map(|planned| planned.effect.as_ref())
    }

    /// Whether the effect that requests the lines is implied, not on the camera.
    /// Also true if no effect requests lines.
    pub fn lines_implied(&self) -> bool {
        self.effects
            .iter()
            .find(|p| p.effect.any_lines().is_some())
            .is_none_or(|p| p.implied)
    }

    /// The inputs that the fused pass reads.
    pub fn needs(&self) -> Needs {
        let effects = self.drawn().map(AnyEffect::any_needs);
        let mut needs = effects.fold(Needs::empty(), |all, one| all | one);
        if needs.contains(Needs::LINES_ANYWHERE) {
            needs |= Needs::LINES;
        }
        let available = [
            (Needs::OBJECT_ANCHORS, self.objects.anchored),
            (Needs::WORLD_ORIGIN, self.has_origin),
            (Needs::OBJECT_DEPTHS, self.has_ids()),
            (Needs::MIDDLE_DEPTH, !self.lacks.compute_shaders),
        ];
        for (need, _) in available.into_iter().filter(|(_, is_there)| !is_there) {
            needs.remove(need);
        }
        needs.remove(Needs::TONES);
        if self.objects.unstyled || needs.intersects(Needs::OBJECT_ANCHORS | Needs::OBJECT_DEPTHS) {
            needs |= Needs::IDS;
        }
        if self.draws() {
            needs |= self.mask_needs();
        }
        needs | self.view.map_or(Needs::empty(), DebugView::needs)
    }

    /// Whether effects change only some pixels.
    pub(super) fn is_masked(&self) -> bool {
        self.own_pixels.is_some() || self.beyond != BeyondPrepass::Styled
    }

    /// What says which pixels effects change.
    fn mask_needs(&self) -> Needs {
        let own = self.own_pixels.map_or(Needs::empty(), |own| match own {
            OwnPixels::Depth => Needs::DEPTH,
            OwnPixels::Ids => Needs::IDS,
        });
        match self.beyond {
            BeyondPrepass::Styled => own,
            BeyondPrepass::NoLines | BeyondPrepass::Plain => own | Needs::DEPTH,
        }
    }

    /// Whether anything is drawn.
    pub fn draws(&self) -> bool {
        self.drawn().next().is_some() || self.view.is_some()
    }

    pub(super) fn reads_map(&self) -> bool {
        self.needs().contains(Needs::MAP)
    }

    /// Whether the fused pass reads the visible range.
    pub fn draws_with_range(&self) -> bool {
        self.reads_map() && self.depth_map.mapping.follows_visible_range()
    }

    pub(super) fn lines_read_map(&self) -> bool {
        self.lines
            .is_some_and(|lines| lines.fades() || lines.weight.perspective > 0.0)
    }

    /// Whether the range depends on earlier frames: it is smoothed or locked.
    pub fn smooths(&self) -> bool {
        (self.lends || self.reads_range())
            && (self.depth_map.smoothing.is_some() || self.depth_map.locked)
    }

    pub fn needs_range(&self) -> bool {
        self.readback
            || self.histogram
            || self.lends
            || self
                .needs()
                .intersects(Needs::DEPTH_BORDERS | Needs::MIDDLE_DEPTH)
            || self.reads_range()
    }

    /// Whether something is drawn by the visible range.
    pub fn reads_range(&self) -> bool {
        let map = self.reads_map() || self.lines_read_map();
        self.materials || (map && self.depth_map.mapping.follows_visible_range())
    }

    pub fn needs_depth(&self) -> bool {
        let read = Needs::MAP | Needs::DEPTH | Needs::NORMALS | Needs::IDS;
        let read = read | Needs::DEPTH_BORDERS | Needs::MIDDLE_DEPTH;
        let view = self.view.is_some_and(DebugView::needs_depth);
        self.readback
            || self.objects.highlights
            || self.histogram
            || self.materials
            || self.lends
            || self.lines.is_some()
            || self.needs().intersects(read)
            || view
    }

    pub fn needs_normals(&self) -> bool {
        let lines = self.lines;
        lines.is_some_and(|lines| lines.finds_by_normals() || lines.needs_normals())
            || self.needs().contains(Needs::NORMALS)
            // The engine's prepass without normals has no fragment shader, so meshes would not fade in it.
            || (self.objects.fades && self.needs_depth())
    }

    /// Whether the ids of objects are drawn for this camera.
    pub fn draws_ids(&self) -> bool {
        let lines = self.lines.is_some_and(|lines| {
            let needs_objects = lines.silhouettes.is_some() && lines.weight.reads_ids();
            lines.objects.is_some() || self.objects.any || self.sections || needs_objects
        });
        let ids = lines || self.draws_widths() || self.needs().contains(Needs::IDS);
        self.has_ids() && ids
    }

    /// Whether object ids can be drawn.
    pub fn has_ids(&self) -> bool {
        cfg!(feature = "objects") && !self.lacks.object_ids
    }
}
