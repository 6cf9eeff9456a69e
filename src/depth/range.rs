//! The min/max reduction: nearest and farthest depth of a view.

use std::sync::{PoisonError, atomic::Ordering};

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::{resource::Resource, system::Res},
    math::UVec4,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroupEntry, BindGroupLayoutDescriptor, BindGroupLayoutEntries,
            CachedComputePipelineId, CachedRenderPipelineId, ComputePassDescriptor,
            ComputePipelineDescriptor, IntoBinding, PipelineCache, Sampler, SamplerBindingType,
            SamplerDescriptor, ShaderStages, ShaderType, SpecializedComputePipeline,
            TextureSampleType, WgpuFeatures,
            binding_types::{
                sampler, storage_buffer_sized, texture_2d, texture_2d_multisampled, uniform_buffer,
            },
        },
        renderer::{RenderAdapterInfo, RenderContext, RenderDevice, ViewQuery},
    },
    shader::Shader,
};
use wgpu_types::DeviceType;

use super::{RawDepth, ReductionMethod};
use crate::{
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    passes::ViewPasses,
};

/// `RangeView` of `range.wgsl` and `PingPongView` of `ping_pong.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug)]
pub(crate) struct RangeView {
    pub rect: UVec4,
    pub raw: RawDepth,
}

/// The compute shapes of the reduction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum RangeShape {
    BarrierFree,
    Subgroup,
    SharedMemory,
}

impl RangeShape {
    /// The shape for a method on this adapter; `None` for the ping-pong.
    pub fn choose(
        method: ReductionMethod,
        adapter: &RenderAdapterInfo,
        device: &RenderDevice,
    ) -> Option<Self> {
        if device.limits().max_compute_workgroup_size_x == 0 {
            return None;
        }
        let subgroups = device.features().contains(WgpuFeatures::SUBGROUP);
        let for_gpus = if subgroups {
            Self::Subgroup
        } else {
            Self::SharedMemory
        };
        match method {
            ReductionMethod::Auto if adapter.device_type == DeviceType::Cpu => {
                Some(Self::BarrierFree)
            }
            ReductionMethod::Auto | ReductionMethod::Subgroup => Some(for_gpus),
            ReductionMethod::BarrierFree => Some(Self::BarrierFree),
            ReductionMethod::SharedMemory => Some(Self::SharedMemory),
            ReductionMethod::PingPong => None,
        }
    }

    fn method(self) -> ReductionMethod {
        match self {
            Self::BarrierFree => ReductionMethod::BarrierFree,
            Self::Subgroup => ReductionMethod::Subgroup,
            Self::SharedMemory => ReductionMethod::SharedMemory,
        }
    }

    /// Workgroups for a rectangle; the counterpart of `range.wgsl`'s tiling.
    fn workgroups(self, rect: UVec4) -> (u32, u32) {
        match self {
            Self::BarrierFree => (rect.w.div_ceil(2 * 8), rect.z.div_ceil(256)),
            Self::Subgroup | Self::SharedMemory => (rect.z.div_ceil(128), rect.w.div_ceil(32)),
        }
    }
}

/// A reduction that is ready to be recorded.
#[derive(Clone, Copy)]
pub(crate) enum RangePass {
    Compute {
        shape: RangeShape,
        pipeline: CachedComputePipelineId,
        workgroups: (u32, u32),
        samples: u32,
    },
    PingPong {
        first: CachedRenderPipelineId,
        next: CachedRenderPipelineId,
        samples: u32,
    },
}

impl RangePass {
    pub fn compute(
        shape: RangeShape,
        pipeline: CachedComputePipelineId,
        rect: UVec4,
        samples: u32,
    ) -> Self {
        Self::Compute {
            shape,
            pipeline,
            workgroups: shape.workgroups(rect),
            samples,
        }
    }

    pub fn samples(&self) -> u32 {
        match self {
            Self::Compute { samples, .. } | Self::PingPong { samples, .. } => *samples,
        }
    }
}

