//! The pass that picks one sample of every pixel of a multisampled view: see
//! `resolve.wgsl`.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::{FullscreenShader, prepass::NORMAL_PREPASS_FORMAT},
    ecs::resource::Resource,
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, BindGroupLayoutDescriptor, CommandEncoder, FragmentState,
            RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderStages,
            SpecializedRenderPipeline, TextureFormat, TextureUsages, binding_types::uniform_buffer,
        },
        renderer::RenderDevice,
        texture::{CachedTexture, TextureCache},
    },
    shader::{Shader, ShaderDefVal},
};

use crate::{
    gpu::{UNFILTERABLE, definitions, sampled},
    lines::{
        key::LineKey,
        request::{LinePassUniform, LineRequest},
        textures::{cleared, texture},
    },
    objects::{ID_FORMAT, WIDTH_FORMAT, ids_entry, widths_entry},
    samples,
};

/// A texel of the engine's depth prepass, which is a `Depth32Float`.
const DEPTH_FORMAT: TextureFormat = TextureFormat::R32Float;

/// Selects the variant of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ResolveKey {
    samples: u32,
    oblique: bool,
    /// Whether the normals, the object ids and the widths of lines are read.
    pub normals: bool,
    pub ids: bool,
    pub widths: bool,
}

impl ResolveKey {
    pub fn new(key: LineKey, samples: u32) -> Self {
        let lit = LineKey::LIGHT_WEIGHT | LineKey::LIT_EDGES;
        let normals = LineKey::NORMALS | LineKey::FAITHFUL_CREASES | lit;
        Self {
            samples,
            oblique: key.contains(LineKey::OBLIQUE),
            normals: key.intersects(normals),
            ids: key.contains(LineKey::OBJECT_IDS),
            widths: key.contains(LineKey::WIDTH_MAP),
        }
    }

    /// Formats by `@location`; `None`: it is not written.
    fn formats(self) -> [Option<TextureFormat>; 4] {
        [
            Some(DEPTH_FORMAT),
            self.normals.then_some(NORMAL_PREPASS_FORMAT),
            self.ids.then_some(ID_FORMAT),
            self.widths.then_some(WIDTH_FORMAT),
        ]
    }

    pub fn layout(self) -> BindGroupLayoutDescriptor {
        let stages = ShaderStages::FRAGMENT;
        let float = || sampled(true, UNFILTERABLE);
        let mut entries = vec![
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
            float().build(2, stages),
        ];
        if self.normals {
            entries.push(float().build(7, stages));
        }
        if self.ids {
            entries.push(ids_entry(true));
        }
        if self.widths {
            entries.push(widths_entry(true, stages));
        }
        BindGroupLayoutDescriptor::new("comics_resolve_samples", &entries)
    }

    fn defs(self) -> Vec<ShaderDefVal> {
        definitions([
            (true, "DEPTH"),
            (self.oblique, "OBLIQUE"),
            (self.normals, "NORMALS"),
            (self.ids, "OBJECT_IDS"),
            (self.widths, "WIDTH_MAP"),
        ])
        .chain(samples::definitions(self.samples))
        .collect()
    }
}

#[derive(Resource)]
pub(crate) struct ResolvePipeline {
    fullscreen: FullscreenShader,
    shader: Handle<Shader>,
}

impl ResolvePipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            shader: load_embedded_asset!(assets, "resolve.wgsl"),
        }
    }
}

impl SpecializedRenderPipeline for ResolvePipeline {
    type Key = ResolveKey;

    fn specialize(&self, key: ResolveKey) -> RenderPipelineDescriptor {
        RenderPipelineDescriptor {
            label: Some("comics_resolve_samples".into()),
            layout: vec![key.layout()],
            vertex: self.fullscreen.to_vertex_state(),
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs: key.defs(),
                entry_point: Some("resolve".into()),
                targets: key.formats().map(|format| format.map(Into::into)).to_vec(),
            }),
            ..Default::default()
        }
    }
}

/// One sample per pixel of the prepass textures, valid inside [`LineRequest::rect`].
pub(crate) struct Resolved {
    pub depth: CachedTexture,
    pub normal: Option<CachedTexture>,
    pub ids: Option<CachedTexture>,
    pub widths: Option<CachedTexture>,
}

impl Resolved {
    /// Gets the textures of this frame. `size`: that of the depth texture.
    pub fn new(
        (textures, device): (&mut TextureCache, &RenderDevice),
        key: ResolveKey,
        size: UVec2,
    ) -> Self {
        let [_, normal, ids, widths] = key.formats();
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let mut new = |label, format| texture((textures, device), label, size, (format, drawn));
        Self {
            depth: new("comics_resolved_depth", DEPTH_FORMAT),
            normal: normal.map(|format| new("comics_resolved_normals", format)),
            ids: ids.map(|format| new("comics_resolved_ids", format)),
            widths: widths.map(|format| new("comics_resolved_widths", format)),
        }
    }

    /// Records the pass.
    pub fn record(
        &self,
        encoder: &mut CommandEncoder,
        request: &LineRequest,
        (pipeline, group): (&RenderPipeline, &BindGroup),
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_resolve_samples"),
            color_attachments: &[
                Some(cleared(&self.depth)),
                self.normal.as_ref().map(cleared),
                self.ids.as_ref().map(cleared),
                self.widths.as_ref().map(cleared),
            ],
            ..Default::default()
        });
        let [x, y, width, height] = request.rect.to_array().map(|v| v as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
