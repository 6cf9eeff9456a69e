//! The pipelines that compute a view's visible range.

use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    render::{
        render_resource::{
            CachedComputePipelineId, CachedRenderPipelineId, PipelineCache,
            SpecializedComputePipelines, SpecializedRenderPipelines,
        },
        renderer::{RenderAdapterInfo, RenderDevice},
    },
};

use super::{
    ProjectionKind, ReductionMethod,
    ping_pong::PingPongPipeline,
    range::{RangeKey, RangePipeline, RangeShape},
    request::RangeRequest,
    view_pass::{QueuedPass, ViewPass, ViewPassPipeline},
};

/// The pipelines of one view's range.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct RangePasses {
    /// `None` if the view takes the range of another one.
    pub reduction: Option<Reduction>,
    /// The pass that smooths or holds the range, if it runs.
    pub smoothing: Option<QueuedPass>,
    /// The pass that divides the depths, if it runs.
    pub borders: Option<QueuedPass>,
    /// Whether the reduction counts a histogram of the depths.
    pub counts: bool,
    /// The pass that finds the depth in the middle, if it runs.
    pub middle: Option<QueuedPass>,
    /// The pass that converts the range of another view, if it runs.
    pub conversion: Option<QueuedPass>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Reduction {
    Compute {
        shape: RangeShape,
        pipeline: CachedComputePipelineId,
    },
    PingPong {
        first: CachedRenderPipelineId,
        next: CachedRenderPipelineId,
    },
}

/// The pipelines that find percentiles of the tones of one view.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct TonePasses {
    pub shape: RangeShape,
    pub key: RangeKey,
    /// The reduction, which counts tones in place of depths.
    pub count: CachedComputePipelineId,
    pub smoothing: QueuedPass,
}

#[derive(SystemParam)]
pub(crate) struct RangePipelines<'w> {
    ranges: ResMut<'w, SpecializedComputePipelines<RangePipeline>>,
    ping_pongs: ResMut<'w, SpecializedRenderPipelines<PingPongPipeline>>,
    passes: ResMut<'w, SpecializedComputePipelines<ViewPassPipeline>>,
    range: Res<'w, RangePipeline>,
    ping_pong: Res<'w, PingPongPipeline>,
    pass: Res<'w, ViewPassPipeline>,
    adapter: Res<'w, RenderAdapterInfo>,
    device: Res<'w, RenderDevice>,
}

impl RangePipelines<'_> {
    /// The pipelines for the tones of a picture that is stored in a space; `None` without compute
    /// shaders.
    pub fn of_tones(
        &mut self,
        cache: &PipelineCache,
        space: CompositingSpace,
    ) -> Option<TonePasses> {
        let shape = RangeShape::choose(ReductionMethod::Auto, &self.adapter, &self.device)?;
        let key = RangeKey {
            histogram: true,
            tones: Some(space),
            ..RangeKey::default()
        };
        let pass = ViewPass::Smoothing { histogram: true };
        Some(TonePasses {
            shape,
            key,
            count: self.ranges.specialize(cache, &self.range, (shape, key)),
            smoothing: (pass, self.passes.specialize(cache, &self.pass, pass)),
        })
    }

    /// The pipelines for a request; new ones are queued for compilation.
    pub fn get(&mut self, cache: &PipelineCache, request: &RangeRequest) -> RangePasses {
        let shape = RangeShape::choose(request.map.reduction, &self.adapter, &self.device);
        let has_compute = self.device.limits().max_compute_workgroup_size_x > 0;
        let reads_counts = request.histogram || request.borders;
        let takes = request.leader.is_some() && has_compute;
        let measures = !takes || reads_counts || request.readback;
        let smooths = request.smooths && !takes;
        let follows = (smooths || reads_counts || request.middle) && has_compute;
        let counts = follows && shape.is_some() && (reads_counts || request.has_outliers());
        let kind = request.projection.kind();
        let key = RangeKey {
            samples: request.samples,
            oblique: kind == ProjectionKind::Oblique,
            histogram: counts,
            orthographic: counts && kind == ProjectionKind::Orthographic,
            tones: None,
        };
        let mut reduction = || match shape {
            Some(shape) => Reduction::Compute {
                shape,
                pipeline: self.ranges.specialize(cache, &self.range, (shape, key)),
            },
            None => {
                let mut chain = |first| {
                    let key = (first, key.samples, key.oblique);
                    self.ping_pongs.specialize(cache, &self.ping_pong, key)
                };
                Reduction::PingPong {
                    first: chain(true),
                    next: chain(false),
                }
            }
        };
        let reduction = measures.then(&mut reduction);
        let mut queued = |runs: bool, pass| {
            runs.then(|| (pass, self.passes.specialize(cache, &self.pass, pass)))
        };
        let middle = ViewPass::Middle {
            samples: key.samples,
            oblique: key.oblique,
        };
        RangePasses {
            reduction,
            smoothing: queued(follows, ViewPass::Smoothing { histogram: counts }),
            borders: queued(counts && request.borders, ViewPass::Borders),
            counts,
            middle: queued(request.middle && has_compute, middle),
            conversion: queued(takes, ViewPass::Conversion),
        }
    }
}
