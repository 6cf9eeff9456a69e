//! The compute passes of one workgroup for each view.

use bevy::{
    asset::load_embedded_asset,
    prelude::*,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindingResource, CachedComputePipelineId, CommandEncoder,
        ComputePipeline, ComputePipelineDescriptor, ShaderStages, SpecializedComputePipeline,
        binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer},
    },
};

use super::{follow::SmoothingUniform, range::RangeView, range_of::ConversionUniform};
use crate::{
    bind_groups::Binder,
    gpu::{UNFILTERABLE, compute_pass, definitions, entry, sampled},
    samples,
};

/// A compute pass of one workgroup.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ViewPass {
    /// Smooths or holds the visible range. `histogram`: the reduction counts depths.
    Smoothing { histogram: bool },
    /// Divides the visible depths into near, middle and far. After the smoothing, beside whose
    /// range it writes the borders.
    Borders,
    /// Finds the depth in the middle of the view, and writes it there too.
    Middle { samples: u32, oblique: bool },
    /// Converts the range of another view.
    Conversion,
}

/// A pass, and its pipeline.
pub(crate) type QueuedPass = (ViewPass, CachedComputePipelineId);
pub(crate) type ReadyPass<'a> = (ViewPass, &'a ComputePipeline);

impl ViewPass {
    pub fn label(self) -> &'static str {
        match self {
            Self::Smoothing { .. } => "comics_range_smoothing",
            Self::Borders => "comics_depth_borders",
            Self::Middle { .. } => "comics_middle_depth",
            Self::Conversion => "comics_range_of",
        }
    }

    fn layout(self) -> BindGroupLayoutDescriptor {
        let read = storage_buffer_read_only_sized(false, None);
        let write = storage_buffer_sized(false, None);
        let smoothing = uniform_buffer::<SmoothingUniform>(true);
        let bound = match self {
            Self::Smoothing { histogram: true } => vec![smoothing, read, write, write, read],
            Self::Smoothing { .. } | Self::Borders => vec![smoothing, read, write, write],
            Self::Middle { samples, .. } => vec![
                sampled(samples > 1, UNFILTERABLE),
                uniform_buffer::<RangeView>(true),
                smoothing,
                write,
            ],
            Self::Conversion => vec![uniform_buffer::<ConversionUniform>(true), read, write],
        };
        let entries = (0..).zip(bound);
        let entries = entries.map(|(at, entry)| entry.build(at, ShaderStages::COMPUTE));
        BindGroupLayoutDescriptor::new(self.label(), &entries.collect::<Vec<_>>())
    }

    /// Records the pass. `offsets`: those of its uniforms.
    pub fn record(
        self,
        encoder: &mut CommandEncoder,
        (binder, pipeline): (&Binder, &ComputePipeline),
        bound: Vec<BindingResource>,
        offsets: &[u32],
    ) {
        let entries = (0..).zip(bound).map(|(at, resource)| entry(at, resource));
        let entries: Vec<_> = entries.collect();
        let group = binder.group(self.label(), &self.layout(), &entries);
        let mut pass = compute_pass(encoder, self.label(), (pipeline, &group), offsets);
        pass.dispatch_workgroups(1, 1, 1);
    }
}

/// The shaders of the passes.
#[derive(Resource)]
pub(crate) struct ViewPassPipeline {
    smoothing: Handle<Shader>,
    borders: Handle<Shader>,
    middle: Handle<Shader>,
    conversion: Handle<Shader>,
}

impl ViewPassPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            smoothing: load_embedded_asset!(assets, "smoothing.wgsl"),
            borders: load_embedded_asset!(assets, "borders.wgsl"),
            middle: load_embedded_asset!(assets, "middle.wgsl"),
            conversion: load_embedded_asset!(assets, "range_of.wgsl"),
        }
    }
}

impl SpecializedComputePipeline for ViewPassPipeline {
    type Key = ViewPass;

    fn specialize(&self, pass: Self::Key) -> ComputePipelineDescriptor {
        let (shader, entry_point) = match pass {
            ViewPass::Smoothing { .. } => (&self.smoothing, "follow"),
            ViewPass::Borders => (&self.borders, "divide"),
            ViewPass::Middle { .. } => (&self.middle, "follow"),
            ViewPass::Conversion => (&self.conversion, "convert"),
        };
        let shader_defs = match pass {
            ViewPass::Smoothing { histogram } => definitions([(histogram, "HISTOGRAM")]).collect(),
            ViewPass::Middle { samples, oblique } => definitions([(oblique, "OBLIQUE")])
                .chain(samples::definitions(samples))
                .collect(),
            ViewPass::Borders | ViewPass::Conversion => Vec::new(),
        };
        ComputePipelineDescriptor {
            label: Some(pass.label().into()),
            layout: vec![pass.layout()],
            shader: shader.clone(),
            shader_defs,
            entry_point: Some(entry_point.into()),
            ..Default::default()
        }
    }
}
