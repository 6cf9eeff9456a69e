//! Turns the plan of a view into requests to the services.

use std::sync::Arc;

use bevy::{
    camera::MainPassResolutionOverride,
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::{
        entity::Entity,
        system::{Commands, Res, ResMut, SystemParam},
    },
    math::{Mat4, UVec2, UVec4, Vec2, Vec4Swizzles},
    render::{
        camera::{ExtractedCamera, TemporalJitter},
        render_resource::{
            CachedPipelineState, CachedRenderPipelineId, PipelineCache, SpecializedRenderPipelines,
        },
        view::ExtractedView,
    },
    shader::ShaderCacheError,
};

use super::{
    AnyEffect, Extent, Needs, Plan, ViewFacts, ViewPlan,
    key::{KeyInputs, Part, StylizeKey},
    pass::StylizePipeline,
    plan::Prepasses,
    prepare::FusedRequest,
};
use crate::{
    depth::{
        ProjectionKind, RawDepth,
        request::{RangePasses, RangePipelines, RangeRequest, Reduction},
        view::{ViewUniform, depth_rect},
    },
    lines::{
        LineSettings, MapJumps, MemoryRequest,
        request::{FindPass, LinePasses, LinePipelines, LineRequest},
    },
    objects::IdRequest,
};

/// The inputs that a view provides.
#[derive(Clone, Copy)]
pub(super) struct Scene {
    viewport: UVec4,
    /// Size of the main pass in pixels, if it differs from the viewport.
    main_pass_size: Option<UVec2>,
    /// By how much the engine has moved the main pass in this frame, in its pixels,
    /// under temporal anti-aliasing.
    jitter: Option<Vec2>,
    /// Size in pixels and samples per pixel of the depth prepass, if there is one.
    pub depth: Option<(UVec2, u32)>,
    pub normals: bool,
    motion: bool,
}

impl Scene {
    pub fn new(
        extracted: &ExtractedView,
        prepass: Option<&ViewPrepassTextures>,
        // The engine sets both in the render world.
        (resolution, jitter): (Option<&MainPassResolutionOverride>, Option<&TemporalJitter>),
    ) -> Self {
        let depth = prepass.and_then(|textures| textures.depth.as_ref());
        Self {
            viewport: extracted.viewport,
            main_pass_size: resolution.map(|resolution| resolution.0),
            jitter: jitter.map(|jitter| jitter.offset),
            depth: depth.map(|depth| {
                let texture = &depth.texture.texture;
                let size = UVec2::new(texture.width(), texture.height());
                (size, texture.sample_count())
            }),
            normals: prepass.is_some_and(|textures| textures.normal.is_some()),
            motion: prepass.is_some_and(|textures| textures.motion_vectors.is_some()),
        }
    }

    /// The part of the depth texture that the main pass draws: x, y, width, height.
    fn drawn(&self) -> UVec4 {
        depth_rect(self.viewport, self.main_pass_size)
    }

    /// The plan without the effects whose inputs this view does not provide.
    pub fn reduce(&self, plan: &Arc<Plan>) -> Arc<Plan> {
        let mut reduced = plan.clone();
        if self.depth.is_none() && reduced.needs_depth() {
            reduced = Arc::new(reduced.without(Prepasses::Depth));
        }
        if !self.normals && reduced.needs_normals() {
            reduced = Arc::new(reduced.without(Prepasses::Normals));
        }
        reduced
    }
}

/// The requests of one plan to the services, for one view, and their pipelines.
pub(super) struct Requests {
    range: Option<(RangeRequest, RangePasses)>,
    lines: Option<(LineRequest, LinePasses)>,
    ids: Option<IdRequest>,
    fused: Option<FusedRequest>,
}

