//! A camera in the main world: its plan, the prepasses that the plan reads, and the extraction to
//! the render world.

mod extract;
mod fog;
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
    animation::Impacts,
    depth::MaterialsReadRange,
    effect::EffectRegistry,
    fused::{DeviceLacks, Plan},
    objects::{ObjectChanges, ObjectStyles},
    schedule::{ComicsSystems, RunImpacts},
};
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
pub(crate) struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<KeyLight>()
            .add_observer(give_up_claims::<DepthPrepass>)
            .add_observer(give_up_claims::<NormalPrepass>)
            .add_systems(
                // After the systems that change a camera's components.
                Last,
                (
                    (
                        plan_cameras.after(RunImpacts),
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

impl CameraPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(ExtractSchedule, extract::extract_views);
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
