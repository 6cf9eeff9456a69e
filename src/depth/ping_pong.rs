//! The reduction as a chain of fragment passes, as in the paper (\[CS\] 3.1).

use bevy::{
    asset::load_embedded_asset,
    core_pipeline::FullscreenShader,
    prelude::*,
    render::{
        render_resource::{
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, BindingResource,
            Buffer, CommandEncoder, Extent3d, FragmentState, LoadOp, RenderPassDescriptor,
            RenderPipeline, RenderPipelineDescriptor, ShaderStages, SpecializedRenderPipeline,
            TexelCopyBufferInfo, TexelCopyBufferLayout, TextureFormat, TextureSampleType,
            TextureUsages, TextureView,
            binding_types::{texture_2d, uniform_buffer},
        },
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
};

use super::range::RangeView;
use crate::{
    bind_groups::Binder,
    gpu::{UNFILTERABLE, attachment, definitions, sampled, texture},
    samples,
};

const FORMAT: TextureFormat = TextureFormat::R32Uint;

#[derive(Resource)]
pub(crate) struct PingPongPipeline {
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
}

impl PingPongPipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            shader: load_embedded_asset!(assets, "ping_pong.wgsl"),
        }
    }

    fn first_layout(multisampled: bool) -> BindGroupLayoutDescriptor {
        let depth = sampled(multisampled, UNFILTERABLE);
        BindGroupLayoutDescriptor::new(
            "comics_ping_pong_first",
            &BindGroupLayoutEntries::sequential(
                ShaderStages::FRAGMENT,
                (depth, uniform_buffer::<RangeView>(true)),
            ),
        )
    }

    fn next_layout() -> BindGroupLayoutDescriptor {
        BindGroupLayoutDescriptor::new(
            "comics_ping_pong_next",
            &BindGroupLayoutEntries::single(
                ShaderStages::FRAGMENT,
                texture_2d(TextureSampleType::Uint),
            ),
        )
    }
}

impl SpecializedRenderPipeline for PingPongPipeline {
    /// Whether it is the first pass, the samples of the depth, whether the projection is oblique.
    type Key = (bool, u32, bool);

    fn specialize(&self, (first, samples, oblique): Self::Key) -> RenderPipelineDescriptor {
        let flags = definitions([(first, "FIRST"), (oblique, "OBLIQUE")]);
        let shader_defs = flags.chain(samples::definitions(samples)).collect();
        let layout = if first {
            Self::first_layout(samples > 1)
        } else {
            Self::next_layout()
        };
        RenderPipelineDescriptor {
            label: Some("comics_ping_pong".into()),
            layout: vec![layout],
            vertex: self.fullscreen.to_vertex_state(),
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs,
                entry_point: Some("reduce".into()),
                targets: vec![Some(FORMAT.into())],
            }),
            ..Default::default()
        }
    }
}

/// The sizes of the textures T1, T2, ... of the chain, down to (2, 1), for a depth
/// texture of `size` pixels. Each has half as many column pairs and rows as the one
/// before, rounded up.
pub(crate) fn chain_sizes(size: UVec2) -> Vec<UVec2> {
    let mut sizes = vec![UVec2::new(
        2 * size.x.div_ceil(2).max(1),
        size.y.div_ceil(2).max(1),
    )];
    while let Some(&last) = sizes.last() {
        if last == UVec2::new(2, 1) {
            break;
        }
        sizes.push(UVec2::new(2 * last.x.div_ceil(4), last.y.div_ceil(2)));
    }
    sizes
}

/// The textures of a chain, from the engine's texture cache.
pub(crate) fn chain_textures(
    textures: &mut TextureCache,
    device: &RenderDevice,
    rect_size: UVec2,
) -> Vec<CachedTexture> {
    let usage =
        TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let described = |size| texture("comics_ping_pong", (size, 1), FORMAT, usage);
    let texture = |size| textures.get(device, described(size));
    chain_sizes(rect_size).into_iter().map(texture).collect()
}

/// What the first pass of a chain reads: the depth texture, and the view's uniform at
/// its offset in bytes.
pub(crate) struct ChainSource<'a> {
    pub depth: &'a TextureView,
    pub view: BindingResource<'a>,
    pub offset: u32,
    pub multisampled: bool,
}

/// Records all passes of a chain, then the copy of the result to `keys`.
pub(crate) fn record_chain(
    chain: &[CachedTexture],
    encoder: &mut CommandEncoder,
    binder: &Binder,
    (first, next): (&RenderPipeline, &RenderPipeline),
    (from, keys): (&ChainSource, &Buffer),
) {
    let mut source: Option<&TextureView> = None;
    for target in chain {
        let bind_group = match source {
            None => binder.group(
                "comics_ping_pong_first",
                &PingPongPipeline::first_layout(from.multisampled),
                &BindGroupEntries::sequential((from.depth, from.view.clone())),
            ),
            Some(view) => binder.group(
                "comics_ping_pong_next",
                &PingPongPipeline::next_layout(),
                &BindGroupEntries::single(view),
            ),
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_ping_pong"),
            color_attachments: &[Some(attachment(&target.default_view, LoadOp::default()))],
            ..Default::default()
        });
        if source.is_none() {
            pass.set_pipeline(first);
            pass.set_bind_group(0, &bind_group, &[from.offset]);
        } else {
            pass.set_pipeline(next);
            pass.set_bind_group(0, &bind_group, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        source = Some(&target.default_view);
    }
    if let Some(result) = chain.last() {
        copy_keys(encoder, result, keys);
    }
}

fn copy_keys(encoder: &mut CommandEncoder, result: &CachedTexture, keys: &Buffer) {
    encoder.copy_texture_to_buffer(
        result.texture.as_image_copy(),
        TexelCopyBufferInfo {
            buffer: keys,
            layout: TexelCopyBufferLayout::default(),
        },
        Extent3d {
            width: 2,
            ..default()
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_size_ends_at_two_by_one() {
        for width in 1..70 {
            for height in 1..70 {
                let sizes = chain_sizes(UVec2::new(width, height));
                assert_eq!(sizes.last(), Some(&UVec2::new(2, 1)), "{width}x{height}");
                assert!(
                    sizes.len() <= 9,
                    "{width}x{height} takes {} passes",
                    sizes.len()
                );
            }
        }
    }
}
