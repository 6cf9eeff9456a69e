//! Impact frames: for a few drawings a camera shows two tones and focus lines.

use bevy::{
    camera::{NormalizedRenderTarget, RenderTarget},
    ecs::system::SystemParam,
    prelude::*,
    window::PrimaryWindow,
};

use super::flashes::{Flashes, PastFlashes};
use crate::{
    clock,
    diagnostics::ComicsDiagnostics,
    effect::{AnyEffect, Effect},
    effects::{SpeedLines, TwoTone},
    settings::clamp_or_default,
};

/// Shows an impact frame on a camera: two tones by lightness with focus lines over them, for one to
/// three drawings. Then the picture is as before.
///
/// It replaces the [`TwoTone`] and [`SpeedLines`] of the camera meanwhile, works on cameras
/// without any effect, and needs no prepass. A new impact ends the one before. It is hidden
/// where [`StyleWeight`](crate::StyleWeight) or [`SplitView`](crate::SplitView) show the
/// original. Drawings are counted from the first frame that shows the impact, on the app's
/// default clock: while the game is paused, the impact stays. The first impact of a camera
/// compiles a pipeline; it is shown, and its time begins, when that is done.
///
/// **Flashes.** Fast flashes can cause seizures (WCAG 2.3.1). At most [`Impact::MOST_FLASHES`]
/// flashes begin in any second of real time on a render target, counting all of its cameras, even
/// despawned ones. Further impacts are refused, and counted in
/// [`ComicsDiagnostics::impacts`](crate::ComicsDiagnostics::impacts). A flash counts from the frame
/// that shows it, not from its trigger. The resource [`ReduceFlashing`] replaces the tones by a dim
/// picture.
///
/// ```
/// # use bevy::ecs::prelude::*;
/// # use bevy_comics::Impact;
/// fn hit(mut commands: Commands, camera: Entity) {
///     commands.trigger(Impact::new(camera));
/// }
/// ```
#[derive(EntityEvent, Reflect, Clone, Debug, PartialEq)]
pub struct Impact {
    /// The camera.
    pub entity: Entity,
    /// Number of drawings. Range 1 to 3, default 2.
    pub drawings: u32,
    /// Drawings per second. Range 4 to 30, default 12.
    pub rate: f32,
    /// Whether every second drawing exchanges the tones. With two or three drawings that
    /// counts as two flashes. Default: `false`.
    pub alternate: bool,
    /// The tones. Default: black and white.
    pub tones: TwoTone,
    /// The lines over the tones; every drawing has others. Lines in the color of one tone
    /// have that of the other one where the tones are exchanged. `None`: no lines. Default:
    /// focus lines in the color of the dark tone.
    pub lines: Option<SpeedLines>,
}

impl Impact {
    /// The most flashes that begin in any second on a render target (WCAG 2.3.1).
    pub const MOST_FLASHES: usize = 3;

    /// An impact of two drawings in black and white, with focus lines.
    pub fn new(camera: Entity) -> Self {
        Self {
            entity: camera,
            drawings: 2,
            rate: 12.0,
            alternate: false,
            tones: TwoTone::default(),
            lines: Some(SpeedLines::default()),
        }
    }

    /// The impact that is shown: every number is clamped to its range.
    #[must_use]
    pub fn sanitized(self) -> Self {
        Self {
            drawings: self.drawings.clamp(1, 3),
            rate: clamp_or_default(self.rate, 12.0, 4.0, 30.0),
            tones: self.tones.sanitized(),
            lines: self.lines.map(Effect::sanitized),
            ..self
        }
    }

    /// The flashes of the impact: pairs of opposite changes of the picture, rounded up.
    pub fn flashes(&self) -> usize {
        if self.alternate && self.drawings > 1 {
            2
        } else {
            1
        }
    }

