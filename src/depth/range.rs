//! The reduction: nearest and farthest depth of a view, in compute shaders.

use bevy::{
    asset::load_embedded_asset,
    prelude::*,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, ComputePipelineDescriptor, Sampler,
            SamplerBindingType, SamplerDescriptor, ShaderStages, ShaderType,
            SpecializedComputePipeline, WgpuFeatures,
            binding_types::{sampler, storage_buffer_sized, uniform_buffer},
        },
        renderer::{RenderAdapterInfo, RenderDevice},
    },
};
use wgpu_types::DeviceType;

use super::{RawDepth, ReductionMethod};
use crate::{
    gpu::{UNFILTERABLE, definitions, sampled, stored},
    samples,
};

/// `RangeView` of `raw.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug)]
pub(crate) struct RangeView {
    pub rect: UVec4,
    pub raw: RawDepth,
}

/// The forms of the reduction that are compute shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum RangeShape {
    BarrierFree,
    Subgroup,
    SharedMemory,
}

impl RangeShape {
    /// The shape that runs a method on this adapter; `None` for the ping-pong chain.
    pub fn choose(
        method: ReductionMethod,
        adapter: &RenderAdapterInfo,
        device: &RenderDevice,
    ) -> Option<Self> {
        if device.limits().max_compute_workgroup_size_x == 0 {
            return None;
        }
        // Shaders of browsers are written as text by naga 29, which leaves out that they use
        // subgroups.
        let subgroups =
            cfg!(not(target_family = "wasm")) && device.features().contains(WgpuFeatures::SUBGROUP);
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

    /// The method that this shape implements.
    pub fn method(self) -> ReductionMethod {
        match self {
            Self::BarrierFree => ReductionMethod::BarrierFree,
            Self::Subgroup => ReductionMethod::Subgroup,
            Self::SharedMemory => ReductionMethod::SharedMemory,
        }
    }

    /// Workgroups (x, y) for a rectangle, as `range.wgsl` divides it into tiles or strips.
    pub fn workgroups(self, rect: UVec4) -> (u32, u32) {
        match self {
            Self::BarrierFree => (rect.w.div_ceil(2 * 8), rect.z.div_ceil(256)),
            Self::Subgroup | Self::SharedMemory => (rect.z.div_ceil(128), rect.w.div_ceil(32)),
        }
    }
}

#[derive(Resource)]
pub(crate) struct RangePipeline {
    shader: Handle<Shader>,
    pub nearest_sampler: Sampler,
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

    pub fn layout(key: RangeKey) -> BindGroupLayoutDescriptor {
        let compute = ShaderStages::COMPUTE;
        let mut entries = BindGroupLayoutEntries::sequential(
            compute,
            (
                sampled(key.samples > 1, UNFILTERABLE),
                uniform_buffer::<RangeView>(true),
                storage_buffer_sized(false, None),
            ),
        )
        .to_vec();
        if key.samples <= 1 && key.tones.is_none() {
            entries.push(sampler(SamplerBindingType::NonFiltering).build(3, compute));
        }
        if key.histogram {
            entries.push(storage_buffer_sized(false, None).build(4, compute));
        }
        BindGroupLayoutDescriptor::new("comics_depth_range", &entries)
    }
}

/// What selects a shader variant of a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct RangeKey {
    /// Samples of a pixel.
    pub samples: u32,
    pub oblique: bool,
    pub histogram: bool,
    /// The histogram has the bins of an orthographic projection.
    pub orthographic: bool,
    /// The tones of a picture are reduced in place of depths. It is stored in this space.
    pub tones: Option<CompositingSpace>,
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
        shader_defs.extend(samples::definitions(key.samples));
        shader_defs.extend(definitions([
            (key.oblique, "OBLIQUE"),
            (key.histogram, "HISTOGRAM"),
            (key.orthographic, "ORTHOGRAPHIC"),
            (key.tones.is_some(), "TONES"),
        ]));
        shader_defs.extend(key.tones.and_then(stored));
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
