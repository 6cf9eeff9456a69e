//! From one style to another over time.

use bevy::prelude::*;

use super::{Comic, ComicStyle, layer::own_style};
use crate::{diagnostics::ComicsDiagnostics, effect::EffectRegistry};

/// Carries a camera from the style that it has to another one, over time.
///
/// It starts from what the camera's components are when this one is added, even in the middle of
/// another transition. In between, the camera has the [`ComicStyle::blend`] of both styles, which
/// is continuous: modes change where their effect has no strength. At the end the camera has
/// exactly the other style, this component is removed, and [`StyleTransitionFinished`] is triggered
/// on the camera.
///
/// It runs on the default [`Time`], so that a paused game pauses it, unless it runs [in real
/// time](Self::in_real_time). Its clock stands still while pipelines compile that the camera needs
/// for the first time. Styles that the game puts on the camera in the meantime are overwritten.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::{StyleTransition, presets};
/// fn hit(mut commands: Commands, camera: Single<Entity, With<Camera3d>>) {
///     let style = presets::CRIMSON_DUSK.style();
///     commands.entity(*camera).insert(StyleTransition::to(style, 0.4));
/// }
/// ```
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Clone, PartialEq)]
pub struct StyleTransition {
    target: StyleTarget,
    seconds: f32,
    easing: TransitionEasing,
    real_time: bool,
    start: Option<Start>,
    elapsed: f32,
}

/// How the camera looked when a transition began.
#[derive(Reflect, Clone, Debug, PartialEq)]
struct Start {
    /// All of it.
    look: ComicStyle,
    /// Without the style that was applied.
    own: ComicStyle,
}

#[allow(
    clippy::large_enum_variant,
    reason = "there is one on a camera, and a box is not reflected"
)]
#[derive(Reflect, Clone, Debug, PartialEq)]
enum StyleTarget {
    Style(ComicStyle),
    Asset(Handle<ComicStyle>),
}

/// How a transition moves.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum TransitionEasing {
    /// With the same speed all the way.
    Linear,
    /// Slow at both ends.
    #[default]
    Smooth,
}

/// A [`StyleTransition`] has arrived.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
pub struct StyleTransitionFinished {
    /// The camera.
    pub entity: Entity,
}

impl StyleTransition {
    /// To a style, in so many seconds; 0, or what is not a positive number, is
    /// at once. The camera's [`Comic`], if it has one, is emptied, so
    /// later changes of that file have no effect. Without one, the `camera` and the `scene` of the
    /// style have none either.
    pub fn to(style: ComicStyle, seconds: f32) -> Self {
        Self::new(StyleTarget::Style(style), seconds)
    }

    /// To the style of an asset, which the camera keeps as its
    /// [`Comic`]. Starts when the asset has loaded; an asset that
    /// fails to load ends it where it is, with a warning.
    pub fn to_asset(style: Handle<ComicStyle>, seconds: f32) -> Self {
        Self::new(StyleTarget::Asset(style), seconds)
    }

    fn new(target: StyleTarget, seconds: f32) -> Self {
        Self {
            target,
            seconds,
            easing: TransitionEasing::default(),
            real_time: false,
            start: None,
            elapsed: 0.0,
        }
    }

    /// The same transition with another easing.
    #[must_use]
    pub fn with_easing(self, easing: TransitionEasing) -> Self {
        Self { easing, ..self }
    }

    /// The same transition, on [`Time<Real>`](bevy::time::Real): it continues while the game is paused, or in slow
    /// motion. For pause menus, for example.
    #[must_use]
    pub fn in_real_time(self) -> Self {
        Self {
            real_time: true,
            ..self
        }
    }

    /// The asset that it goes to, if it goes to one.
    pub(super) fn asset(&self) -> Option<&Handle<ComicStyle>> {
        match &self.target {
            StyleTarget::Style(_) => None,
            StyleTarget::Asset(handle) => Some(handle),
        }
    }

    /// How much of the time has passed, 0 to 1.
    pub fn progress(&self) -> f32 {
        if self.seconds > 0.0 {
            (self.elapsed / self.seconds).clamp(0.0, 1.0)
        } else {
            1.0
        }
    }

    /// How far the transition has come, 0 to 1.
    fn fraction(&self) -> f32 {
        let curve = match self.easing {
            TransitionEasing::Linear => EaseFunction::Linear,
            TransitionEasing::Smooth => EaseFunction::SmoothStep,
        };
        EasingCurve::new(0.0, 1.0, curve).sample_clamped(self.progress())
    }
}

pub(super) fn run_transitions(
    mut commands: Commands,
    mut cameras: Query<(Entity, &mut StyleTransition, Has<Comic>)>,
    styles: Option<Res<Assets<ComicStyle>>>,
    assets: Option<Res<AssetServer>>,
    diagnostics: Res<ComicsDiagnostics>,
    (time, real_time): (Option<Res<Time>>, Option<Res<Time<Real>>>),
) {
    let game = time.map_or(0.0, |time| time.delta_secs());
    let real = real_time.map_or(0.0, |time| time.delta_secs());
    for (entity, mut transition, has_handle) in &mut cameras {
        let Ok(mut camera) = commands.get_entity(entity) else {
            continue;
        };
        let target = match &transition.target {
            StyleTarget::Style(style) => Some(style),
            StyleTarget::Asset(handle) => {
                let failed = assets
                    .as_ref()
                    .is_some_and(|assets| assets.load_state(handle).is_failed());
                if failed {
                    warn!("{entity} keeps its style: the style of its transition failed to load");
                    camera.remove::<StyleTransition>();
                    continue;
                }
                styles.as_ref().and_then(|styles| styles.get(handle))
            }
        };
        let Some(target) = target.cloned() else {
            continue;
        };
        if transition.start.is_none() {
            camera.queue(remember_start);
            if matches!(transition.target, StyleTarget::Style(_)) {
                // Removing the handle would also remove the style.
                camera.insert_if(Comic::default(), || has_handle);
            }
        } else if !diagnostics.is_compiling(entity) {
            transition.elapsed += if transition.real_time { real } else { game };
        }
        if transition.progress() >= 1.0 {
            if let StyleTarget::Asset(handle) = &transition.target {
                camera.insert(Comic(handle.clone()));
            }
            target.apply(&mut camera);
            camera.remove::<StyleTransition>();
            commands.trigger(StyleTransitionFinished { entity });
        } else if let Some(start) = &transition.start {
            let target = target.over(&start.own);
            start
                .look
                .blend(&target, transition.fraction())
                .apply(&mut camera);
        }
    }
}

/// Remembers the style from which the camera's transition starts.
fn remember_start(mut camera: EntityWorldMut) {
    let Some(registry) = camera.world().get_resource::<EffectRegistry>().cloned() else {
        return;
    };
    let look = ComicStyle::of(EntityRef::from(&camera), &registry);
    let own = own_style(&camera);
    if let Some(mut transition) = camera.get_mut::<StyleTransition>() {
        transition.start = Some(Start { look, own });
    }
}
