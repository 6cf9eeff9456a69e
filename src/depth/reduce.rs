//! Records the passes that compute a view's visible range.

use std::sync::{PoisonError, atomic::Ordering};

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindingResource, CachedComputePipelineId, CachedRenderPipelineId, ComputePipeline,
            IntoBinding, TextureView,
        },
        renderer::{RenderContext, ViewQuery},
    },
};

use super::{
    ReductionMethod,
    follow::ViewSmoothing,
    passes::Reduction,
    ping_pong::{ChainSource, record_chain},
    prepare::{RangeUniforms, ViewDepthRange},
    range::{RangeKey, RangePipeline, RangeShape},
    surfaces::{OwnSurfaces, Surfaces},
    view_pass::{QueuedPass, ReadyPass},
};
use crate::{
    bind_groups::Binder,
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::{compute_pass, entry},
};

/// Records the reduction, the smoothing and the readback of a view's visible range.
pub(crate) fn reduce_depth_range(
    view: ViewQuery<(&ViewPrepassTextures, Option<&OwnSurfaces>, &ViewDepthRange)>,
    uniforms: Res<RangeUniforms>,
    ledger: Res<StageLedger>,
    pipeline: Res<RangePipeline>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let (prepass, own, range) = view.into_inner();
    let surfaces = Surfaces::from((Some(prepass), own));
    let camera = range.request.camera;
    let frame = Frame {
        range,
        uniforms: &uniforms,
        binder: &binder,
    };
    match frame.record(surfaces, &pipeline, &mut ctx) {
        Ok(method) => {
            let outcome = method.map_or(StageOutcome::Skipped(SkipReason::RangeOf), |method| {
                StageOutcome::RanWith(method.name())
            });
            ledger.set(camera, ComicsStage::DepthRange, outcome);
            if range.smoothing.is_some() && method.is_some() {
                ledger.set(camera, ComicsStage::RangeSmoothing, StageOutcome::Ran);
            }
            frame.read_back(&ledger, &mut ctx);
        }
        Err(reason) => {
            let outcome = StageOutcome::Skipped(reason);
            ledger.set(camera, ComicsStage::DepthRange, outcome);
        }
    }
}

struct Frame<'a> {
    range: &'a ViewDepthRange,
    uniforms: &'a RangeUniforms,
    binder: &'a Binder<'a>,
}

