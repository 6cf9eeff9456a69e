//! From a camera's plan to this frame's passes: pipelines, uniforms and the
//! buffers that belong to the view.

use std::sync::{Mutex, PoisonError, atomic::AtomicBool};

use bevy::{
    asset::AssetServer,
    core_pipeline::{FullscreenShader, prepass::ViewPrepassTextures},
    ecs::{
        entity::{Entity, EntityHashMap},
        resource::Resource,
        system::{Commands, Query, Res, ResMut},
        world::{FromWorld, World},
    },
    math::{IVec4, UVec2, UVec4, Vec2, Vec4Swizzles},
    render::{
        camera::ExtractedCamera,
        render_resource::{
            CachedPipelineState, CachedRenderPipelineId, DynamicUniformBuffer, PipelineCache,
            SpecializedRenderPipelines,
        },
        renderer::{RenderDevice, RenderQueue},
        view::{ExtractedView, ViewTarget},
    },
    shader::ShaderCacheError,
};

use crate::{
    depth::{
        ProjectionKind, RawDepth,
        frame::DepthProjection,
        ping_pong::PingPongPipeline,
        prepare::{RangeUniforms, Ranging, ViewRange},
        range::{RangePass, RangePipeline},
        readback::{RangeReadback, RangeReadings},
        smoothing::SmoothingPipeline,
    },
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    objects::ID_FORMAT,
    outlining::{
        FloodPipeline, OutlinePass, OutlinePipeline, ViewTexture, prepare::Outlining, reach,
    },
    stylize::{ComicsUniform, StylizeKey, StylizePipeline},
    view::{ComicsView, Plan},
};

/// The passes of one view, this frame.
pub(crate) struct ViewPass {
    pub camera: Entity,
    /// The plan as it can be drawn: without depth where the view has none.
    pub plan: Plan,
    pub projection: DepthProjection,
    pub key: StylizeKey,
    pub stylize: Option<CachedRenderPipelineId>,
    pub uniform_offset: u32,
    /// The range; kept while one is wanted.
    pub range: Option<ViewRange>,
    pub readback: Mutex<RangeReadback>,
    /// Which object is seen where; kept while lines want to know.
    pub ids: Option<ViewTexture>,
    pub outline: Option<OutlinePass>,
    /// The last plan of which every pipeline was compiled.
    pub ready: Option<Plan>,
    /// Whether this frame's outlines were recorded.
    pub outlines_found: AtomicBool,
    live: bool,
}

/// Every styled view's passes, by render entity. Made anew when the device is,
/// and a view's buffers go when the view does.
impl ViewPass {
    /// Whether a pipeline is still on its way. One that failed is not: then the
    /// picture passes through, and the log says why.
    fn is_compiling(&self, cache: &PipelineCache) -> bool {
        let compute = |id| is_under_way(cache.get_compute_pipeline_state(id));
        let render = |id| is_under_way(cache.get_render_pipeline_state(id));
        let range = self.range.as_ref().is_some_and(|range| {
            let reduction = match range.pass {
                RangePass::Compute { pipeline, .. } => compute(pipeline),
                RangePass::PingPong { first, next, .. } => render(first) || render(next),
            };
            reduction || range.smoothing.as_ref().is_some_and(|(_, id)| compute(*id))
        });
        let lines = self.outline.as_ref().is_some_and(|outline| {
            let flood = outline.flood.as_ref();
            render(outline.pipeline) || flood.is_some_and(|f| render(f.first) || render(f.next))
        });
        range || lines || self.stylize.is_some_and(render)
    }
}

fn is_under_way(state: &CachedPipelineState) -> bool {
    match state {
        CachedPipelineState::Queued | CachedPipelineState::Creating(_) => true,
        // These are tried again.
        CachedPipelineState::Err(error) => matches!(
            error,
            ShaderCacheError::ShaderNotLoaded(_) | ShaderCacheError::ShaderImportNotYetAvailable
        ),
        CachedPipelineState::Ok(_) => false,
    }
}

#[derive(Resource)]
pub(crate) struct ViewPasses {
    pub views: EntityHashMap<ViewPass>,
    pub uniforms: DynamicUniformBuffer<ComicsUniform>,
    pub range_uniforms: RangeUniforms,
}

impl FromWorld for ViewPasses {
    fn from_world(_world: &mut World) -> Self {
        let mut uniforms = DynamicUniformBuffer::default();
        uniforms.set_label(Some("comics_uniforms"));
        Self {
            views: EntityHashMap::default(),
            uniforms,
            range_uniforms: RangeUniforms::default(),
        }
    }
}

pub(crate) fn init_pipelines(
    mut commands: Commands,
    device: Res<RenderDevice>,
    fullscreen: Res<FullscreenShader>,
    assets: Res<AssetServer>,
) {
    commands.insert_resource(StylizePipeline::new(&fullscreen, &assets));
    commands.insert_resource(RangePipeline::new(&device, &assets));
    commands.insert_resource(PingPongPipeline::new(&fullscreen, &assets));
    commands.insert_resource(SmoothingPipeline::new(&assets));
    commands.insert_resource(OutlinePipeline::new(&fullscreen, &assets));
    commands.insert_resource(FloodPipeline::new(&assets));
}

