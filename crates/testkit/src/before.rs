//! What happens to the picture before the fused pass, which may be blended over it.

use std::sync::Mutex;

use bevy::{
    core_pipeline::{
        schedule::{Core3d, Core3dSystems},
        tonemapping::tonemapping,
    },
    ecs::entity::EntityHashMap,
    prelude::*,
    render::{
        RenderApp,
        renderer::{RenderContext, RenderDevice, ViewQuery},
        view::ViewTarget,
    },
};
use bevy_comics::ComicsSystems;

/// Copies of the pictures that the fused pass of each view will read.
#[derive(Resource, Default)]
pub struct Pictures(Mutex<EntityHashMap<wgpu::Texture>>);

impl Pictures {
    /// The picture of a view in the last frame.
    pub fn get(&self, view: Entity) -> Option<wgpu::Texture> {
        self.0.lock().expect("no panic").get(&view).cloned()
    }
}

/// What to do with the picture before the fused pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeforeStylize {
    /// Copies it to [`Pictures`].
    Copy,
    /// Replaces it by zeros.
    Clear,
}

fn copy(
    view: ViewQuery<&ViewTarget>,
    pictures: Res<Pictures>,
    device: Res<RenderDevice>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let picture = view.into_inner().main_texture();
    let mut pictures = pictures.0.lock().expect("no panic");
    let known = pictures
        .get(&entity)
        .filter(|copy| (copy.size(), copy.format()) == (picture.size(), picture.format()));
    let copy = known.cloned().unwrap_or_else(|| {
        device
            .wgpu_device()
            .create_texture(&wgpu::TextureDescriptor {
                label: Some("picture before the fused pass"),
                size: picture.size(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: picture.format(),
                usage: wgpu::TextureUsages::COPY_DST
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
    });
    ctx.command_encoder().copy_texture_to_texture(
        picture.as_image_copy(),
        copy.as_image_copy(),
        picture.size(),
    );
    pictures.insert(entity, copy);
}

fn clear(view: ViewQuery<&ViewTarget>, mut ctx: RenderContext) {
    let target = view.into_inner();
    ctx.command_encoder()
        .begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("clear"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target.main_texture_view(),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..default()
        });
}

impl Plugin for BeforeStylize {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app.init_resource::<Pictures>();
        let system = match self {
            Self::Copy => copy.into_configs(),
            Self::Clear => clear.into_configs(),
        };
        render_app.add_systems(
            Core3d,
            system
                .in_set(Core3dSystems::PostProcess)
                .after(tonemapping)
                .before(ComicsSystems::Stylize),
        );
    }
}