    fn effects(&self, drawing: u32, reduced: bool) -> Vec<Box<dyn AnyEffect>> {
        let exchanged = self.alternate && drawing % 2 == 1;
        let tones = if reduced {
            DIM
        } else {
            TwoTone {
                invert: self.tones.invert != exchanged,
                ..self.tones
            }
        };
        let redrawn = if reduced { 0 } else { drawing };
        let lines = self.lines.map(|lines| SpeedLines {
            rate: 0.0,
            seed: (lines.seed + redrawn) % 65536,
            color: tones.shown(lines.color),
            ..lines
        });
        let lines = lines.map(|lines| Box::new(lines) as Box<dyn AnyEffect>);
        lines.into_iter().chain([Box::new(tones) as _]).collect()
    }
}

/// 20 % less light: no place changes by more than a fifth of the brightest light.
const DIM: TwoTone = TwoTone {
    threshold: 0.5,
    dark: Color::BLACK,
    light: Color::BLACK,
    invert: false,
    softness: 0.0,
    amount: 0.2,
};

/// Whether flashes are reduced, for people who are sensitive to them: an [`Impact`] then dims
/// the picture by 20 % (in linear light) instead of showing two tones, and its lines stand
/// still. Default: `false`.
///
/// Games should offer it as an accessibility setting.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Resource, Default)]
pub struct ReduceFlashing(pub bool);

/// On a camera that had impacts: the one that is shown, and the last flashes.
#[derive(Component, Debug, Default)]
pub(crate) struct Impacts {
    running: Option<Running>,
    flashes: Flashes,
    /// Where the camera showed them.
    target: Option<NormalizedRenderTarget>,
}

#[derive(Debug)]
struct Running {
    impact: Impact,
    /// Game time at which it was first shown.
    since: Option<f64>,
    effects: Vec<Box<dyn AnyEffect>>,
}

/// A time in seconds since the app started.
#[derive(Clone, Copy, Debug)]
struct Moment {
    game: f64,
    real: f64,
}

/// The clocks of the app; tests may have none.
#[derive(SystemParam)]
pub(super) struct Clocks<'w> {
    game: Option<Res<'w, Time>>,
    real: Option<Res<'w, Time<Real>>>,
}

impl Clocks<'_> {
    fn now(&self) -> Moment {
        let game = self.game.as_ref().map(|time| time.elapsed_secs_f64());
        let real = self.real.as_ref().map(|time| time.elapsed_secs_f64());
        Moment {
            game: game.unwrap_or_default(),
            real: real.or(game).unwrap_or_default(),
        }
    }
}

impl Impacts {
    /// The effects that replace those of the camera.
    pub fn effects(&self) -> &[Box<dyn AnyEffect>] {
        self.running
            .as_ref()
            .map_or(&[], |running| &running.effects)
    }

    /// Notes the target of the camera. If it had another one, its flashes count on both.
    fn follow(&mut self, target: Option<&NormalizedRenderTarget>, past: &mut PastFlashes) {
        if self.target.as_ref() != target {
            past.keep(self.target.as_ref(), &self.flashes);
            self.target = target.cloned();
        }
    }

    /// Starts an impact, unless it would exceed the limit of flashes. `others`: flashes of other
    /// cameras of the same target in the last second. `now`: real time.
    fn start(&mut self, impact: Impact, others: usize, now: f64) -> bool {
        let flashes = impact.flashes();
        if self.flashes.recent(now) + others + flashes > Impact::MOST_FLASHES {
            return false;
        }
        self.flashes.announce(flashes, now);
        self.running = Some(Running {
            impact,
            since: None,
            effects: Vec::new(),
        });
        true
    }