/// Creates requests from plans.
#[derive(SystemParam)]
pub(crate) struct Services<'w> {
    ranges: RangePipelines<'w>,
    lines: LinePipelines<'w>,
    stylize: ResMut<'w, SpecializedRenderPipelines<StylizePipeline>>,
    stylize_pipeline: Res<'w, StylizePipeline>,
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
        let facts = ViewFacts {
            viewport: scene.viewport,
            scale_factor: view.scale_factor,
            world_from_clip: world_from_clip(view, extracted),
            seconds: view.time,
            lines_implied: plan.lines_implied(),
        };
        let jumps = map_jumps(plan, scene, &facts);
        let lines = line_request(view, (plan, &facts), scene, (uniform, jumps)).map(|request| {
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
            };
            self.fused(cache, (plan, view.camera, facts), &inputs, lines.as_ref())
        });
        let range = range_request(view, plan, scene).map(|request| {
            let passes = self.ranges.get(cache, &request);
            (request, passes)
        });
        let ids = scene
            .depth
            .filter(|_| plan.draws() && plan.draws_ids())
            .map(|(size, samples)| IdRequest {
                camera: view.camera,
                size,
                samples,
                pressure: plan.pressure(view.scale_factor),
            });
        Requests {
            range,
            lines,
            ids,
            fused,
        }
    }

    fn fused(
        &mut self,
        cache: &PipelineCache,
        (plan, camera, facts): (&Arc<Plan>, Entity, ViewFacts),
        inputs: &KeyInputs,
        lines: Option<&(LineRequest, LinePasses)>,
    ) -> FusedRequest {
        let whole = StylizeKey::new(plan, inputs, &facts);
        let jumps =
            |effect: &dyn AnyEffect| matches!(effect.any_extent(&facts), Extent::AtJumps(_));
        let searches_jumps = plan.drawn().any(jumps);
        let tiled = lines.filter(|(request, passes)| {
            passes.are_tiles_complete() && (request.jumps.is_some() || !searches_jumps)
        });
        let without_lines = line_reach(plan, &facts).is_some();
        let saves = |request: &LineRequest| {
            request.jumps.is_some() || (without_lines && whole.reads_lines_anywhere())
        };
        let part = match (whole.can_overlay(plan, &facts), tiled) {
            (true, Some(_)) => Part::OverlaidTiles,
            (true, None) => Part::Overlay,
            (false, Some((request, _))) if saves(request) && !whole.is_view() => Part::Tiles,
            (false, _) => Part::Whole,
        };
        let mut specialize = |key: &StylizeKey| {
            let pipeline = &self.stylize_pipeline;
            self.stylize.specialize(cache, pipeline, key.clone())
        };
        let base = (part == Part::Tiles).then(|| {
            let local = |effect: &&dyn AnyEffect| effect.any_extent(&facts) != Extent::Everywhere;
            let name = |effect: &dyn AnyEffect| effect.effect_type().name;
            let left_out = plan.drawn().filter(local).map(name).collect();
            specialize(&whole.base(left_out, without_lines))
        });
        let key = whole.with_part(part);
        FusedRequest {
            camera,
            plan: plan.clone(),
            facts,
            view: inputs.view,
            lines: lines.map(|(request, _)| request.lines),
            pipeline: specialize(&key),
            base,
            key,
        }
    }
}

/// The largest [`Effect::line_reach`](super::Effect::line_reach); `None` if an effect that
/// reads lines does not know it.
fn line_reach(plan: &Plan, view: &ViewFacts) -> Option<f32> {
    plan.drawn()
        .filter(|effect| effect.any_needs().contains(Needs::LINES))
        .try_fold(0.0_f32, |reach, effect| {
            Some(reach.max(effect.any_line_reach(view)?))
        })
}

/// The jumps of the depth map that effects of the plan are limited to. `None` also if
/// they are not looked for: in multisampled views, in views whose main pass has a
/// resolution of its own, beside lines of the faithful forms, and under a debug view.
fn map_jumps(plan: &Plan, scene: &Scene, facts: &ViewFacts) -> Option<MapJumps> {
    let (_, samples) = scene.depth?;
    let is_faithful = plan.lines.is_some_and(|lines| lines.has_faithful());
    let has_window = samples == 1 && scene.main_pass_size.is_none();
    if !has_window || is_faithful || plan.view.is_some() {
        return None;
    }
    let jumps = plan
        .drawn()
        .filter_map(|effect| match effect.any_extent(facts) {
            Extent::AtJumps(jumps) => Some(jumps),
            _ => None,
        });
    jumps.reduce(MapJumps::or)
}

fn view_uniform(view: &ViewPlan, plan: &Plan, scene: &Scene) -> ViewUniform {
    ViewUniform::new(
        scene.viewport,
        scene.main_pass_size,
        plan.depth_map.flip,
        raw_depth(view, scene),
        view.projection.frame(&plan.depth_map),
    )
}

/// How the texels of the depth texture become raw depth.
fn raw_depth(view: &ViewPlan, scene: &Scene) -> RawDepth {
    view.projection.raw(&view.clip_from_view, scene.drawn())
}

fn range_request(view: &ViewPlan, plan: &Plan, scene: &Scene) -> Option<RangeRequest> {
    let (_, samples) = scene.depth.filter(|_| plan.needs_range())?;
    Some(RangeRequest {
        camera: view.camera,
        map: plan.depth_map,
        projection: view.projection,
        raw: raw_depth(view, scene),
        rect: scene.drawn(),
        samples,
        smooths: plan.smooths(),
        readback: plan.readback,
        histogram: plan.histogram,
        seconds: view.seconds,
        cuts: view.cuts,
    })
}

/// World position from normalized device coordinates; the identity for a projection that
/// has no inverse.
fn world_from_clip(view: &ViewPlan, extracted: &ExtractedView) -> Mat4 {
    let matrix = extracted.world_from_view.to_matrix() * view.clip_from_view.inverse();
    if matrix.is_finite() {
        matrix
    } else {
        Mat4::IDENTITY
    }
}

