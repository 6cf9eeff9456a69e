//! The pipeline that counts missing ids.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    ecs::{
        entity::Entity,
        query::With,
        resource::Resource,
        system::{Commands, Query, Res},
    },
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntries, ComputePipelineDescriptor, ShaderStages,
        SpecializedComputePipeline, TextureSampleType,
        binding_types::{
            storage_buffer_sized, texture_2d, texture_2d_multisampled, uniform_buffer_sized,
        },
    },
    shader::Shader,
};

use super::count::IdCount;

/// Counts missing ids. Its key: whether the view is multisampled.
#[derive(Resource)]
pub(super) struct CountPipeline {
    shader: Handle<Shader>,
}

pub(super) fn init_count_pipeline(
    mut commands: Commands,
    assets: Res<AssetServer>,
    views: Query<Entity, With<IdCount>>,
) {
    // This runs again after a lost device, whose buffers are no longer valid.
    for view in &views {
        commands.entity(view).remove::<IdCount>();
    }
    commands.insert_resource(CountPipeline {
        shader: load_embedded_asset!(assets.as_ref(), "count.wgsl"),
    });
}

pub(super) fn count_layout(multisampled: bool) -> BindGroupLayoutDescriptor {
    let types = [
        TextureSampleType::Float { filterable: false },
        TextureSampleType::Uint,
    ];
    let [depth, ids] = if multisampled {
        types.map(texture_2d_multisampled)
    } else {
        types.map(texture_2d)
    };
    let entries = BindGroupLayoutEntries::sequential(
        ShaderStages::COMPUTE,
        (
            depth,
            ids,
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