    /// Draws the impact at a time, or ends it. `waits`: its pipeline is compiling.
    fn run(&mut self, now: Moment, waits: bool, reduced: bool) {
        let Some(running) = &mut self.running else {
            return;
        };
        let since = match running.since {
            Some(since) if !waits => since,
            _ => *running.since.insert(now.game),
        };
        let drawing = clock::drawing(now.game - since, running.impact.rate);
        let ends = drawing >= u64::from(running.impact.drawings);
        // The picture changes with each drawing, and two changes are a flash.
        let begun = match drawing {
            _ if waits => 0,
            0 | 1 if !ends => 1,
            _ => running.impact.flashes(),
        };
        self.flashes.show(begun, now.real);
        if ends {
            self.running = None;
        } else {
            running.effects = running.impact.effects(drawing as u32, reduced);
        }
    }
}

/// The targets of cameras, to be compared.
#[derive(SystemParam)]
pub(super) struct Targets<'w, 's> {
    primary: Query<'w, 's, Entity, With<PrimaryWindow>>,
}

impl Targets<'_, '_> {
    /// The target of a camera. Without a primary window, a stand-in is one.
    fn of(&self, target: Option<&RenderTarget>) -> Option<NormalizedRenderTarget> {
        let primary = self.primary.iter().next().unwrap_or(Entity::PLACEHOLDER);
        target?.normalize(Some(primary))
    }
}

/// Starts an impact, or counts that it was refused.
pub(super) fn start_impact(
    impact: On<Impact>,
    mut cameras: Query<(Entity, Option<&RenderTarget>, Option<&mut Impacts>), With<Camera>>,
    (mut past, targets): (ResMut<PastFlashes>, Targets),
    mut commands: Commands,
    clocks: Clocks,
    mut diagnostics: ResMut<ComicsDiagnostics>,
) {
    let camera = impact.entity;
    let now = clocks.now().real;
    let impact = impact.event().clone().sanitized();
    let Ok((_, target, _)) = cameras.get(camera) else {
        warn_once!("Impact: {camera} is not a camera");
        return;
    };
    let target = targets.of(target);
    for (_, at, impacts) in &mut cameras {
        if let Some(mut impacts) = impacts {
            impacts.follow(targets.of(at).as_ref(), &mut past);
        }
    }
    let others = cameras
        .iter()
        .filter(|(other, at, _)| *other != camera && targets.of(*at) == target)
        .filter_map(|(.., impacts)| impacts);
    let others: usize = others.map(|impacts| impacts.flashes.recent(now)).sum();
    let others = others + past.recent(target.as_ref(), now);
    let shown = if let Ok((.., Some(mut impacts))) = cameras.get_mut(camera) {
        impacts.start(impact, others, now)
    } else {
        let mut impacts = Impacts {
            target,
            ..Impacts::default()
        };
        let shown = impacts.start(impact, others, now);
        commands.entity(camera).insert(impacts);
        shown
    };
    let count = diagnostics.impacts.entry(camera).or_default();
    if shown {
        count.shown += 1;
    } else {
        count.refused += 1;
        debug!(
            "Impact: the target of {camera} had {} flashes in the last second",
            Impact::MOST_FLASHES
        );
    }
}

/// Keeps the flashes of a camera that is despawned.
pub(super) fn keep_flashes(
    removed: On<Remove, Impacts>,
    cameras: Query<&Impacts>,
    mut past: ResMut<PastFlashes>,
) {
    if let Ok(impacts) = cameras.get(removed.entity) {
        past.keep(impacts.target.as_ref(), &impacts.flashes);
    }
}

pub(super) fn run_impacts(
    mut cameras: Query<(Entity, Option<&RenderTarget>, &mut Impacts)>,
    (mut past, targets): (ResMut<PastFlashes>, Targets),
    clocks: Clocks,
    reduced: Res<ReduceFlashing>,
    diagnostics: Res<ComicsDiagnostics>,
) {
    let now = clocks.now();
    for (camera, target, mut impacts) in &mut cameras {
        impacts.follow(targets.of(target).as_ref(), &mut past);
        if impacts.running.is_some() {
            let waits = diagnostics.is_compiling(camera);
            impacts.run(now, waits, reduced.0);
        }
    }
}

#[cfg(test)]
mod tests;
