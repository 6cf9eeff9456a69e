//! From a plan to this frame's range: pipelines and buffers.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    ecs::system::{Res, ResMut, SystemParam},
    math::{UVec4, Vec4Swizzles},
    render::{
        render_resource::{
            Buffer, BufferDescriptor, BufferUsages, CachedComputePipelineId, DynamicUniformBuffer,
            PipelineCache, SpecializedComputePipelines, SpecializedRenderPipelines,
        },
        renderer::{RenderAdapterInfo, RenderDevice},
    },
};

use super::{
    ProjectionKind, RawDepth,
    ping_pong::{PingPong, PingPongPipeline},
    range::{RangeKey, RangePass, RangePipeline, RangeShape, RangeView},
    smoothing::{SmoothingPipeline, SmoothingUniform, ViewSmoothing},
};
use crate::view::{ComicsView, Plan};

/// The range of one view, this frame.
pub(crate) struct ViewRange {
    pub pass: RangePass,
    pub view_offset: u32,
    /// Keys of the nearest and farthest depth of this frame.
    pub keys: Buffer,
    pub ping_pong: Option<PingPong>,
    pub smoothing: Option<(ViewSmoothing, CachedComputePipelineId)>,
    /// Whether this frame's range was recorded.
    pub found: AtomicBool,
}

impl ViewRange {
    /// Where the reduction counts depths, if it does.
    pub fn histogram(&self) -> Option<&Buffer> {
        self.smoothing.as_ref()?.0.histogram.as_ref()
    }

    /// The keys that styles are drawn with, once they were recorded.
    pub fn drawn(&self) -> Option<&Buffer> {
        let keys = match &self.smoothing {
            Some((smoothing, _)) => &smoothing.drawn,
            None => &self.keys,
        };
        self.found.load(Ordering::Relaxed).then_some(keys)
    }
}

/// The uniforms of all views' ranges.
pub(crate) struct RangeUniforms {
    pub views: DynamicUniformBuffer<RangeView>,
    pub smoothings: DynamicUniformBuffer<SmoothingUniform>,
}

impl Default for RangeUniforms {
    fn default() -> Self {
        let mut views = DynamicUniformBuffer::default();
        views.set_label(Some("comics_range_views"));
        let mut smoothings = DynamicUniformBuffer::default();
        smoothings.set_label(Some("comics_range_smoothings"));
        Self { views, smoothings }
    }
}

/// What the range's passes are made of.
#[derive(SystemParam)]
pub(crate) struct Ranging<'w> {
    range_pipelines: ResMut<'w, SpecializedComputePipelines<RangePipeline>>,
    ping_pong_pipelines: ResMut<'w, SpecializedRenderPipelines<PingPongPipeline>>,
    smoothing_pipelines: ResMut<'w, SpecializedComputePipelines<SmoothingPipeline>>,
    range_pipeline: Res<'w, RangePipeline>,
    ping_pong_pipeline: Res<'w, PingPongPipeline>,
    smoothing_pipeline: Res<'w, SmoothingPipeline>,
    adapter: Res<'w, RenderAdapterInfo>,
}

impl Ranging<'_> {
    /// This frame's range of a view; what still fits is kept.
    pub fn prepare(
        &mut self,
        old: Option<ViewRange>,
        cache: &PipelineCache,
        device: &RenderDevice,
        uniforms: &mut RangeUniforms,
        (view, plan): (&ComicsView, &Plan),
        (rect, raw, samples): (UVec4, RawDepth, u32),
    ) -> ViewRange {
        let shape = RangeShape::choose(plan.depth_map.reduction, &self.adapter, device);
        let (keys, ping_pong, smoothed) = match old {
            Some(old) => (Some(old.keys), old.ping_pong, old.smoothing),
            None => (None, None, None),
        };
        let has_compute = device.limits().max_compute_workgroup_size_x > 0;
        let outliers = plan.depth_map.smoothing.is_some_and(|s| s.outliers > 0.0);
        let counts = plan.histogram || (outliers && plan.smooths());
        let smoothing = (plan.follows_range() && has_compute).then(|| {
            let mut kept = match smoothed {
                Some((kept, _)) => kept,
                None => ViewSmoothing::new(device, view, rect.zw()),
            };
            kept.keep_histogram(device, counts && shape.is_some());
            let uniform = kept.uniform(&plan.depth_map, view, rect.zw());
            kept.uniform_offset = uniforms.smoothings.push(&uniform);
            let pipeline = self.smoothing_pipelines.specialize(
                cache,
                &self.smoothing_pipeline,
                kept.histogram.is_some(),
            );
            (kept, pipeline)
        });
        let histogram = smoothing
            .as_ref()
            .is_some_and(|(smoothing, _)| smoothing.histogram.is_some());

        let key = RangeKey {
            multisampled: samples > 1,
            oblique: view.projection.kind() == ProjectionKind::Oblique,
            histogram,
        };
        let (pass, ping_pong) = match shape {
            Some(shape) => {
                let pipeline =
                    self.range_pipelines
                        .specialize(cache, &self.range_pipeline, (shape, key));
                let pass = RangePass::compute(shape, pipeline, rect, samples);
                (pass, None)
            }
            None => {
                let chain = ping_pong
                    .filter(|chain| chain.rect_size() == rect.zw())
                    .unwrap_or_else(|| PingPong::new(device, rect.zw()));
                let mut specialize = |first| {
                    self.ping_pong_pipelines.specialize(
                        cache,
                        &self.ping_pong_pipeline,
                        (first, key.multisampled, key.oblique),
                    )
                };
                let pass = RangePass::PingPong {
                    first: specialize(true),
                    next: specialize(false),
                    samples,
                };
                (pass, Some(chain))
            }
        };
        ViewRange {
            pass,
            view_offset: uniforms.views.push(&RangeView { rect, raw }),
            keys: keys.unwrap_or_else(|| keys_buffer(device)),
            ping_pong,
            smoothing,
            found: AtomicBool::new(false),
        }
    }
}

fn keys_buffer(device: &RenderDevice) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some("comics_depth_range"),
        size: 16,
        usage: BufferUsages::STORAGE
            | BufferUsages::UNIFORM
            | BufferUsages::COPY_SRC
            | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
