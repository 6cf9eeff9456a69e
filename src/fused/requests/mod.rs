//! Turns the plan of a view into requests to the services.

pub(super) mod choose;
mod compiling;
mod context;
#[cfg(feature = "objects")]
mod highlights;
mod lines;
mod scene;

use std::sync::Arc;

use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    render::{
        camera::ExtractedCamera,
        render_resource::{CachedRenderPipelineId, PipelineCache, SpecializedRenderPipelines},
        view::ExtractedView,
    },
};

#[cfg(feature = "objects")]
use self::highlights::{HighlightPipelines, HighlightRequests, remove_highlights};
use self::{
    compiling::{are_compiling, is_compiling},
    context::effect_context,
    lines::{line_reach, line_request, map_jumps},
    scene::Scene,
};
use super::{
    Plan, ViewPlan,
    key::{KeyInputs, StylizeKey, drawn_area::DrawnArea},
    pass::{
        StylizePipeline,
        prepare::{EarlierPassRequest, FusedRequest, TexturePass},
    },
    plan::passes::{Reads, passes},
};
use crate::{
    depth::{
        ProjectionKind, RawDepth,
        passes::{RangePasses, RangePipelines, Reduction, TonePasses},
        request::RangeRequest,
        view::ViewUniform,
    },
    effect::{AffectedArea, AnyEffect, EffectContext, Needs},
    lines::{LineLayers, LinePasses, LinePipelines, LineRequest},
    objects::{IdRequest, ObjectDepthRequest, ObjectEye},
    tones::TonesRequest,
};

/// The requests of one plan to the services, for one view, and their pipelines.
pub(super) struct Requests {
    range: Option<(RangeRequest, RangePasses)>,
    lines: Option<(LineRequest, LinePasses)>,
    ids: Option<IdRequest>,
    object_depths: Option<ObjectDepthRequest>,
    tones: Option<(TonesRequest, TonePasses)>,
    #[cfg(feature = "objects")]
    highlights: Option<HighlightRequests>,
    fused: Option<FusedRequest>,
}

/// Creates requests from plans.
#[derive(SystemParam)]
pub(crate) struct Services<'w> {
    ranges: RangePipelines<'w>,
    lines: LinePipelines<'w>,
    stylize: ResMut<'w, SpecializedRenderPipelines<StylizePipeline>>,
    stylize_pipeline: Res<'w, StylizePipeline>,
    #[cfg(feature = "objects")]
    highlights: HighlightPipelines<'w>,
}

impl Services<'_> {
    pub fn requests(
        &mut self,
        cache: &PipelineCache,
        (plan, view): (&Arc<Plan>, &ViewPlan),
        scene: &Scene,
        (extracted, camera): (&ExtractedView, &ExtractedCamera),
    ) -> Requests {
        let uniform = view_uniform(view, plan, scene);
        let context = effect_context(view, plan, scene.viewport, (extracted, camera));
        let jumps = map_jumps(plan, scene, &context);
        let object_depths = object_depths((plan, view), &context, uniform, extracted);
        let lines = line_request(view, (plan, &context), scene, (uniform, jumps)).map(|request| {
            let passes = self.lines.get(cache, &request);
            (request, passes)
        });
        let fused = plan.draws().then(|| {
            let inputs = KeyInputs {
                format: extracted.target_format,
                space: camera.compositing_space,
                samples: scene.depth.map(|(_, samples)| samples),
                oblique: view.projection.kind() == ProjectionKind::Oblique,
                view: uniform,
                widest_object: view.widest_object,
            };
            self.fused(cache, (plan, view.camera, context), &inputs, lines.as_ref())
        });
        let range = range_request(view, plan, scene).map(|request| {
            let passes = self.ranges.get(cache, &request);
            (request, passes)
        });
        let tones = tones_request(view, plan, scene, camera).and_then(|request| {
            let passes = self.ranges.of_tones(cache, request.space)?;
            Some((request, passes))
        });
        let ids = scene
            .depth
            .filter(|_| plan.draws() && plan.draws_ids() || scene.ids_queued)
            .map(|(size, samples)| IdRequest {
                camera: view.camera,
                size,
                samples,
                pressure: plan.pressure(view.scale_factor),
            });
        #[cfg(feature = "objects")]
        let highlights = {
            let scene = (scene, uniform);
            let lines = &mut self.lines;
            (self.highlights).requests(lines, cache, (plan, view), scene, (extracted, camera))
        };
        Requests {
            range,
            lines,
            ids,
            object_depths,
            tones,
            #[cfg(feature = "objects")]
            highlights,
            fused,
        }
    }

    fn fused(
        &mut self,
        cache: &PipelineCache,
        (plan, camera, context): (&Arc<Plan>, Entity, EffectContext),
        inputs: &KeyInputs,
        lines: Option<&(LineRequest, LinePasses)>,
    ) -> FusedRequest {
        let all = StylizeKey::new(plan, inputs, &context);
        let passes = passes(plan);
        let mut keys: Vec<_> = passes.iter().map(|p| all.of_pass(plan, p)).collect();
        // What earlier passes draw besides their pictures, for the next pass.
        let mut means = vec![None; passes.len() - 1];
        for (i, pass) in passes.iter().enumerate().skip(1) {
            match pass.reads {
                Some(Reads::BoxStatistics(effect)) => {
                    means[i - 1] = Some(keys[i].means_for(plan, effect, &context));
                }
                Some(Reads::AuxScalar(effect)) => keys[i - 1] = keys[i - 1].with_scalar(effect),
                None => {}
            }
        }
        // There is always a last pass, which draws the view's picture.
        let whole = keys.pop().unwrap_or(all);
        let chosen = ChosenArea::new((plan, &context), &whole, lines);
        let mut specialize = |key: &StylizeKey| {
            let pipeline = &self.stylize_pipeline;
            self.stylize.specialize(cache, pipeline, key.clone())
        };
        let base = (chosen.area == DrawnArea::Tiles)
            .then(|| specialize(&whole.base(&chosen.local, chosen.without_lines)));
        let mut pass = |key: StylizeKey| TexturePass {
            pipeline: specialize(&key),
            key,
        };
        let earlier = keys.into_iter().zip(means);
        let earlier = earlier.map(|(key, means)| EarlierPassRequest {
            picture: pass(key),
            means: means.map(|keys| keys.map(&mut pass)),
        });
        let key = whole.with_area(chosen.area);
        FusedRequest {
            camera,
            plan: plan.clone(),
            context,
            view: inputs.view,
            lines: lines.map(|(request, _)| request.lines),
            line_layers: plan
                .line_modifiers(&context)
                .layers
                .map(LineLayers::uniform),
            earlier: earlier.collect(),
            pipeline: specialize(&key),
            base,
            key,
        }
    }
}

