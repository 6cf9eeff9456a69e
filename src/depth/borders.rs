//! The compute pass that divides the visible depths into near, middle and far.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::resource::Resource,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindingResource, Buffer,
            BufferUsages, CachedComputePipelineId, CommandEncoder, ComputePipelineDescriptor,
            ShaderStages,
            binding_types::{storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer},
        },
        renderer::RenderDevice,
    },
    shader::Shader,
};

use super::follow::{SmoothingUniform, ViewSmoothing};
use crate::{
    bind_groups::Binder,
    gpu::{buffer, compute_pass, entry},
};

/// Bytes of `BorderState` in `borders.wgsl`.
const STATE_SIZE: u64 = 16;

/// The state of a view's borders.
pub(crate) struct ViewBorders {
    state: Buffer,
}

impl ViewBorders {
    pub fn new(device: &RenderDevice) -> Self {
        Self {
            state: buffer(
                device,
                "comics_depth_borders",
                STATE_SIZE,
                BufferUsages::STORAGE,
            ),
        }
    }

    /// Records the division of the depths that the reduction of this frame has counted. Writes
    /// the borders beside the drawn range, and must be recorded after the smoothing.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        (binder, pipeline): (&Binder, CachedComputePipelineId),
        (uniforms, smoothing): (BindingResource, &ViewSmoothing),
    ) {
        let (Some(histogram), Some(pipeline)) = (
            &smoothing.histogram,
            binder.cache.get_compute_pipeline(pipeline),
        ) else {
            return;
        };
        let bind_group = binder.group(
            "comics_depth_borders",
            &BorderPipeline::layout(),
            &[
                entry(0, uniforms),
                entry(1, histogram.as_entire_binding()),
                entry(2, self.state.as_entire_binding()),
                entry(3, smoothing.drawn.as_entire_binding()),
            ],
        );
        let offsets = [smoothing.uniform_offset];
        let passed = (pipeline, &bind_group);
        let mut pass = compute_pass(encoder, "comics_depth_borders", passed, &offsets);
        pass.dispatch_workgroups(1, 1, 1);
    }
}

#[derive(Resource)]
pub(crate) struct BorderPipeline {
    shader: Handle<Shader>,
}

impl BorderPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "borders.wgsl"),
        }
    }

    fn layout() -> BindGroupLayoutDescriptor {
        let entries = BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                uniform_buffer::<SmoothingUniform>(true),
                storage_buffer_read_only_sized(false, None),
                storage_buffer_sized(false, None),
                storage_buffer_sized(false, None),
            ),
        );
        BindGroupLayoutDescriptor::new("comics_depth_borders", &entries)
    }
}

impl bevy::render::render_resource::SpecializedComputePipeline for BorderPipeline {
    type Key = ();

    fn specialize(&self, (): Self::Key) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_depth_borders".into()),
            layout: vec![Self::layout()],
            shader: self.shader.clone(),
            entry_point: Some("divide".into()),
            ..Default::default()
        }
    }
}
