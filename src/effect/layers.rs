//! The textures between the passes of a view whose effects read the picture at other
//! places.

use bevy::{
    ecs::{
        component::Component,
        entity::Entity,
        query::With,
        resource::Resource,
        system::{Commands, Query, Res, ResMut},
    },
    render::{
        render_resource::{
            AddressMode, Extent3d, FilterMode, Sampler, SamplerDescriptor, TextureDescriptor,
            TextureDimension, TextureFormat, TextureUsages,
        },
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
};

use super::prepare::FusedRequest;

/// Linear light, multiplied by the opacity, and the opacity.
pub(super) const LAYER_FORMAT: TextureFormat = TextureFormat::Rgba16Float;

/// On a view in the render world: what its passes but the last one draw to, in turns.
#[derive(Component)]
pub(super) struct ViewLayers(Vec<CachedTexture>);

impl ViewLayers {
    /// The texture that a pass draws to, and the next one reads.
    pub fn of(&self, pass: usize) -> Option<&CachedTexture> {
        self.0.get(pass % self.0.len().max(1))
    }
}

/// Reads between the centres of pixels.
#[derive(Resource)]
pub(super) struct LayerSampler(pub Sampler);

impl LayerSampler {
    pub fn new(device: &RenderDevice) -> Self {
        Self(device.create_sampler(&SamplerDescriptor {
            label: Some("comics_layer"),
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..Default::default()
        }))
    }
}

pub(super) fn prepare_layers(
    mut commands: Commands,
    views: Query<(Entity, &FusedRequest)>,
    layered: Query<Entity, With<ViewLayers>>,
    (mut textures, device): (ResMut<TextureCache>, Res<RenderDevice>),
) {
    for (view, request) in &views {
        let [_, _, width, height] = request.facts.viewport.to_array();
        let layer = || TextureDescriptor {
            label: Some("comics_layer"),
            size: Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: LAYER_FORMAT,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        // A pass cannot read what it draws to, so more than one need two.
        let count = request.layers.len().min(2);
        let found: Vec<_> = (0..count).map(|_| textures.get(&device, layer())).collect();
        if !found.is_empty() {
            commands.entity(view).insert(ViewLayers(found));
        } else if layered.contains(view) {
            commands.entity(view).remove::<ViewLayers>();
        }
    }
    for view in &layered {
        if !views.contains(view) {
            commands.entity(view).remove::<ViewLayers>();
        }
    }
}
