//! The history of lines under temporal anti-aliasing: see `accumulate.wgsl`.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::FullscreenShader,
    ecs::resource::Resource,
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, CommandEncoder, FragmentState,
            IntoBinding, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor,
            ShaderStages, SpecializedRenderPipeline, TextureFormat, TextureSampleType,
            TextureUsages, TextureViewDescriptor,
            binding_types::{texture_2d, uniform_buffer},
        },
        renderer::RenderDevice,
        texture::CachedTexture,
    },
    shader::{Shader, ShaderDefVal},
};

use crate::{
    gpu::entry,
    lines::{
        request::{HistoryRequest, LinePassUniform},
        settings::Outlines,
        textures::{cleared, descriptor},
        tiles::{TileList, TileLists, tile_shader, vertices},
    },
};

/// Ink, finer than that of a frame: small steps towards it are not lost.
const INK_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// A raw depth, and a number of frames.
const DEPTH_FORMAT: TextureFormat = TextureFormat::Rg32Float;

/// Selects the variant of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct HistoryKey {
    pub oblique: bool,
    /// Only the tiles with ink are drawn.
    pub tiled: bool,
}

impl HistoryKey {
    pub fn layout() -> BindGroupLayoutDescriptor {
        let stages = ShaderStages::FRAGMENT;
        let float = |binding| {
            texture_2d(TextureSampleType::Float { filterable: false }).build(binding, stages)
        };
        let entries = [
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
            float(2),
            float(23),
            float(24),
            float(25),
            float(26),
        ];
        BindGroupLayoutDescriptor::new("comics_accumulate_lines", &entries)
    }

    fn defs(self) -> Vec<ShaderDefVal> {
        let oblique = self.oblique.then(|| "OBLIQUE".into());
        ["DEPTH".into()].into_iter().chain(oblique).collect()
    }
}

#[derive(Resource)]
pub(crate) struct HistoryPipeline {
    fullscreen: FullscreenShader,
    tile: Handle<Shader>,
    shader: Handle<Shader>,
}

impl HistoryPipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            tile: tile_shader(assets),
            shader: load_embedded_asset!(assets, "accumulate.wgsl"),
        }
    }
}

impl SpecializedRenderPipeline for HistoryPipeline {
    type Key = HistoryKey;

    fn specialize(&self, key: HistoryKey) -> RenderPipelineDescriptor {
        let (vertex, primitive) = vertices(key.tiled, &self.fullscreen, &self.tile);
        RenderPipelineDescriptor {
            label: Some("comics_accumulate_lines".into()),
            layout: vec![HistoryKey::layout()],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.defs(),
                entry_point: Some("accumulate".into()),
                targets: [INK_FORMAT, DEPTH_FORMAT]
                    .map(|format| Some(format.into()))
                    .to_vec(),
            }),
            ..Default::default()
        }
    }
}

/// The ink of a frame, and the nearest depth around each of its pixels.
struct Frame {
    ink: CachedTexture,
    depth: CachedTexture,
}

/// The history of a view.
pub(crate) struct LineHistory {
    size: UVec2,
    /// This frame and the one before.
    frames: [Frame; 2],
    cuts: u32,
    settings: Outlines,
    /// Whether it is empty.
    pub is_new: bool,
}

impl LineHistory {
    /// The history for the next frame. `kept`: whether that of the last frame was drawn.
    pub fn next(
        before: Option<Self>,
        kept: bool,
        device: &RenderDevice,
        (request, size, settings): (&HistoryRequest, UVec2, &Outlines),
    ) -> Self {
        if let Some(mut before) = before.filter(|before| before.size == size) {
            before.frames.swap(0, 1);
            // Other settings are seen at once.
            let same = before.cuts == request.cuts && before.settings == *settings;
            before.is_new = !kept || !same;
            before.cuts = request.cuts;
            before.settings = *settings;
            return before;
        }
        let frame = || Frame {
            ink: texture(device, "comics_history_ink", size, INK_FORMAT),
            depth: texture(device, "comics_history_depth", size, DEPTH_FORMAT),
        };
        Self {
            size,
            frames: [frame(), frame()],
            cuts: request.cuts,
            settings: *settings,
            is_new: true,
        }
    }

    /// The ink of this frame.
    pub fn ink(&self) -> &CachedTexture {
        &self.frames[0].ink
    }

    /// The bindings of the last frame.
    pub fn entries(&self) -> [BindGroupEntry<'_>; 2] {
        let past = &self.frames[1];
        [
            entry(25, (&past.ink.default_view).into_binding()),
            entry(26, (&past.depth.default_view).into_binding()),
        ]
    }

    /// Records the pass. `tiles`: those with ink; `None`: all pixels are drawn.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        (pipeline, group): (&RenderPipeline, &BindGroup),
        tiles: Option<&TileLists>,
    ) {
        let [now, _] = &self.frames;
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_accumulate_lines"),
            color_attachments: &[Some(cleared(&now.ink)), Some(cleared(&now.depth))],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        match tiles {
            Some(tiles) => tiles.draw(&mut pass, TileList::Inked),
            None => pass.draw(0..3, 0..1),
        }
    }
}

/// A texture that is not given back to the engine's cache after the frame.
fn texture(
    device: &RenderDevice,
    label: &'static str,
    size: UVec2,
    format: TextureFormat,
) -> CachedTexture {
    let drawn = TextureUsages::RENDER_ATTACHMENT;
    let texture = device.create_texture(&descriptor(label, size, (format, drawn)));
    let default_view = texture.create_view(&TextureViewDescriptor::default());
    CachedTexture {
        texture,
        default_view,
    }
}
