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
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries,
            CachedComputePipelineId, CachedRenderPipelineId, ComputePassDescriptor,
            ComputePipelineDescriptor, PipelineCache, Sampler, SamplerBindingType,
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

    fn layout(multisampled: bool) -> BindGroupLayoutDescriptor {
        let unfilterable = TextureSampleType::Float { filterable: false };
        let entries = if multisampled {
            BindGroupLayoutEntries::sequential(
                ShaderStages::COMPUTE,
                (
                    texture_2d_multisampled(unfilterable),
                    uniform_buffer::<RangeView>(true),
                    storage_buffer_sized(false, None),
                ),
            )
            .to_vec()
        } else {
            BindGroupLayoutEntries::sequential(
                ShaderStages::COMPUTE,
                (
                    texture_2d(unfilterable),
                    uniform_buffer::<RangeView>(true),
                    storage_buffer_sized(false, None),
                    sampler(SamplerBindingType::NonFiltering),
                ),
            )
            .to_vec()
        };
        BindGroupLayoutDescriptor::new("comics_depth_range", &entries)
    }
}

impl SpecializedComputePipeline for RangePipeline {
    /// Shape, multisampled depth, oblique projection.
    type Key = (RangeShape, bool, bool);

    fn specialize(&self, (shape, multisampled, oblique): Self::Key) -> ComputePipelineDescriptor {
        let mut shader_defs = Vec::new();
        match shape {
            RangeShape::BarrierFree => shader_defs.push("BARRIER_FREE".into()),
            RangeShape::Subgroup => shader_defs.push("SUBGROUP".into()),
            RangeShape::SharedMemory => {}
        }
        if multisampled {
            shader_defs.push("MULTISAMPLED".into());
        }
        if oblique {
            shader_defs.push("OBLIQUE".into());
        }
        ComputePipelineDescriptor {
            label: Some("comics_depth_range".into()),
            layout: vec![Self::layout(multisampled)],
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
        views, range_views, ..
    } = &*passes;
    let Some(pass) = views.get(&entity) else {
        return;
    };
    let (Some(range), Some(keys)) = (pass.range, pass.keys.clone()) else {
        return;
    };
    let (Some(depth), Some(range_view)) = (prepass.depth.as_ref(), range_views.binding()) else {
        return;
    };
    let (RangePass::Compute { samples, .. } | RangePass::PingPong { samples, .. }) = range;
    if depth.texture.texture.sample_count() != samples {
        ledger.set(
            pass.camera,
            ComicsStage::DepthRange,
            StageOutcome::LeftOut(LeftOut::SampleCountMismatch),
        );
        return;
    }

    let device = ctx.render_device().clone();
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let outcome = match range {
        RangePass::Compute {
            shape,
            pipeline: id,
            workgroups,
            ..
        } => {
            let Some(compute) = cache.get_compute_pipeline(id) else {
                return not_ready(&ledger, pass.camera);
            };
            let layout = cache.get_bind_group_layout(&RangePipeline::layout(samples > 1));
            let depth_view = &depth.texture.default_view;
            let bind_group = if samples > 1 {
                device.create_bind_group(
                    "comics_depth_range",
                    &layout,
                    &BindGroupEntries::sequential((
                        depth_view,
                        range_view,
                        keys.as_entire_binding(),
                    )),
                )
            } else {
                device.create_bind_group(
                    "comics_depth_range",
                    &layout,
                    &BindGroupEntries::sequential((
                        depth_view,
                        range_view,
                        keys.as_entire_binding(),
                        &pipeline.nearest_sampler,
                    )),
                )
            };
            let encoder = ctx.command_encoder();
            let span = diagnostics.time_span(encoder, "comics_depth_range");
            encoder.clear_buffer(&keys, 0, None);
            {
                let mut compute_pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                    label: Some("comics_depth_range"),
                    timestamp_writes: None,
                });
                compute_pass.set_pipeline(compute);
                compute_pass.set_bind_group(0, &bind_group, &[pass.range_view_offset]);
                compute_pass.dispatch_workgroups(workgroups.0, workgroups.1, 1);
            }
            span.end(encoder);
            shape.method()
        }
        RangePass::PingPong { first, next, .. } => {
            let (Some(first), Some(next), Some(chain)) = (
                cache.get_render_pipeline(first),
                cache.get_render_pipeline(next),
                pass.ping_pong.as_ref(),
            ) else {
                return not_ready(&ledger, pass.camera);
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
                    pass.range_view_offset,
                    samples > 1,
                ),
                &keys,
            );
            span.end(encoder);
            ReductionMethod::PingPong
        }
    };
    pass.range_found.store(true, Ordering::Relaxed);
    ledger.set(
        pass.camera,
        ComicsStage::DepthRange,
        StageOutcome::Reduced(outcome),
    );

    if pass.plan.readback {
        let mut readback = pass.readback.lock().unwrap_or_else(PoisonError::into_inner);
        let copied = readback.copy(&device, ctx.command_encoder(), &keys, pass.projection);
        let outcome = if copied {
            StageOutcome::Ran
        } else {
            StageOutcome::LeftOut(LeftOut::Busy)
        };
        ledger.set(pass.camera, ComicsStage::RangeReadback, outcome);
    }
}

fn not_ready(ledger: &StageLedger, camera: bevy::ecs::entity::Entity) {
    let outcome = StageOutcome::LeftOut(LeftOut::PipelineNotReady);
    ledger.set(camera, ComicsStage::DepthRange, outcome);
}
