//! The compute pass that finds the depth in the middle of a view.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::resource::Resource,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindingResource, CommandEncoder,
        ComputePipeline, ComputePipelineDescriptor, IntoBinding, ShaderStages,
        SpecializedComputePipeline, TextureView,
        binding_types::{storage_buffer_sized, uniform_buffer},
    },
    shader::Shader,
};

use super::{
    follow::{SmoothingUniform, ViewSmoothing},
    range::RangeView,
};
use crate::{
    bind_groups::Binder,
    gpu::{UNFILTERABLE, compute_pass, definitions, entry, sampled},
    samples,
};

/// Samples of a pixel, and whether the projection is oblique.
pub(crate) type MiddleKey = (u32, bool);

/// What the pass binds besides the smoothed range.
pub(crate) struct MiddleInputs<'a> {
    pub depth: &'a TextureView,
    pub samples: u32,
    pub views: BindingResource<'a>,
    pub view_offset: u32,
    pub smoothings: BindingResource<'a>,
}

/// Records the pass. Writes the depth beside the drawn range, and must be recorded after the
/// smoothing.
pub(crate) fn record_middle(
    encoder: &mut CommandEncoder,
    (binder, pipeline): (&Binder, &ComputePipeline),
    inputs: MiddleInputs,
    smoothing: &ViewSmoothing,
) {
    let layout = MiddlePipeline::layout(inputs.samples);
    let bind_group = binder.group(
        "comics_middle_depth",
        &layout,
        &[
            entry(0, inputs.depth.into_binding()),
            entry(1, inputs.views),
            entry(2, inputs.smoothings),
            entry(3, smoothing.drawn.as_entire_binding()),
        ],
    );
    let offsets = [inputs.view_offset, smoothing.uniform_offset];
    compute_pass(
        encoder,
        "comics_middle_depth",
        (pipeline, &bind_group),
        &offsets,
    )
    .dispatch_workgroups(1, 1, 1);
}

#[derive(Resource)]
pub(crate) struct MiddlePipeline {
    shader: Handle<Shader>,
}

impl MiddlePipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "middle.wgsl"),
        }
    }

    fn layout(samples: u32) -> BindGroupLayoutDescriptor {
        let entries = BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                sampled(samples > 1, UNFILTERABLE),
                uniform_buffer::<RangeView>(true),
                uniform_buffer::<SmoothingUniform>(true),
                storage_buffer_sized(false, None),
            ),
        );
        BindGroupLayoutDescriptor::new("comics_middle_depth", &entries)
    }
}

impl SpecializedComputePipeline for MiddlePipeline {
    type Key = MiddleKey;

    fn specialize(&self, (samples, oblique): Self::Key) -> ComputePipelineDescriptor {
        let oblique = definitions([(oblique, "OBLIQUE")]);
        let shader_defs = oblique.chain(samples::definitions(samples)).collect();
        ComputePipelineDescriptor {
            label: Some("comics_middle_depth".into()),
            layout: vec![Self::layout(samples)],
            shader: self.shader.clone(),
            shader_defs,
            entry_point: Some("follow".into()),
            ..Default::default()
        }
    }
}