#[derive(Resource)]
pub(crate) struct RangePipeline {
    shader: Handle<Shader>,
    nearest_sampler: Sampler,
}

impl RangePipeline {
    pub fn new(device: &RenderDevice, assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "range.wgsl"),
            nearest_sampler: device.create_sampler(&SamplerDescriptor {
                label: Some("comics_nearest"),
                ..Default::default()
            }),
        }
    }

    fn layout(key: RangeKey) -> BindGroupLayoutDescriptor {
        let unfilterable = TextureSampleType::Float { filterable: false };
        let depth = if key.multisampled {
            texture_2d_multisampled(unfilterable)
        } else {
            texture_2d(unfilterable)
        };
        let compute = ShaderStages::COMPUTE;
        let mut entries = BindGroupLayoutEntries::sequential(
            compute,
            (
                depth,
                uniform_buffer::<RangeView>(true),
                storage_buffer_sized(false, None),
            ),
        )
        .to_vec();
        if !key.multisampled {
            entries.push(sampler(SamplerBindingType::NonFiltering).build(3, compute));
        }
        if key.histogram {
            entries.push(storage_buffer_sized(false, None).build(4, compute));
        }
        BindGroupLayoutDescriptor::new("comics_depth_range", &entries)
    }
}

/// What else is compiled into a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct RangeKey {
    pub multisampled: bool,
    pub oblique: bool,
    pub histogram: bool,
}

impl SpecializedComputePipeline for RangePipeline {
    type Key = (RangeShape, RangeKey);

    fn specialize(&self, (shape, key): Self::Key) -> ComputePipelineDescriptor {
        let mut shader_defs = Vec::new();
        match shape {
            RangeShape::BarrierFree => shader_defs.push("BARRIER_FREE".into()),
            RangeShape::Subgroup => shader_defs.push("SUBGROUP".into()),
            RangeShape::SharedMemory => {}
        }
        if key.multisampled {
            shader_defs.push("MULTISAMPLED".into());
        }
        if key.oblique {
            shader_defs.push("OBLIQUE".into());
        }
        if key.histogram {
            shader_defs.push("HISTOGRAM".into());
        }
        ComputePipelineDescriptor {
            label: Some("comics_depth_range".into()),
            layout: vec![Self::layout(key)],
            shader: self.shader.clone(),
            shader_defs,
            entry_point: Some("reduce".into()),
            ..Default::default()
        }
    }
}

