//! The pipeline that counts missing ids.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::resource::Resource,
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, ComputePipelineDescriptor, ShaderStages,
        SpecializedComputePipeline, TextureSampleType,
        binding_types::{storage_buffer_sized, uniform_buffer_sized},
    },
    shader::Shader,
};

use crate::gpu::{UNFILTERABLE, sampled};

/// Counts missing ids. Its key: whether the view is multisampled.
#[derive(Resource)]
pub(super) struct CountPipeline {
    shader: Handle<Shader>,
}

impl CountPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "count.wgsl"),
        }
    }
}

pub(super) fn count_layout(multisampled: bool) -> BindGroupLayoutDescriptor {
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            sampled(multisampled, UNFILTERABLE),
            sampled(multisampled, TextureSampleType::Uint),
            uniform_buffer_sized(false, None),
            storage_buffer_sized(false, None),
        ),
    );
    BindGroupLayoutDescriptor::new("comics_count_ids", &entries)
}

impl SpecializedComputePipeline for CountPipeline {
    type Key = bool;

    fn specialize(&self, multisampled: bool) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_count_ids".into()),
            layout: vec![count_layout(multisampled)],
            shader: self.shader.clone(),
            shader_defs: if multisampled {
                vec!["MULTISAMPLED".into()]
            } else {
                Vec::new()
            },
            entry_point: Some("count".into()),
            ..Default::default()
        }
    }
}
