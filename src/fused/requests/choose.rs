//! Chooses the plan that every view draws in this frame: the requested one, or the
//! last complete one while a pipeline of the requested one compiles. Then the
//! services receive their requests, once.

use crate::effect::EffectRegistry;
use std::sync::Arc;

use bevy::{
    camera::MainPassResolutionOverride,
    prelude::*,
    render::{
        camera::{ExtractedCamera, TemporalJitter},
        render_resource::PipelineCache,
        view::{ExtractedView, ViewTarget},
    },
};

use super::{
    Services,
    scene::{Scene, SceneTextures},
};
use crate::{
    depth::{
        passes::{RangePasses, TonePasses},
        prepare::ViewDepthRange,
        request::RangeRequest,
    },
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    fused::{Plan, ViewPlan, pass::prepare::FusedRequest},
    lines::{LinePasses, LineRequest, ViewHighlights},
    objects::{DepthWanted, IdRequest, IdsWanted},
    tones::TonesRequest,
};

/// On a view that a plan was chosen for: the last plan whose pipelines were all
/// compiled, if there was one.
#[derive(Component)]
pub(crate) struct ReadyPlan(Option<Arc<Plan>>);

/// All components that a choice puts on a view.
type Chosen = (
    (RangeRequest, RangePasses),
    (LineRequest, LinePasses),
    (IdRequest, IdsWanted, DepthWanted),
    (FusedRequest, ReadyPlan),
    (TonesRequest, TonePasses),
);

/// A view that no longer has a plan or an extracted camera.
type NotDrawn = Or<(Without<ViewPlan>, Without<ExtractedCamera>)>;

pub(crate) fn choose_plans(
    mut commands: Commands,
    views: Query<(
        Entity,
        &ViewPlan,
        &ExtractedCamera,
        &ExtractedView,
        SceneTextures<'_>,
        (Option<&ViewTarget>, Option<&ReadyPlan>),
        (Option<&MainPassResolutionOverride>, Option<&TemporalJitter>),
        Option<&ViewHighlights>,
    )>,
    stale: Query<(Entity, Option<&ViewHighlights>), (With<ReadyPlan>, NotDrawn)>,
    // Those of the last frame.
    ranges: Query<&ViewDepthRange>,
    (ledger, registry): (Res<StageLedger>, Res<EffectRegistry>),
    mut services: Services,
    mut cache: ResMut<PipelineCache>,
) {
    for (entity, highlights) in &stale {
        remove(entity, highlights, &mut commands);
    }
    for (entity, view, camera, extracted, prepass, (target, ready), raster, highlights) in &views {
        if target.is_none() || extracted.viewport.z == 0 || extracted.viewport.w == 0 {
            remove(entity, highlights, &mut commands);
            continue;
        }
        let has_range = |leader: &Entity| ranges.iter().any(|r| r.request.camera == *leader);
        let scene = Scene {
            leader: view.plan.range_of.filter(has_range),
            ..Scene::new(extracted, prepass, raster)
        };
        let wanted = scene.reduce(&view.plan);
        report(&ledger, &registry, (view, &wanted), &scene);

        // Drawn instead while a pipeline of the wanted plan compiles.
        let last = ready
            .and_then(|ready| ready.0.as_ref())
            .map(|ready| scene.reduce(ready));
        let last = last.filter(|last| *last != wanted);
        let mut requests = services.requests(&cache, (&wanted, view), &scene, (extracted, camera));
        // If the engine compiles pipelines synchronously, this compiles them now.
        if requests.is_compiling(&cache) {
            cache.process_queue();
        }
        let compiling = requests.is_compiling(&cache);
        if compiling {
            ledger.set_compiling(view.camera);
            if ready.is_none() {
                commands.entity(entity).insert(ReadyPlan(None));
            }
            if let Some(last) = &last {
                requests = services.requests(&cache, (last, view), &scene, (extracted, camera));
            }
        } else {
            ledger.set_drawn(view.camera, view.number);
            let known = ready.and_then(|ready| ready.0.as_ref());
            if !known.is_some_and(|known| Arc::ptr_eq(known, &wanted)) {
                commands
                    .entity(entity)
                    .insert(ReadyPlan(Some(wanted.clone())));
            }
        }
        requests.put(
            entity,
            highlights.map(|highlights| highlights.layer),
            &mut commands,
        );
    }
}

/// Removes what a choice has put on a view.
fn remove(view: Entity, highlights: Option<&ViewHighlights>, commands: &mut Commands) {
    commands.entity(view).remove::<Chosen>();
    #[cfg(feature = "objects")]
    super::highlights::remove_highlights(
        view,
        highlights.map(|highlights| highlights.layer),
        commands,
    );
    #[cfg(not(feature = "objects"))]
    let _ = highlights;
}

/// Reports for every stage why it does not run. Stages that run overwrite this
/// later in the frame.
fn report(
    ledger: &StageLedger,
    registry: &EffectRegistry,
    (view, reduced): (&ViewPlan, &Plan),
    scene: &Scene,
) {
    let wanted = &view.plan;
    let camera = view.camera;
    let missing = StageOutcome::Skipped(SkipReason::NoDepthPrepass);
    let lacks_depth = wanted.needs_depth() && scene.depth.is_none();
    if lacks_depth {
        warn_once!(
            "camera {camera} has no depth prepass: its effects that read depth are left out"
        );
    }
    for stage in ComicsStage::SERVICES.iter().copied() {
        let lost = lacks_depth
            && match stage {
                ComicsStage::DepthPrepass => true,
                ComicsStage::DepthRange => wanted.needs_range(),
                ComicsStage::RangeSmoothing => wanted.smooths(),
                ComicsStage::RangeReadback => wanted.readback,
                _ => false,
            };
        let outcome = if lost {
            missing
        } else {
            StageOutcome::Skipped(wanted.reason(stage))
        };
        ledger.set(camera, stage, outcome);
    }
    for (stage, reason) in reduced.effect_stages(&registry.types()) {
        // Drawn effects run in the fused pass, which overwrites this reason.
        let reason = reason.unwrap_or(SkipReason::PipelineNotReady);
        ledger.set(camera, stage, StageOutcome::Skipped(reason));
    }
    let nothing = StageOutcome::Skipped(SkipReason::NothingToDraw);
    ledger.set(camera, ComicsStage::Stylize, nothing);
    if scene.depth.is_some() {
        ledger.set(camera, ComicsStage::DepthPrepass, StageOutcome::Ran);
    }
    if scene.normals {
        ledger.set(camera, ComicsStage::NormalPrepass, StageOutcome::Ran);
    }
}