/// How far around a pixel this view's lines are looked for, in pixels.
fn lines_reach(view: &ComicsView, plan: &Plan) -> i32 {
    let Some(outlines) = plan.outlines else {
        return 0;
    };
    let camera = if outlines.has_wide_lines() {
        outlines.width
    } else {
        0.0
    };
    let widest = if plan.object_styles {
        camera.max(view.widest_object)
    } else {
        camera
    };
    if widest == 0.0 {
        return 0;
    }
    reach(0.5 * widest * view.scale_factor)
}

fn uniform(view: &ComicsView, plan: &Plan, viewport: UVec4) -> ComicsUniform {
    let size = viewport.zw().max(UVec2::ONE);
    let depth_scale = view.main_pass_size.map_or(Vec2::ONE, |main| {
        (main.as_vec2() / size.as_vec2()).clamp(Vec2::ZERO, Vec2::ONE)
    });
    ComicsUniform {
        viewport: IVec4::from_array(viewport.to_array().map(|v| v as i32)),
        depth_scale,
        flip: u32::from(plan.depth_map.flip),
        raw: raw_depth(view, viewport),
        depth: view.projection.frame(&plan.depth_map),
        desaturation: plan.desaturation.map(|s| s.uniform()).unwrap_or_default(),
        colorization: plan.colorization.map(|s| s.uniform()).unwrap_or_default(),
        contours: plan
            .contours
            .map(|s| s.uniform(view.scale_factor))
            .unwrap_or_default(),
        black_flats: plan
            .black_flats
            .map(|s| s.uniform(viewport.w))
            .unwrap_or_default(),
        tone_bands: plan
            .tone_bands
            .map(|s| s.uniform(view.scale_factor))
            .unwrap_or_default(),
        outlines: plan
            .outlines
            .map(|s| {
                let reference = view.projection.jump_reference(&view.clip_from_view);
                s.uniform(view.scale_factor, reference, lines_reach(view, plan))
            })
            .unwrap_or_default(),
        sketch: plan
            .sketch
            .map(|s| s.uniform(view.scale_factor, view.drawing, plan.own_lines))
            .unwrap_or_default(),
        finish: plan.finish.uniform(viewport.z),
    }
}

fn raw_depth(view: &ComicsView, viewport: UVec4) -> RawDepth {
    view.projection.raw(&view.clip_from_view, viewport)
}

