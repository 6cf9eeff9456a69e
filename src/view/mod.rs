//! A camera in the main world: its plan, the prepasses that the plan reads, and the
//! extraction to the render world.

mod extract;
mod flashes;
mod fog;
#[cfg(any(feature = "objects", feature = "cartoon"))]
mod held_pose;
mod impact;
mod light;
mod prepasses;

use std::sync::Arc;

use bevy::{
    app::{App, Last, Plugin},
    camera::{Camera2d, Camera3d, RenderTarget},
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    ecs::{
        component::Component,
        query::With,
        schedule::IntoScheduleConfigs,
        system::{Commands, Query, Res},
        world::EntityRef,
    },
    log::warn_once,
    render::{
        ExtractSchedule, RenderApp,
        renderer::{RenderAdapterInfo, RenderDevice},
    },
};

use crate::{
    depth::MaterialsReadRange,
    effect::{DeviceLacks, EffectRegistry, Plan},
    objects::{ObjectChanges, ObjectStyles},
    schedule::ComicsSystems,
};
use flashes::PastFlashes;
#[cfg(any(feature = "objects", feature = "cartoon"))]
pub use held_pose::HeldPose;
pub use impact::{Impact, ReduceFlashing};
use impact::{Impacts, keep_flashes, run_impacts, start_impact};
pub use light::KeyLight;
use prepasses::{give_up_claims, read_drawn_depth, request_prepasses};

/// On a camera in the main world: what it draws, planned from its components.
#[derive(Component, Clone, Debug)]
struct CameraPlan {
    plan: Arc<Plan>,
    /// Increases with every change of the plan.
    number: u64,
}

/// Plans what every camera draws, and extracts the plans to the render world.
pub(crate) struct ViewPlugin;

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        #[cfg(any(feature = "objects", feature = "cartoon"))]
        app.register_type::<HeldPose>();
        app.register_type::<KeyLight>()
            .register_type::<Impact>()
            .register_type::<ReduceFlashing>()
            .init_resource::<ReduceFlashing>()
            .init_resource::<PastFlashes>()
            .add_observer(start_impact)
            .add_observer(keep_flashes)
            .add_observer(give_up_claims::<DepthPrepass>)
            .add_observer(give_up_claims::<NormalPrepass>)
            .add_systems(
                // After the systems that change a camera's components.
                Last,
                (
                    (
                        run_impacts,
                        plan_cameras,
                        request_prepasses,
                        read_drawn_depth,
                    )
                        .chain()
                        .in_set(ComicsSystems::Plan),
                    warn_unsupported,
                ),
            );
    }
}

impl ViewPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(ExtractSchedule, extract::extract_views);
            #[cfg(any(feature = "objects", feature = "cartoon"))]
            held_pose::hold_while_extracting(render_app);
        }
    }
}

fn plan_cameras(
    mut commands: Commands,
    cameras: Query<EntityRef, With<Camera3d>>,
    registry: Res<EffectRegistry>,
    objects: Res<ObjectStyles>,
    materials: Res<MaterialsReadRange>,
    (device, adapter): (Option<Res<RenderDevice>>, Option<Res<RenderAdapterInfo>>),
) {
    let lacks = (device.zip(adapter)).map_or_else(DeviceLacks::default, |(device, adapter)| {
        DeviceLacks::new(&device.limits(), &adapter)
    });
    let types = registry.types();
    for camera in &cameras {
        let known = camera.get::<CameraPlan>();
        let mut entity = commands.entity(camera.id());
        let shown = camera.get::<Impacts>().map_or(&[][..], Impacts::effects);
        let mut plan =
            Plan::new(camera, shown, &types, objects.changes()).map(|plan| plan.on_device(lacks));
        if let Some(plan) = &mut plan {
            lacks.warn();
            plan.materials = materials.0;
        }
        match (plan, known) {
            (Some(plan), Some(known)) if *known.plan == plan => {}
            (Some(plan), known) => {
                entity.insert(CameraPlan {
                    plan: Arc::new(plan),
                    number: known.map_or(1, |known| known.number + 1),
                });
            }
            (None, Some(_)) => {
                entity.remove::<CameraPlan>();
            }
            (None, None) => {}
        }
    }
}

/// Warns once about cameras with effects that this crate cannot draw on.
fn warn_unsupported(
    flat: Query<EntityRef, With<Camera2d>>,
    targets: Query<(bevy::ecs::entity::Entity, &RenderTarget), With<CameraPlan>>,
    registry: Res<EffectRegistry>,
) {
    let types = registry.types();
    for camera in &flat {
        if Plan::new(camera, &[], &types, ObjectChanges::default()).is_some() {
            warn_once!(
                "{} is a Camera2d: its effects are not drawn, they need a Camera3d",
                camera.id()
            );
        }
    }
    for (camera, target) in &targets {
        if matches!(target, RenderTarget::None { .. }) {
            warn_once!("{camera} has no colour target: its effects are not drawn");
        }
    }
}