impl Frame<'_> {
    /// Records the reduction and the smoothing, or neither: the picture would jump if
    /// a range were drawn without its smoothing.
    fn record(
        &self,
        surfaces: Surfaces,
        pipeline: &RangePipeline,
        ctx: &mut RenderContext,
    ) -> Result<Option<ReductionMethod>, SkipReason> {
        let not_ready = SkipReason::PipelineNotReady;
        let passes = &self.range.passes;
        let conversion = match (passes.conversion, &self.range.taken) {
            (Some(pass), Some(taken)) => Some((
                taken,
                self.ready(pass)?,
                self.uniforms.conversions.binding().ok_or(not_ready)?,
            )),
            (Some(_), None) => return Err(not_ready),
            (None, _) => None,
        };
        let depth = surfaces.depth().ok_or(SkipReason::NoDepthPrepass)?;
        if depth.texture.sample_count() != self.range.request.samples {
            return Err(SkipReason::SampleCountMismatch);
        }
        let views = self.uniforms.views.binding().ok_or(not_ready)?;
        let smoothing = match (passes.smoothing, &self.range.smoothing) {
            (Some(pass), Some(smoothing)) => Some((
                smoothing,
                self.ready(pass)?,
                self.uniforms.smoothings.binding().ok_or(not_ready)?,
            )),
            _ => None,
        };
        let borders = passes.borders.map(|pass| self.ready(pass)).transpose()?;
        let middle = passes.middle.map(|pass| self.ready(pass)).transpose()?;
        let depth = &depth.default_view;
        let read = (depth, views.clone());
        let method = match passes.reduction {
            Some(Reduction::Compute {
                shape,
                pipeline: id,
            }) => Some(self.dispatch((shape, id), read, pipeline, ctx)?),
            Some(Reduction::PingPong { first, next }) => {
                Some(self.ping_pong((first, next), read, ctx)?)
            }
            None => None,
        };
        if let Some((smoothing, pass, uniforms)) = smoothing {
            // Without a reduction there is nothing but the middle.
            let smooth = method.is_some().then_some(pass);
            let read = (depth, views, uniforms);
            self.follow(smoothing, [smooth, borders, middle], read, ctx);
        }
        if let Some((taken, (pass, pipeline), uniforms)) = conversion {
            let [from, drawn] = [&taken.from, &taken.drawn].map(|keys| keys.as_entire_binding());
            let encoder = ctx.command_encoder();
            let bound = vec![uniforms, from, drawn];
            pass.record(encoder, (self.binder, pipeline), bound, &[taken.offset]);
            if let Some(smoothing) = &self.range.smoothing {
                taken.keep_own(encoder, &smoothing.drawn);
            }
        }
        self.range.found.store(true, Ordering::Relaxed);
        Ok(method)
    }

    fn compute_pipeline(
        &self,
        id: CachedComputePipelineId,
    ) -> Result<&ComputePipeline, SkipReason> {
        let pipeline = self.binder.cache.get_compute_pipeline(id);
        pipeline.ok_or(SkipReason::PipelineNotReady)
    }

    fn ready(&self, (pass, id): QueuedPass) -> Result<ReadyPass<'_>, SkipReason> {
        Ok((pass, self.compute_pipeline(id)?))
    }

    /// Records what follows the depths from frame to frame: the smoothing, the borders, the middle.
    fn follow(
        &self,
        smoothing: &ViewSmoothing,
        [smooth, borders, middle]: [Option<ReadyPass>; 3],
        (depth, views, uniforms): (&TextureView, BindingResource, BindingResource),
        ctx: &mut RenderContext,
    ) {
        let range = self.range;
        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        let mut record =
            |(pass, pipeline): ReadyPass, bound: Vec<BindingResource>, offsets: &[u32]| {
                let span = diagnostics.time_span(encoder, pass.label());
                pass.record(encoder, (self.binder, pipeline), bound, offsets);
                span.end(encoder);
            };
        let offset = smoothing.uniform_offset;
        let drawn = smoothing.drawn.as_entire_binding();
        if let Some(pass) = smooth {
            let bound = smoothing.bound(uniforms.clone(), &range.keys);
            record(pass, bound, &[offset]);
            smoothing.recorded();
        }
        let counted = range.borders.as_ref().zip(smoothing.histogram.as_ref());
        if let Some((pass, (state, histogram))) = borders.zip(counted) {
            let [histogram, state] = [histogram, state].map(|b| b.as_entire_binding());
            let bound = vec![uniforms.clone(), histogram, state, drawn.clone()];
            record(pass, bound, &[offset]);
        }
        if let Some(pass) = middle {
            let bound = vec![depth.into_binding(), views, uniforms, drawn];
            record(pass, bound, &[range.view_offset, offset]);
        }
    }

    fn dispatch(
        &self,
        (shape, id): (RangeShape, CachedComputePipelineId),
        (depth, view): (&TextureView, BindingResource),
        pipeline: &RangePipeline,
        ctx: &mut RenderContext,
    ) -> Result<ReductionMethod, SkipReason> {
        let range = self.range;
        let compute = self.compute_pipeline(id)?;
        let histogram = range.histogram();
        let key = RangeKey {
            samples: range.request.samples,
            histogram: histogram.is_some(),
            ..RangeKey::default()
        };
        let mut entries = vec![
            entry(0, depth.into_binding()),
            entry(1, view),
            entry(2, range.keys.as_entire_binding()),
        ];
        if key.samples <= 1 {
            entries.push(entry(3, (&pipeline.nearest_sampler).into_binding()));
        }
        if let Some(histogram) = histogram {
            entries.push(entry(4, histogram.as_entire_binding()));
        }
        let layout = RangePipeline::layout(key);
        let bind_group = self.binder.group("comics_depth_range", &layout, &entries);
        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        let span = diagnostics.time_span(encoder, "comics_depth_range");
        encoder.clear_buffer(&range.keys, 0, None);
        if let Some(smoothing) = &range.smoothing {
            smoothing.clear_histogram(encoder);
        }
        let (x, y) = shape.workgroups(range.request.rect);
        let (passed, offsets) = ((compute, &bind_group), [range.view_offset]);
        compute_pass(encoder, "comics_depth_range", passed, &offsets).dispatch_workgroups(x, y, 1);
        span.end(encoder);
        Ok(shape.method())
    }

    fn ping_pong(
        &self,
        (first, next): (CachedRenderPipelineId, CachedRenderPipelineId),
        (depth, view): (&TextureView, BindingResource),
        ctx: &mut RenderContext,
    ) -> Result<ReductionMethod, SkipReason> {
        let pipeline = |id| {
            self.binder
                .cache
                .get_render_pipeline(id)
                .ok_or(SkipReason::PipelineNotReady)
        };
        let pipelines = (pipeline(first)?, pipeline(next)?);
        let source = ChainSource {
            depth,
            view,
            offset: self.range.view_offset,
            multisampled: self.range.request.samples > 1,
        };
        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        let span = diagnostics.time_span(encoder, "comics_depth_range");
        record_chain(
            &self.range.chain,
            encoder,
            self.binder,
            pipelines,
            (&source, &self.range.keys),
        );
        span.end(encoder);
        Ok(ReductionMethod::PingPong)
    }

    /// Records the copies for `VisibleDepthRange` and `DepthHistogram`.
    fn read_back(&self, ledger: &StageLedger, ctx: &mut RenderContext) {
        let range = self.range;
        let request = &range.request;
        if !request.readback && !request.histogram {
            return;
        }
        let histogram = range
            .drawn()
            .filter(|_| request.histogram)
            .zip(range.histogram());
        let device = ctx.render_device().clone();
        let encoder = ctx.command_encoder();
        let mut readback = range
            .readback
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let copied = readback.copy(&device, encoder, &range.keys, histogram, request.projection);
        let outcome = if copied {
            StageOutcome::Ran
        } else {
            StageOutcome::Skipped(SkipReason::Busy)
        };
        ledger.set(request.camera, ComicsStage::RangeReadback, outcome);
    }
}