pub(crate) fn prepare_view_passes(
    views: Query<(
        Entity,
        &ComicsView,
        &ExtractedCamera,
        &ExtractedView,
        Option<&ViewPrepassTextures>,
        Option<&ViewTarget>,
    )>,
    mut passes: ResMut<ViewPasses>,
    ledger: Res<StageLedger>,
    mut stylize_pipelines: ResMut<SpecializedRenderPipelines<StylizePipeline>>,
    stylize_pipeline: Res<StylizePipeline>,
    mut ranging: Ranging,
    mut outlining: Outlining,
    mut cache: ResMut<PipelineCache>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    let passes = &mut *passes;
    passes.uniforms.clear();
    passes.range_uniforms.views.clear();
    passes.range_uniforms.smoothings.clear();
    outlining.buffer.update(&outlining.styles, &device, &queue);
    for pass in passes.views.values_mut() {
        pass.live = false;
    }

    for (entity, view, camera, extracted, prepass, target) in &views {
        if target.is_none() || extracted.viewport.z == 0 || extracted.viewport.w == 0 {
            continue;
        }
        let wanted = &view.plan;
        let depth = prepass.and_then(|textures| textures.depth.as_ref());
        let samples = depth.map(|depth| depth.texture.texture.sample_count());
        let mut plan = if depth.is_some() {
            *wanted
        } else {
            wanted.without_depth()
        };
        let normals = prepass.and_then(|textures| textures.normal.as_ref());
        if normals.is_none() {
            plan = plan.without_normals();
        }

        for stage in ComicsStage::ALL {
            ledger.set(
                view.camera,
                stage,
                StageOutcome::LeftOut(wanted.reason(stage)),
            );
        }
        if wanted.needs_depth() && depth.is_none() {
            report_missing_depth(&ledger, view);
        }
        if depth.is_some() {
            ledger.set(view.camera, ComicsStage::DepthPrepass, StageOutcome::Ran);
        }
        if normals.is_some() {
            ledger.set(view.camera, ComicsStage::NormalPrepass, StageOutcome::Ran);
        }

        let pass = passes.views.entry(entity).or_insert_with(|| ViewPass {
            camera: view.camera,
            plan,
            projection: view.projection,
            key: StylizeKey::default(),
            stylize: None,
            uniform_offset: 0,
            range: None,
            readback: Mutex::default(),
            ids: None,
            outline: None,
            outlines_found: AtomicBool::new(false),
            ready: None,
            live: true,
        });
        pass.live = true;
        pass.camera = view.camera;
        pass.projection = view.projection;
        let oblique = view.projection.kind() == ProjectionKind::Oblique;

        // While a pipeline of this look compiles, the last one stays.
        let last = pass.ready.map(|ready| match (depth, normals) {
            (None, _) => ready.without_depth(),
            (_, None) => ready.without_normals(),
            _ => ready,
        });
        let choices = [Some(plan), last.filter(|last| *last != plan)];
        for plan in choices.into_iter().flatten() {
            pass.plan = plan;
            pass.stylize = None;
            pass.outlines_found = AtomicBool::new(false);
            let old_range = pass.range.take();
            if let Some(samples) = samples.filter(|_| plan.needs_range()) {
                let rect = depth_rect(extracted.viewport, view.main_pass_size);
                pass.range = Some(ranging.prepare(
                    old_range,
                    &cache,
                    &device,
                    &mut passes.range_uniforms,
                    (view, &plan),
                    (rect, raw_depth(view, extracted.viewport), samples),
                ));
            }
            if !plan.readback && !plan.histogram {
                pass.readback = Mutex::default();
            }

            if plan.draws() {
                let size = depth.map(|d| {
                    let size = d.texture.texture.size();
                    UVec2::new(size.width, size.height)
                });
                let found = samples.zip(size).zip(plan.outlines);
                let old = pass.outline.take();
                if let Some(((samples, size), _)) = found {
                    pass.outline = outlining.prepare(
                        old,
                        &cache,
                        &device,
                        &plan,
                        (samples, size),
                        oblique,
                        view.main_pass_size.is_none(),
                        lines_reach(view, &plan),
                    );
                }
                pass.ids = pass
                    .ids
                    .take()
                    .filter(|_| plan.draws_ids())
                    .filter(|ids| size.zip(samples).is_some_and(|(z, s)| ids.fits(z, s)));
                if plan.draws_ids()
                    && pass.ids.is_none()
                    && let Some((size, samples)) = size.zip(samples)
                {
                    pass.ids = Some(ViewTexture::new(
                        &device,
                        "comics_object_ids",
                        size,
                        samples,
                        ID_FORMAT,
                    ));
                }
                let uniform = uniform(view, &plan, extracted.viewport);
                let flooded = pass.outline.as_ref().is_some_and(|o| o.flood.is_some());
                pass.key =
                    StylizeKey::new(&plan, extracted.target_format, camera.compositing_space)
                        .with_depth(samples.unwrap_or(1), oblique)
                        .with_flood(flooded)
                        .with_modes(&uniform);
                let id = stylize_pipelines.specialize(&cache, &stylize_pipeline, pass.key);
                pass.stylize = Some(id);
                pass.uniform_offset = passes.uniforms.push(&uniform);
            } else {
                pass.outline = None;
                pass.ids = None;
            }
            // Where pipelines are compiled at once, they are now.
            if pass.is_compiling(&cache) {
                cache.process_queue();
            }
            if !pass.is_compiling(&cache) {
                pass.ready = Some(plan);
                break;
            }
            ledger.set_compiling(view.camera);
        }
    }
    passes.views.retain(|_, pass| pass.live);
    passes.uniforms.write_buffer(&device, &queue);
    passes.range_uniforms.views.write_buffer(&device, &queue);
    let smoothings = &mut passes.range_uniforms.smoothings;
    smoothings.write_buffer(&device, &queue);
}

/// The part of the depth texture that the main pass has drawn.
fn depth_rect(viewport: UVec4, main_pass_size: Option<UVec2>) -> UVec4 {
    let size = main_pass_size.map_or(viewport.zw(), |main| main.clamp(UVec2::ONE, viewport.zw()));
    UVec4::new(viewport.x, viewport.y, size.x, size.y)
}

fn report_missing_depth(ledger: &StageLedger, view: &ComicsView) {
    bevy::log::warn_once!(
        "{} has a depth style and no depth prepass: its picture passes without that style",
        view.camera
    );
    let missing = StageOutcome::LeftOut(LeftOut::NoDepthPrepass);
    let wanted = &view.plan;
    let left = wanted.without_depth();
    for (stage, lost) in [
        (ComicsStage::DepthPrepass, true),
        (ComicsStage::DepthRange, wanted.needs_range()),
        (ComicsStage::RangeSmoothing, wanted.smooths()),
        (ComicsStage::RangeReadback, wanted.readback),
        (ComicsStage::Desaturation, wanted.desaturation.is_some()),
        (
            ComicsStage::Colorization,
            wanted.colorization.is_some() && left.colorization.is_none(),
        ),
        (
            ComicsStage::BlackFlats,
            wanted.black_flats.is_some() && left.black_flats.is_none(),
        ),
        (ComicsStage::Contours, wanted.contours.is_some()),
        (ComicsStage::Outlines, wanted.outlines.is_some()),
        (ComicsStage::Sketch, wanted.sketch.is_some()),
    ] {
        if lost {
            ledger.set(view.camera, stage, missing);
        }
    }
}

pub(crate) fn map_readbacks(mut passes: ResMut<ViewPasses>, readings: Res<RangeReadings>) {
    for pass in passes.views.values_mut() {
        let camera = pass.camera;
        let readback = pass
            .readback
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        readback.map(camera, &readings);
    }
}