/// What the last pass of a plan draws.
struct ChosenArea {
    area: DrawnArea,
    /// Effects of the pass that change only some pixels.
    local: Vec<&'static str>,
    /// Lines are left out of the pixels that the tiles do not cover.
    without_lines: bool,
}

impl ChosenArea {
    fn new(
        (plan, context): (&Plan, &EffectContext),
        whole: &StylizeKey,
        lines: Option<&(LineRequest, LinePasses)>,
    ) -> Self {
        let jumps = |effect: &dyn AnyEffect| {
            matches!(effect.any_affected_area(context), AffectedArea::AtJumps(_))
        };
        let searches_jumps = plan.drawn().any(jumps);
        let tiled = lines.filter(|(request, passes)| {
            passes.are_tiles_complete() && (request.jumps.is_some() || !searches_jumps)
        });
        let without_lines = line_reach(plan, context).is_some();
        let is_local =
            |effect: &dyn AnyEffect| effect.any_affected_area(context) != AffectedArea::Everywhere;
        let in_last = plan.drawn().filter(|e| whole.applies(e.name()));
        let local: Vec<_> = in_last
            .filter(|effect| is_local(*effect))
            .map(|effect| effect.name())
            .collect();
        let saves = |request: &LineRequest| {
            let jumps = request.jumps.is_some() && !local.is_empty();
            jumps || (without_lines && whole.needs.contains(Needs::LINES_ANYWHERE))
        };
        let area = match (whole.can_overlay(plan, context), tiled) {
            (true, Some(_)) => DrawnArea::OverlaidTiles,
            (true, None) => DrawnArea::Overlay,
            (false, Some((request, _))) if saves(request) && !whole.is_view() => DrawnArea::Tiles,
            (false, _) => DrawnArea::Whole,
        };
        Self {
            area,
            local,
            without_lines,
        }
    }
}

/// What is nearer than the surface of the prepass by this part of its distance is another surface.
const NEARER: f32 = 0.002;

fn view_uniform(view: &ViewPlan, plan: &Plan, scene: &Scene) -> ViewUniform {
    let nearest = view.backdrop.map(|at| view.projection.raw_depth(at.into()));
    let reference = view.projection.jump_reference(&view.clip_from_view);
    let uniform = ViewUniform::new(
        scene.viewport,
        scene.main_pass_size,
        plan.depth_map.flip,
        raw_depth(view, plan, scene),
        view.projection.frame(&plan.depth_map),
    );
    ViewUniform {
        backdrop: nearest.unwrap_or(0.0).max(0.0) as f32,
        nearer: NEARER * Vec2::from(reference),
        jitter: scene.jitter.unwrap_or_default() / uniform.depth_scale.max(Vec2::splat(1e-6)),
        ..uniform
    }
}

/// How the texels of the depth texture become raw depth.
fn raw_depth(view: &ViewPlan, plan: &Plan, scene: &Scene) -> RawDepth {
    let sky = plan.depth_map.sky_beyond;
    (view.projection).raw(&view.clip_from_view, scene.drawn(), sky)
}

