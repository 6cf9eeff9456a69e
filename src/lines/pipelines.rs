//! The pipelines that find edges and flood wide lines.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::FullscreenShader,
    ecs::resource::Resource,
    math::{UVec4, Vec2},
    render::render_resource::{
        BindGroupLayoutDescriptor, BindGroupLayoutEntry, ColorTargetState, ColorWrites,
        FragmentState, RenderPipelineDescriptor, ShaderStages, ShaderType,
        SpecializedRenderPipeline, TextureFormat, TextureSampleType, VertexState,
        binding_types::{
            texture_2d, texture_2d_multisampled, uniform_buffer, uniform_buffer_sized,
        },
    },
    shader::{Shader, ShaderDefVal},
};

use super::request::{LinePassUniform, LineRequest};
use crate::{
    objects::{ids_entry, object_styles_entry},
    settings::Form,
};

/// Up to this reach, in physical pixels, the fused pass finds lines by reading every
/// pixel around; beyond it a flood is faster, as measured in `ARCHITECTURE.md`.
pub(crate) const GATHER_REACH: i32 = 2;

pub(crate) const EDGE_FORMAT: TextureFormat = TextureFormat::Rgba16Uint;

/// Distance within which lines of this half width are searched around a pixel, both in
/// physical pixels.
pub(crate) fn reach(half_width: f32) -> i32 {
    (half_width + 1.0).ceil() as i32 - 1
}

/// What selects a shader variant of the pass that finds edges.
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
    /// Whether silhouettes and creases have the faithful form.
    pub faithful: [bool; 2],
    /// The depth texture has one pixel per pixel of the viewport.
    pub same_size: bool,
}

impl OutlineKey {
    pub fn new(request: &LineRequest) -> Self {
        let lines = &request.settings;
        Self {
            samples: request.samples,
            oblique: request.oblique,
            silhouettes: lines.silhouettes.is_some(),
            creases: lines.creases.is_some(),
            object_edges: lines.objects.is_some(),
            ids: request.ids,
            object_styles: request.object_styles,
            fading: lines.fades(),
            visible_range: lines.fades() && request.visible_range,
            faithful: [
                lines.silhouettes.map(|s| s.form),
                lines.creases.map(|c| c.form),
            ]
            .map(|form| form == Some(Form::Faithful)),
            same_size: request.view.depth_scale == Vec2::ONE,
        }
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
            (self.creases, "NORMALS"),
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

    pub fn layout(&self) -> BindGroupLayoutDescriptor {
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
            uniform_buffer::<LinePassUniform>(false).build(1, stages),
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

/// The layout entry of the visible range, the same in all passes.
pub(crate) fn range_entry() -> BindGroupLayoutEntry {
    uniform_buffer_sized(false, Some(UVec4::min_size())).build(3, ShaderStages::FRAGMENT)
}

/// The layout entry of the texture of edges or of the flood.
pub(crate) fn edges_entry(binding: u32) -> BindGroupLayoutEntry {
    texture_2d(TextureSampleType::Uint).build(binding, ShaderStages::FRAGMENT)
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

    pub fn layout(first: bool) -> BindGroupLayoutDescriptor {
        BindGroupLayoutDescriptor::new(
            "comics_line_flood",
            &[
                uniform_buffer::<LinePassUniform>(false).build(1, ShaderStages::FRAGMENT),
                edges_entry(if first { 4 } else { 5 }),
            ],
        )
    }
}

impl SpecializedRenderPipeline for FloodPipeline {
    /// Whether it is the first step, which reads edges instead of flooded lines.
    type Key = bool;

    fn specialize(&self, first: bool) -> RenderPipelineDescriptor {
        let shader_defs: Vec<ShaderDefVal> = if first {
            vec!["FIRST".into()]
        } else {
            Vec::new()
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
