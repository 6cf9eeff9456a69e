//! The layer of highlighted objects: their depth and ids, drawn as if nothing else was there.

use bevy::{
    core_pipeline::core_3d::CORE_3D_DEPTH_FORMAT,
    prelude::*,
    render::{
        render_resource::{TextureFormat, TextureUsages},
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
};

use super::ID_FORMAT;
use crate::gpu;

/// On a view in the render world: a request for the layer of highlighted objects.
#[derive(Component)]
pub(crate) struct LayerRequest {
    pub camera: Entity,
    /// Size in pixels of the depth texture, and its samples per pixel.
    pub size: UVec2,
    pub samples: u32,
}

/// On a view in the render world: depth and ids of the highlighted objects.
#[derive(Component, Clone)]
pub(crate) struct ViewLayer {
    pub depth: CachedTexture,
    pub ids: CachedTexture,
}

/// Gets the textures of this frame from the engine's texture cache.
pub(super) fn prepare_layers(
    mut commands: Commands,
    views: Query<(Entity, &LayerRequest)>,
    stale: Query<Entity, (With<ViewLayer>, Without<LayerRequest>)>,
    mut textures: ResMut<TextureCache>,
    device: Res<RenderDevice>,
) {
    for (view, request) in &views {
        let mut texture = |label, format: TextureFormat| {
            let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
            let size = (request.size, request.samples);
            textures.get(&device, gpu::texture(label, size, format, usage))
        };
        let layer = ViewLayer {
            depth: texture("comics_highlighted_depth", CORE_3D_DEPTH_FORMAT),
            ids: texture("comics_highlighted_ids", ID_FORMAT),
        };
        commands.entity(view).insert(layer);
    }
    for view in &stale {
        commands.entity(view).remove::<ViewLayer>();
    }
}
