//! Copies the plans of active cameras to the render world.

use bevy::{
    ecs::entity::EntityHashSet,
    prelude::*,
    render::{Extract, sync_world::RenderEntity},
};

use super::{CameraPlan, fog::Fogs, light::Lights};
#[cfg(feature = "objects")]
use crate::{
    composite::BeyondPrepass,
    objects::{
        BackdropBoxes, Backdrops, DepthWrites, FadingMeshes, LevelPlaces, Levels, nearest_backdrop,
    },
};
use crate::{
    depth::{frame::DepthProjection, smoothing::CameraCuts},
    effect::EffectTarget,
    fused::{Plan, ViewPlan, set_or_remove},
    objects::{DepthWanted, IdsWanted, ObjectStyles},
    origin::WorldOrigin,
    page::{LengthScale, PageHeight, PageScale},
};

pub(super) fn extract_views(
    mut commands: Commands,
    cameras: Extract<
        Query<
            (
                Entity,
                RenderEntity,
                &Camera,
                &CameraPlan,
                Option<&Projection>,
                (Option<&CameraCuts>, Option<&EffectTarget>),
                Option<&PageHeight>,
            ),
            With<Camera3d>,
        >,
    >,
    (time, real_time): (Extract<Option<Res<Time>>>, Extract<Option<Res<Time<Real>>>>),
    (objects, lights, fogs, places, origin, players): (
        Extract<Res<ObjectStyles>>,
        Extract<Lights>,
        Extract<Fogs>,
        Extract<Query<&GlobalTransform>>,
        Extract<Option<Res<WorldOrigin>>>,
        Extract<Res<PageScale>>,
    ),
    #[cfg(feature = "objects")] (backdrops, boxes): (
        Extract<Res<Backdrops>>,
        Extract<BackdropBoxes>,
    ),
    #[cfg(feature = "objects")] (writes, levels, level_places): (
        Extract<Res<DepthWrites>>,
        Extract<Res<Levels>>,
        Extract<LevelPlaces>,
    ),
    stale: Query<Entity, With<ViewPlan>>,
    mut seen: Local<EntityHashSet>,
) {
    seen.clear();
    let to_light = lights.to_light();
    let origin = WorldOrigin::of(origin.as_deref());
    for (entity, render_entity, camera, asked, projection, (cuts, target), page) in &cameras {
        if !camera.is_active {
            continue;
        }
        let scale = LengthScale::new(camera, page, **players);
        let clip_from_view = camera.clip_from_view();
        seen.insert(render_entity);
        let mut view = commands.entity(render_entity);
        #[cfg(feature = "objects")]
        fade_levels(
            &mut view,
            &asked.plan,
            (&levels, &level_places),
            places.get(entity).ok(),
        );
        // For as long as a mesh may fade: its coming and going would queue all meshes anew.
        #[cfg(feature = "objects")]
        let writes = asked.plan.objects.fades || !writes.0.is_empty();
        #[cfg(not(feature = "objects"))]
        let writes = false;
        want_objects(&mut view, (entity, &asked.plan), writes);
        view.insert(ViewPlan {
            camera: entity,
            plan: asked.plan.clone(),
            number: asked.number,
            projection: DepthProjection::new(&clip_from_view, projection),
            clip_from_view,
            origin,
            scale_factor: scale.factor,
            has_page: scale.has_page,
            widest_object: objects.max_width(),
            to_light,
            fog: fogs.of(entity),
            target: target.and_then(|target| position_of(target, &places)),
            time: time.as_ref().map_or(0.0, |time| time.elapsed_secs_f64()),
            seconds: real_time.as_ref().map_or(0.0, |time| time.delta_secs()),
            #[cfg(feature = "objects")]
            backdrop: (places.get(entity).ok())
                .filter(|_| asked.plan.beyond != BeyondPrepass::Styled)
                .and_then(|at| nearest_backdrop(&backdrops, &boxes, (at, &clip_from_view))),
            #[cfg(not(feature = "objects"))]
            backdrop: None,
            cuts: cuts.map_or(0, |cuts| cuts.0),
        });
    }
    for entity in &stale {
        if !seen.contains(&entity) {
            commands
                .entity(entity)
                .remove::<(ViewPlan, IdsWanted, DepthWanted)>();
        }
    }
}

/// Notes the meshes that fade in a view.
#[cfg(feature = "objects")]
fn fade_levels(
    view: &mut EntityCommands,
    plan: &Plan,
    (levels, places): (&Levels, &LevelPlaces),
    at: Option<&GlobalTransform>,
) {
    let fading = at
        .filter(|_| plan.objects.fades && plan.needs_depth())
        .map(|at| levels.fading(at.translation(), places))
        .filter(|fading| !fading.meshes.is_empty());
    set_or_remove::<FadingMeshes>(view, fading);
}

/// The world position that effects point at.
fn position_of(target: &EffectTarget, places: &Query<&GlobalTransform>) -> Option<Vec3> {
    let place = places.get(target.entity).ok()?;
    Some(place.transform_point(target.offset))
}

/// Says what the pass of objects draws. During extraction, so that meshes are queued in the
/// first frame that reads it: plans are chosen only after queueing.
fn want_objects(view: &mut EntityCommands, (camera, plan): (Entity, &Plan), writes: bool) {
    let wanted = IdsWanted {
        ids: plan.draws_ids(),
        layer: plan.objects.highlights,
        widths: plan.draws_widths(),
    };
    set_or_remove(view, (wanted.ids || wanted.layer).then_some(wanted));
    let can_write = plan.has_ids() && !plan.lacks.depth_copies;
    let writes = writes && can_write && plan.needs_depth();
    let depth = DepthWanted {
        camera,
        normals: plan.needs_normals(),
    };
    set_or_remove(view, writes.then_some(depth));
}