fn line_request(
    view: &ViewPlan,
    (plan, facts): (&Plan, &ViewFacts),
    scene: &Scene,
    (uniform, jumps): (ViewUniform, Option<MapJumps>),
) -> Option<LineRequest> {
    let lines = plan.lines.filter(|_| plan.draws());
    let settings = lines.or(jumps.map(|_| LineSettings::NONE))?;
    let (depth_size, samples) = scene.depth?;
    let widest_object = if plan.object_styles {
        view.widest_object
    } else {
        0.0
    };
    let reach = settings.reach(view.scale_factor, widest_object, plan.vertex_widths);
    let reference = view.projection.jump_reference(&view.clip_from_view);
    let grid_scale = view.scale_factor * uniform.depth_scale.max_element();
    Some(LineRequest {
        camera: view.camera,
        settings,
        view: uniform,
        lines: settings.uniform(view.scale_factor, reference),
        weight: settings
            .weight
            .uniform(grid_scale, view.to_light, settings.budget),
        boil: settings.boil.uniform(view.scale_factor, view.time),
        memory: memory_request(view, &settings, scene),
        fog: plan.fog.then(|| {
            let fog = view.fog.unwrap_or_default();
            fog.uniform(&view.projection, &view.clip_from_view)
        }),
        depth_size,
        samples,
        size: scene.viewport.zw(),
        rect: scene.drawn(),
        jitter: scene.jitter,
        reach,
        steps: settings.steps(grid_scale),
        oblique: view.projection.kind() == ProjectionKind::Oblique,
        visible_range: plan.depth_map.mapping.follows_visible_range(),
        ids: plan.draws_ids(),
        sections: plan.sections,
        object_styles: plan.object_styles,
        widths: plan.draws_widths(),
        line_reach: line_reach(plan, facts).unwrap_or(0.0),
        jumps,
        map_flags: uniform.depth.flags,
    })
}

/// What lines remember, if they do: under temporal anti-aliasing.
fn memory_request(
    view: &ViewPlan,
    settings: &LineSettings,
    scene: &Scene,
) -> Option<MemoryRequest> {
    let single = scene.depth.is_some_and(|(_, samples)| samples == 1);
    let trembles = scene.jitter.is_some() && scene.motion && single;
    let remembers = settings.memory < 1.0 && !settings.boil.moves();
    (trembles && remembers).then_some(MemoryRequest {
        share: settings.memory,
        cuts: view.cuts,
    })
}

impl Requests {
    /// Whether a pipeline is still compiling. A pipeline that failed is not: its
    /// pass does not run, and the log says why.
    pub fn is_compiling(&self, cache: &PipelineCache) -> bool {
        let compute = |id| is_compiling(cache.get_compute_pipeline_state(id));
        let render = |id: CachedRenderPipelineId| is_compiling(cache.get_render_pipeline_state(id));
        let range = self.range.as_ref().is_some_and(|(_, passes)| {
            let reduction = match passes.reduction {
                Reduction::Compute { pipeline, .. } => compute(pipeline),
                Reduction::PingPong { first, next } => render(first) || render(next),
            };
            reduction || passes.smoothing.is_some_and(compute)
        });
        let lines = self.lines.as_ref().is_some_and(|(_, passes)| {
            let cracks = passes.cracks.is_some_and(|cracks| {
                let columns = cracks.columns.is_some_and(render);
                let find = match cracks.find {
                    FindPass::Cells(cells) => cells.ids().any(compute),
                    FindPass::Pixels(id) => render(id),
                };
                columns || find || render(cracks.draw)
            });
            let resolve = passes.resolve.is_some_and(|(_, id)| render(id));
            let search = passes
                .search
                .is_some_and(|ids| ids.into_iter().any(compute));
            let drawn = [passes.faithful, passes.memory];
            resolve || search || cracks || drawn.into_iter().flatten().any(render)
        });
        let fused =
            (self.fused.as_ref()).is_some_and(|f| render(f.pipeline) || f.base.is_some_and(render));
        range || lines || fused
    }

    /// Puts the requests on the view, and removes those of the last frame.
    pub fn put(self, entity: Entity, commands: &mut Commands) {
        let mut view = commands.entity(entity);
        match self.range {
            Some(range) => view.insert(range),
            None => view.remove::<(RangeRequest, RangePasses)>(),
        };
        match self.lines {
            Some(lines) => view.insert(lines),
            None => view.remove::<(LineRequest, LinePasses)>(),
        };
        match self.ids {
            Some(ids) => view.insert(ids),
            None => view.remove::<IdRequest>(),
        };
        match self.fused {
            Some(fused) => view.insert(fused),
            None => view.remove::<FusedRequest>(),
        };
    }
}

fn is_compiling(state: &CachedPipelineState) -> bool {
    match state {
        CachedPipelineState::Queued | CachedPipelineState::Creating(_) => true,
        // The pipeline cache retries after these errors.
        CachedPipelineState::Err(error) => matches!(
            error,
            ShaderCacheError::ShaderNotLoaded(_) | ShaderCacheError::ShaderImportNotYetAvailable
        ),
        CachedPipelineState::Ok(_) => false,
    }
}
