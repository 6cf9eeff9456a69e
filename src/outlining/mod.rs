//! The passes behind the outlines: one that finds edges, and for wide lines a
//! jump flood that tells every pixel its nearest line.

mod draw;
pub(crate) mod prepare;

pub(crate) use draw::find_outlines;

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::FullscreenShader,
    ecs::resource::Resource,
    math::UVec2,
    render::{
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntry, CachedRenderPipelineId,
            ColorTargetState, ColorWrites, Extent3d, FragmentState, RenderPipelineDescriptor,
            ShaderStages, SpecializedRenderPipeline, Texture, TextureDescriptor, TextureDimension,
            TextureFormat, TextureSampleType, TextureUsages, TextureView, TextureViewDescriptor,
            VertexState,
            binding_types::{
                storage_buffer_read_only_sized, texture_2d, texture_2d_multisampled,
                uniform_buffer, uniform_buffer_sized,
            },
        },
        renderer::RenderDevice,
    },
    shader::{Shader, ShaderDefVal},
};

use crate::{styles::EdgeForm, stylize::ComicsUniform, view::Plan};

/// Lines up to this far from their pixel, in pixels, are found by looking at
/// every pixel around; wider ones by a flood. Measured: see ARCHITECTURE.md.
pub(crate) const GATHER_REACH: i32 = 2;

const EDGE_FORMAT: TextureFormat = TextureFormat::Rgba16Uint;

/// How far around a pixel lines of this half width are looked for.
pub(crate) fn reach(half_width: f32) -> i32 {
    (half_width + 1.0).ceil() as i32 - 1
}

/// What is compiled into the pass that finds edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct OutlineKey {
    pub samples: u32,
    pub oblique: bool,
    pub silhouettes: bool,
    pub creases: bool,
    pub object_edges: bool,
    pub ids: bool,
    pub object_styles: bool,
    pub fading: bool,
    pub visible_range: bool,
    /// Forms of the silhouettes and the creases.
    pub faithful: [bool; 2],
    /// A pixel of the depth is a pixel of the picture.
    pub same_size: bool,
}

impl OutlineKey {
    pub fn new(plan: &Plan, samples: u32, oblique: bool) -> Option<Self> {
        let outlines = plan.outlines?;
        let fading = outlines.width_fade > 0.0 || outlines.opacity_fade > 0.0;
        Some(Self {
            samples,
            oblique,
            silhouettes: outlines.silhouettes.is_some(),
            creases: outlines.creases.is_some(),
            object_edges: outlines.objects.is_some(),
            ids: plan.draws_ids(),
            object_styles: plan.object_styles,
            fading,
            visible_range: fading && plan.depth_map.mapping.follows_visible_range(),
            faithful: [
                outlines.silhouettes.map(|s| s.form),
                outlines.creases.map(|c| c.form),
            ]
            .map(|form| form == Some(EdgeForm::Faithful)),
            same_size: true,
        })
    }

    fn shader_defs(&self) -> Vec<ShaderDefVal> {
        let number = |name: &str, on| ShaderDefVal::UInt(name.into(), u32::from(on));
        let forms = [
            number("SILHOUETTE_FAITHFUL", self.faithful[0]),
            number("CREASE_FAITHFUL", self.faithful[1]),
        ];
        [
            (true, "DEPTH"),
            (true, "FORMS"),
            (self.same_size, "SAME_SIZE"),
            (self.samples > 1, "MULTISAMPLED"),
            (self.oblique, "OBLIQUE"),
            (self.silhouettes, "SILHOUETTES"),
            (self.creases, "CREASES"),
            (self.object_edges, "OBJECT_EDGES"),
            (self.ids, "OBJECT_IDS"),
            (self.object_styles, "OBJECT_STYLES"),
            (self.fading, "FADING"),
            (self.visible_range, "VISIBLE_RANGE"),
        ]
        .into_iter()
        .filter(|(on, _)| *on)
        .map(|(_, name)| name.into())
        .chain(forms)
        .collect()
    }

    fn layout(&self) -> BindGroupLayoutDescriptor {
        let stages = ShaderStages::FRAGMENT;
        let texture = |sample_type| {
            if self.samples > 1 {
                texture_2d_multisampled(sample_type)
            } else {
                texture_2d(sample_type)
            }
        };
        let float = TextureSampleType::Float { filterable: false };
        let mut entries = vec![
            uniform_buffer::<ComicsUniform>(true).build(1, stages),
            texture(float).build(2, stages),
        ];
        if self.visible_range {
            entries.push(range_entry());
        }
        if self.object_styles {
            entries.push(object_styles_entry());
        }
        if self.creases {
            entries.push(texture(float).build(7, stages));
        }
        if self.ids {
            entries.push(ids_entry(self.samples > 1));
        }
        BindGroupLayoutDescriptor::new("comics_outlines", &entries)
    }
}

/// The layout entry of the visible range, everywhere.
pub(crate) fn range_entry() -> BindGroupLayoutEntry {
    let size = std::num::NonZeroU64::new(16);
    uniform_buffer_sized(false, size).build(3, ShaderStages::FRAGMENT)
}

/// The layout entry of a texture of edges or lines.
pub(crate) fn edges_entry(binding: u32) -> BindGroupLayoutEntry {
    texture_2d(TextureSampleType::Uint).build(binding, ShaderStages::FRAGMENT)
}