/// Finds the range of the view and sends it on its way to the game.
pub(crate) fn reduce_depth_range(
    view: ViewQuery<&ViewPrepassTextures>,
    passes: Res<ViewPasses>,
    ledger: Res<StageLedger>,
    pipeline: Res<RangePipeline>,
    cache: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let prepass = view.into_inner();
    let ViewPasses {
        views,
        range_uniforms,
        ..
    } = &*passes;
    let Some((pass, range)) = views
        .get(&entity)
        .and_then(|pass| Some((pass, pass.range.as_ref()?)))
    else {
        return;
    };
    let (Some(depth), Some(range_view)) = (prepass.depth.as_ref(), range_uniforms.views.binding())
    else {
        return;
    };
    let leave_out = |reason| {
        let outcome = StageOutcome::LeftOut(reason);
        ledger.set(pass.camera, ComicsStage::DepthRange, outcome);
    };
    if depth.texture.texture.sample_count() != range.pass.samples() {
        return leave_out(LeftOut::SampleCountMismatch);
    }
    // All of it or nothing: a range that is not smoothed would jump.
    let follow = match (&range.smoothing, range_uniforms.smoothings.binding()) {
        (None, _) => None,
        (Some((smoothing, id)), Some(uniforms)) => {
            let Some(pipeline) = cache.get_compute_pipeline(*id) else {
                return leave_out(LeftOut::PipelineNotReady);
            };
            Some((smoothing, pipeline, uniforms))
        }
        (Some(_), None) => return leave_out(LeftOut::PipelineNotReady),
    };

    let device = ctx.render_device().clone();
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let outcome = match range.pass {
        RangePass::Compute {
            shape,
            pipeline: id,
            workgroups,
            samples,
        } => {
            let Some(compute) = cache.get_compute_pipeline(id) else {
                return leave_out(LeftOut::PipelineNotReady);
            };
            let histogram = range.histogram();
            let key = RangeKey {
                multisampled: samples > 1,
                oblique: false,
                histogram: histogram.is_some(),
            };
            let entry = |binding, resource| BindGroupEntry { binding, resource };
            let mut entries = vec![
                entry(0, (&depth.texture.default_view).into_binding()),
                entry(1, range_view),
                entry(2, range.keys.as_entire_binding()),
            ];
            if !key.multisampled {
                entries.push(entry(3, (&pipeline.nearest_sampler).into_binding()));
            }
            if let Some(histogram) = histogram {
                entries.push(entry(4, histogram.as_entire_binding()));
            }
            let layout = cache.get_bind_group_layout(&RangePipeline::layout(key));
            let bind_group = device.create_bind_group("comics_depth_range", &layout, &entries);
            let encoder = ctx.command_encoder();
            let span = diagnostics.time_span(encoder, "comics_depth_range");
            encoder.clear_buffer(&range.keys, 0, None);
            if let Some(histogram) = histogram {
                encoder.clear_buffer(histogram, 0, None);
            }
            {
                let mut compute_pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                    label: Some("comics_depth_range"),
                    timestamp_writes: None,
                });
                compute_pass.set_pipeline(compute);
                compute_pass.set_bind_group(0, &bind_group, &[range.view_offset]);
                compute_pass.dispatch_workgroups(workgroups.0, workgroups.1, 1);
            }
            span.end(encoder);
            shape.method()
        }
        RangePass::PingPong {
            first,
            next,
            samples,
        } => {
            let (Some(first), Some(next), Some(chain)) = (
                cache.get_render_pipeline(first),
                cache.get_render_pipeline(next),
                range.ping_pong.as_ref(),
            ) else {
                return leave_out(LeftOut::PipelineNotReady);
            };
            let encoder = ctx.command_encoder();
            let span = diagnostics.time_span(encoder, "comics_depth_range");
            chain.record(
                &device,
                encoder,
                &cache,
                (first, next),
                (
                    &depth.texture.default_view,
                    range_view,
                    range.view_offset,
                    samples > 1,
                ),
                &range.keys,
            );
            span.end(encoder);
            ReductionMethod::PingPong
        }
    };
    ledger.set(
        pass.camera,
        ComicsStage::DepthRange,
        StageOutcome::Reduced(outcome),
    );
    if let Some((smoothing, pipeline, uniforms)) = follow {
        let encoder = ctx.command_encoder();
        let span = diagnostics.time_span(encoder, "comics_range_smoothing");
        smoothing.record(&device, encoder, &cache, pipeline, uniforms, &range.keys);
        span.end(encoder);
        ledger.set(pass.camera, ComicsStage::RangeSmoothing, StageOutcome::Ran);
    }
    range.found.store(true, Ordering::Relaxed);

    if pass.plan.readback || pass.plan.histogram {
        let mut readback = pass.readback.lock().unwrap_or_else(PoisonError::into_inner);
        let keys = &range.keys;
        let histogram = range
            .drawn()
            .filter(|_| pass.plan.histogram)
            .zip(range.histogram());
        let encoder = ctx.command_encoder();
        let copied = readback.copy(&device, encoder, keys, histogram, pass.projection);
        let outcome = if copied {
            StageOutcome::Ran
        } else {
            StageOutcome::LeftOut(LeftOut::Busy)
        };
        ledger.set(pass.camera, ComicsStage::RangeReadback, outcome);
    }
}
