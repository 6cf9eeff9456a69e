//! A camera in the main world: its plan, the prepasses that the plan reads, and the extraction to
//! the render world.

mod extract;
mod fog;
mod light;
#[cfg(any(feature = "objects", feature = "toon"))]
mod mirror;
mod overlay;
mod prepasses;
mod range_of;
mod shared;
mod warnings;

use std::sync::Arc;

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    ecs::entity::EntityHashMap,
    prelude::*,
    render::{
        RenderApp,
        renderer::{RenderAdapterInfo, RenderDevice},
    },
    window::PrimaryWindow,
};

use crate::{
    animation::Impacts,
    depth::MaterialsReadRange,
    effect::EffectRegistry,
    fused::{DeviceLacks, Plan},
    objects::ObjectStyles,
    origin::WorldOrigin,
    page::{PageHeight, PageScale},
    schedule::{ComicsSystems, RunImpacts},
};
#[cfg(feature = "objects")]
use crate::{lines::Outlines, objects::AllMeshes, schedule::DivideMeshes};
pub use light::KeyLight;
pub use overlay::{ComicOverlay, overlay_camera};
use prepasses::{give_up_claims, read_drawn_depth, request_prepasses};
pub use range_of::RangeOf;
use shared::{Styled, own_pixels};
use warnings::{warn_of_pairs, warn_unsupported};

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
        overlay::build(app);
        app.register_type::<KeyLight>()
            .register_type::<RangeOf>()
            .register_type::<WorldOrigin>()
            .register_type::<PageHeight>()
            .register_type::<PageScale>()
            .init_resource::<PageScale>()
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
                    (warn_unsupported, warn_of_pairs),
                ),
            );
        #[cfg(feature = "objects")]
        app.add_systems(PostUpdate, ask_for_edges.before(DivideMeshes));
    }
}

impl CameraPlugin {
    /// The part that needs the engine's renderer.
    pub(crate) fn build_render(app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(ExtractSchedule, extract::extract_views);
        }
        #[cfg(any(feature = "objects", feature = "toon"))]
        mirror::build_render(app);
    }
}

/// Notes whether some camera asks for the edges of all meshes: by its `Outlines`, even while they are
/// faded out, or by another effect that had lines in the last frame.
#[cfg(feature = "objects")]
fn ask_for_edges(
    cameras: Query<(Option<&Outlines>, Option<&CameraPlan>), With<Camera3d>>,
    mut all: ResMut<AllMeshes>,
) {
    let asks = |(outlines, planned): (Option<&Outlines>, Option<&CameraPlan>)| {
        let drawn = planned.and_then(|camera| camera.plan.lines);
        outlines.is_some_and(Outlines::divides_meshes)
            || drawn.is_some_and(|lines| lines.divides_meshes())
    };
    all.set_if_neq(AllMeshes(cameras.iter().any(asks)));
}

fn plan_cameras(
    mut commands: Commands,
    cameras: Query<EntityRef, With<Camera3d>>,
    registry: Res<EffectRegistry>,
    objects: Res<ObjectStyles>,
    (materials, origin): (Res<MaterialsReadRange>, Option<Res<WorldOrigin>>),
    (device, adapter): (Option<Res<RenderDevice>>, Option<Res<RenderAdapterInfo>>),
    primary_window: Query<Entity, With<PrimaryWindow>>,
) {
    let lacks = (device.zip(adapter)).map_or_else(DeviceLacks::default, |(device, adapter)| {
        DeviceLacks::new(&device, &adapter)
    });
    let types = registry.types();
    let plan = |camera: EntityRef| {
        let shown = camera.get::<Impacts>().map_or(&[][..], Impacts::effects);
        let mut plan = Plan::new(camera, shown, &types, objects.changes())?;
        plan.materials = materials.0;
        lacks.warn();
        Some(plan.on_device(lacks))
    };
    let planned = cameras.iter().map(|camera| (camera.id(), plan(camera)));
    let planned: Vec<_> = planned.collect();
    let primary_window = primary_window.single().ok();
    let styled = planned.iter().filter_map(|(camera, plan)| {
        let plan = plan.as_ref().filter(|plan| plan.draws());
        plan.and_then(|_| Styled::new(cameras.get(*camera).ok()?, primary_window))
    });
    let styled: Vec<_> = styled.collect();
    let leaders = leaders(&planned, &cameras);
    for (camera, mut plan) in planned {
        let Ok(camera) = cameras.get(camera) else {
            continue;
        };
        let known = camera.get::<CameraPlan>();
        let mut entity = commands.entity(camera.id());
        if let Some(plan) = &mut plan {
            plan.range_of = leaders.get(&camera.id()).copied();
            plan.lends = leaders.values().any(|leader| *leader == camera.id());
            plan.has_origin = origin.is_some();
            plan.own_pixels = own_pixels(camera, plan, &styled);
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

/// The cameras whose visible ranges others take.
fn leaders(
    planned: &[(Entity, Option<Plan>)],
    cameras: &Query<EntityRef, With<Camera3d>>,
) -> EntityHashMap<Entity> {
    let has_plan = |camera| {
        planned
            .iter()
            .any(|(known, plan)| *known == camera && plan.is_some())
    };
    let leader = |(camera, plan): &(Entity, Option<Plan>)| {
        plan.as_ref().filter(|plan| plan.reads_range())?;
        let leader = range_of::leader(cameras.get(*camera).ok()?, cameras, has_plan)?;
        Some((*camera, leader))
    };
    planned.iter().filter_map(leader).collect()
}
