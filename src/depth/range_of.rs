//! The pass that converts the visible range of another view.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::resource::Resource,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindingResource, Buffer,
            BufferUsages, CommandEncoder, ComputePipeline, ComputePipelineDescriptor, ShaderStages,
            ShaderType, SpecializedComputePipeline,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer},
        },
        renderer::RenderDevice,
    },
    shader::Shader,
};

use super::{frame::DepthProjection, view::RANGE_SIZE};
use crate::{
    bind_groups::Binder,
    gpu::{buffer, compute_pass, entry},
};

/// `Conversion` of `range_of.wgsl`: raw depth of a view from that of another one at the same
/// distance.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ConversionUniform {
    pub factor: f32,
    pub summand: f32,
    pub pole: f32,
    pub is_reciprocal: u32,
}

impl ConversionUniform {
    pub fn new(from: &DepthProjection, to: &DepthProjection) -> Self {
        let (factor, summand, pole) = from.conversion(to);
        Self {
            factor: factor as f32,
            summand: summand as f32,
            pole: pole.unwrap_or(0.0) as f32,
            is_reciprocal: pole.is_some().into(),
        }
    }
}

/// The range that a view takes from another one.
pub(crate) struct TakenRange {
    /// Keys of the other view's range.
    pub from: Buffer,
    pub conversion: ConversionUniform,
    /// The same in raw depth of this view.
    pub drawn: Buffer,
    /// Offset of `conversion` in bytes.
    pub offset: u32,
}

impl TakenRange {
    pub fn new(device: &RenderDevice, from: Buffer) -> Self {
        let copied = BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM | copied;
        Self {
            from,
            conversion: ConversionUniform::default(),
            drawn: buffer(device, "comics_range_of", RANGE_SIZE, usage),
            offset: 0,
        }
    }

    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        binder: &Binder,
        (pipeline, uniforms): (&ComputePipeline, BindingResource),
    ) {
        let bind_group = binder.group(
            "comics_range_of",
            &RangeOfPipeline::layout(),
            &[
                entry(0, uniforms),
                entry(1, self.from.as_entire_binding()),
                entry(2, self.drawn.as_entire_binding()),
            ],
        );
        compute_pass(
            encoder,
            "comics_range_of",
            (pipeline, &bind_group),
            &[self.offset],
        )
        .dispatch_workgroups(1, 1, 1);
    }

    /// Takes the borders and the middle from the view's own range.
    pub fn keep_own(&self, encoder: &mut CommandEncoder, own: &Buffer) {
        let after_keys = 8;
        let size = RANGE_SIZE - after_keys;
        encoder.copy_buffer_to_buffer(own, after_keys, &self.drawn, after_keys, size);
    }
}

#[derive(Resource)]
pub(crate) struct RangeOfPipeline {
    shader: Handle<Shader>,
}

impl RangeOfPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "range_of.wgsl"),
        }
    }

    fn layout() -> BindGroupLayoutDescriptor {
        let entries = BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                uniform_buffer::<ConversionUniform>(true),
                storage_buffer_read_only_sized(false, None),
                storage_buffer_sized(false, None),
            ),
        );
        BindGroupLayoutDescriptor::new("comics_range_of", &entries)
    }
}

impl SpecializedComputePipeline for RangeOfPipeline {
    type Key = ();

    fn specialize(&self, (): ()) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_range_of".into()),
            layout: vec![Self::layout()],
            shader: self.shader.clone(),
            entry_point: Some("convert".into()),
            ..Default::default()
        }
    }
}
