//! What moves in steps, as drawings do: impacts and stepped animation.

mod flashes;
mod impact;
#[cfg(any(feature = "objects", feature = "toon"))]
mod stepped_animation;

use bevy::app::{App, Last, Plugin};
use bevy::ecs::schedule::IntoScheduleConfigs;
#[cfg(any(feature = "objects", feature = "toon"))]
use bevy::render::RenderApp;

use crate::schedule::{ComicsSystems, RunImpacts};
use flashes::PastFlashes;
pub(crate) use impact::Impacts;

pub use impact::{Impact, ReduceFlashing};
use impact::{keep_flashes, run_impacts, start_impact};
#[cfg(any(feature = "objects", feature = "toon"))]
pub use stepped_animation::SteppedAnimation;

pub(crate) struct AnimationPlugin;

impl Plugin for AnimationPlugin {
    fn build(&self, app: &mut App) {
        #[cfg(any(feature = "objects", feature = "toon"))]
        app.register_type::<SteppedAnimation>();
        app.register_type::<Impact>()
            .register_type::<ReduceFlashing>()
            .init_resource::<ReduceFlashing>()
            .init_resource::<PastFlashes>()
            .add_observer(start_impact)
            .add_observer(keep_flashes)
            .add_systems(
                Last,
                run_impacts.in_set(ComicsSystems::Plan).in_set(RunImpacts),
            );
    }
}

#[cfg(any(feature = "objects", feature = "toon"))]
impl AnimationPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            stepped_animation::hold_while_extracting(render_app);
        }
    }
}