/// The layout entry of the objects' ids.
pub(crate) fn ids_entry(multisampled: bool) -> BindGroupLayoutEntry {
    let texture = if multisampled {
        texture_2d_multisampled(TextureSampleType::Uint)
    } else {
        texture_2d(TextureSampleType::Uint)
    };
    texture.build(8, ShaderStages::FRAGMENT)
}

/// The layout entry of the objects' styles.
pub(crate) fn object_styles_entry() -> BindGroupLayoutEntry {
    let size = std::num::NonZeroU64::new(32);
    storage_buffer_read_only_sized(false, size).build(6, ShaderStages::FRAGMENT)
}

#[derive(Resource)]
pub(crate) struct OutlinePipeline {
    fullscreen: FullscreenShader,
    detect: Handle<Shader>,
}

impl OutlinePipeline {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            detect: load_embedded_asset!(assets, "detect.wgsl"),
        }
    }
}

fn edge_target() -> Vec<Option<ColorTargetState>> {
    vec![Some(ColorTargetState {
        format: EDGE_FORMAT,
        blend: None,
        write_mask: ColorWrites::ALL,
    })]
}

impl SpecializedRenderPipeline for OutlinePipeline {
    type Key = OutlineKey;

    fn specialize(&self, key: OutlineKey) -> RenderPipelineDescriptor {
        RenderPipelineDescriptor {
            label: Some("comics_outlines".into()),
            layout: vec![key.layout()],
            vertex: self.fullscreen.to_vertex_state(),
            fragment: Some(FragmentState {
                shader: self.detect.clone(),
                shader_defs: key.shader_defs(),
                entry_point: Some("detect".into()),
                targets: edge_target(),
            }),
            ..Default::default()
        }
    }
}

#[derive(Resource)]
pub(crate) struct FloodPipeline {
    shader: Handle<Shader>,
}

impl FloodPipeline {
    pub fn new(assets: &AssetServer) -> Self {
        Self {
            shader: load_embedded_asset!(assets, "flood.wgsl"),
        }
    }

    fn layout(first: bool) -> BindGroupLayoutDescriptor {
        BindGroupLayoutDescriptor::new(
            "comics_line_flood",
            &[
                uniform_buffer::<ComicsUniform>(true).build(1, ShaderStages::FRAGMENT),
                edges_entry(if first { 4 } else { 5 }),
            ],
        )
    }
}

impl SpecializedRenderPipeline for FloodPipeline {
    /// Whether it is the first step, which reads the edges.
    type Key = bool;

    fn specialize(&self, first: bool) -> RenderPipelineDescriptor {
        let shader_defs: Vec<ShaderDefVal> = if first {
            vec!["EDGES".into(), "FIRST".into()]
        } else {
            vec!["FLOOD".into()]
        };
        RenderPipelineDescriptor {
            label: Some("comics_line_flood".into()),
            layout: vec![Self::layout(first)],
            vertex: VertexState {
                shader: self.shader.clone(),
                shader_defs: shader_defs.clone(),
                entry_point: Some("flood_vertex".into()),
                buffers: vec![],
            },
            fragment: Some(FragmentState {
                shader: self.shader.clone(),
                shader_defs,
                entry_point: Some("flood".into()),
                targets: edge_target(),
            }),
            ..Default::default()
        }
    }
}

/// A texture that a view's passes write and read.
pub(crate) struct ViewTexture {
    pub texture: Texture,
    pub view: TextureView,
}

impl ViewTexture {
    pub fn new(
        device: &RenderDevice,
        label: &str,
        size: UVec2,
        samples: u32,
        format: TextureFormat,
    ) -> Self {
        let texture = device.create_texture(&TextureDescriptor {
            label: Some(label),
            size: Extent3d {
                width: size.x,
                height: size.y,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: samples,
            dimension: TextureDimension::D2,
            format,
            usage: TextureUsages::RENDER_ATTACHMENT
                | TextureUsages::TEXTURE_BINDING
                | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&TextureViewDescriptor::default());
        Self { texture, view }
    }

    pub fn fits(&self, size: UVec2, samples: u32) -> bool {
        let own = self.texture.size();
        UVec2::new(own.width, own.height) == size && self.texture.sample_count() == samples
    }
}

/// The outlines of one view, this frame.
pub(crate) struct OutlinePass {
    pub key: OutlineKey,
    pub pipeline: CachedRenderPipelineId,
    pub edges: ViewTexture,
    pub flood: Option<FloodPass>,
}

/// The flood: a first step and one for each stride, between two textures.
pub(crate) struct FloodPass {
    pub first: CachedRenderPipelineId,
    pub next: CachedRenderPipelineId,
    pub strides: Vec<u32>,
    pub textures: [ViewTexture; 2],
}

impl FloodPass {
    /// The strides that carry a line this far, in pixels; the last two once
    /// more, which mends nearly all that a flood gets wrong.
    pub fn strides(reach: i32) -> Vec<u32> {
        let longest = (reach.max(1) as u32).next_power_of_two();
        let halving = (0..=longest.ilog2()).rev().map(|k| 1 << k);
        let again = [2, 1].into_iter().filter(|_| reach > GATHER_REACH);
        halving.chain(again).collect()
    }

    /// Where the last step writes.
    pub fn result(&self) -> &ViewTexture {
        &self.textures[self.strides.len() % 2]
    }
}