/// What the effects of a plan ask for that treat objects as a whole.
fn object_depths(
    (plan, view): (&Plan, &ViewPlan),
    context: &EffectContext,
    uniform: ViewUniform,
    extracted: &ExtractedView,
) -> Option<ObjectDepthRequest> {
    let wanted = plan.draws() && plan.needs().contains(Needs::OBJECT_DEPTHS);
    wanted.then(|| ObjectDepthRequest {
        eye: ObjectEye {
            position: context.eye,
            orthographic: u32::from(view.projection.kind() == ProjectionKind::Orthographic),
            forward: *extracted.world_from_view.forward(),
            resets: 0,
            axis: context.depth_axis,
            spare: Vec2::ZERO,
            view: uniform,
        },
        mapping: plan.depth_map.mapping,
        cuts: view.cuts,
    })
}

fn range_request(view: &ViewPlan, plan: &Plan, scene: &Scene) -> Option<RangeRequest> {
    let (_, samples) = scene.depth.filter(|_| plan.needs_range())?;
    Some(RangeRequest {
        camera: view.camera,
        map: plan.depth_map,
        projection: view.projection,
        raw: raw_depth(view, plan, scene),
        viewport: scene.viewport.zw(),
        rect: scene.drawn(),
        samples,
        smooths: plan.smooths(),
        leader: plan.range_of.and(scene.leader),
        readback: plan.readback,
        histogram: plan.histogram,
        borders: plan.needs().contains(Needs::DEPTH_BORDERS),
        middle: plan.needs().contains(Needs::MIDDLE_DEPTH),
        #[cfg(feature = "toon")]
        materials: plan.materials,
        seconds: view.seconds,
        cuts: view.cuts,
    })
}

fn tones_request(
    view: &ViewPlan,
    plan: &Plan,
    scene: &Scene,
    camera: &ExtractedCamera,
) -> Option<TonesRequest> {
    let range = plan.tones()?;
    Some(TonesRequest {
        camera: view.camera,
        range,
        space: camera.compositing_space.unwrap_or(CompositingSpace::Linear),
        viewport: scene.viewport,
        after_anti_aliasing: plan.runs_after_anti_aliasing(),
        seconds: view.seconds,
        cuts: view.cuts,
    })
}

/// Puts components on a view, or removes them.
pub(crate) fn set_or_remove<B: Bundle>(view: &mut EntityCommands, wanted: Option<B>) {
    match wanted {
        Some(wanted) => view.insert(wanted),
        None => view.remove::<B>(),
    };
}

impl Requests {
    /// Whether a pipeline is still compiling. A pipeline that failed is not: its
    /// pass does not run, and the log says why.
    pub fn is_compiling(&self, cache: &PipelineCache) -> bool {
        let compute = |id| is_compiling(cache.get_compute_pipeline_state(id));
        let render = |id: CachedRenderPipelineId| is_compiling(cache.get_render_pipeline_state(id));
        let range = self.range.as_ref().is_some_and(|(_, passes)| {
            let reduction = passes.reduction.is_some_and(|reduction| match reduction {
                Reduction::Compute { pipeline, .. } => compute(pipeline),
                Reduction::PingPong { first, next } => render(first) || render(next),
            });
            let later = [
                passes.smoothing,
                passes.borders,
                passes.middle,
                passes.conversion,
            ];
            reduction || later.into_iter().flatten().any(|(_, id)| compute(id))
        });
        let tones = (self.tones.as_ref())
            .is_some_and(|(_, passes)| compute(passes.count) || compute(passes.smoothing.1));
        let lines = self.lines.as_ref();
        let lines = lines.is_some_and(|(_, passes)| are_compiling(passes, cache));
        #[cfg(feature = "objects")]
        let lines = lines
            || (self.highlights.as_ref())
                .is_some_and(|m| are_compiling(m.passes(), cache) || render(m.pipeline()));
        let fused = (self.fused.as_ref()).is_some_and(|f| f.pipelines().any(render));
        range || tones || lines || fused
    }

    /// Puts the requests on the view, and removes those of the last frame.
    /// `layer`: the entity with the requests for the lines of highlighted objects.
    pub fn put(self, entity: Entity, layer: Option<Entity>, commands: &mut Commands) {
        let mut view = commands.entity(entity);
        set_or_remove(&mut view, self.range);
        set_or_remove(&mut view, self.lines);
        set_or_remove(&mut view, self.ids);
        set_or_remove(&mut view, self.object_depths);
        set_or_remove(&mut view, self.tones);
        set_or_remove(&mut view, self.fused);
        #[cfg(feature = "objects")]
        match self.highlights {
            Some(highlights) => highlights.put(entity, layer, commands),
            None => remove_highlights(entity, layer, commands),
        }
        #[cfg(not(feature = "objects"))]
        let _ = layer;
    }
}
