//! The pipelines that find lines and draw their ink.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::FullscreenShader,
    ecs::resource::Resource,
    render::render_resource::{
        BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
        ComputePipelineDescriptor, FragmentState, PrimitiveState,
        PrimitiveTopology::{TriangleList, TriangleStrip},
        RenderPipelineDescriptor, SpecializedComputePipeline, SpecializedRenderPipeline,
        TextureFormat, VertexState,
    },
    shader::Shader,
};

use super::key::{CRACK_FORMAT, INK_FORMAT, LineKey};

/// The shaders of the passes.
#[derive(Resource)]
pub(crate) struct LineShaders {
    fullscreen: FullscreenShader,
    walk: Handle<Shader>,
    find: Handle<Shader>,
    columns: Handle<Shader>,
    faithful: Handle<Shader>,
    draw: Handle<Shader>,
}

impl LineShaders {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            walk: load_embedded_asset!(assets, "walk.wgsl"),
            find: load_embedded_asset!(assets, "find.wgsl"),
            columns: load_embedded_asset!(assets, "columns.wgsl"),
            faithful: load_embedded_asset!(assets, "faithful.wgsl"),
            draw: load_embedded_asset!(assets, "draw.wgsl"),
        }
    }
}

/// The search for blocks with cracks.
impl SpecializedComputePipeline for LineShaders {
    type Key = LineKey;

    fn specialize(&self, key: LineKey) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_walk".into()),
            layout: vec![key.walk_layout()],
            shader: self.walk.clone(),
            shader_defs: key.find_defs(),
            entry_point: Some("walk".into()),
            ..Default::default()
        }
    }
}

/// The passes that are render passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LinePass {
    Find,
    Columns,
    Faithful,
    Draw,
}

impl SpecializedRenderPipeline for LineShaders {
    type Key = (LinePass, LineKey);

    fn specialize(&self, (pass, key): (LinePass, LineKey)) -> RenderPipelineDescriptor {
        let (shader, layout, defs) = match pass {
            LinePass::Find => (&self.find, key.find_layout(), key.find_defs()),
            LinePass::Columns => (&self.columns, key.columns_layout(), key.draw_defs()),
            LinePass::Faithful => (&self.faithful, key.faithful_layout(), key.faithful_defs()),
            LinePass::Draw => (&self.draw, key.draw_layout(), key.draw_defs()),
        };
        let (label, entry, targets) = match pass {
            LinePass::Find => ("comics_find_lines", "find", CRACKS),
            LinePass::Columns => ("comics_line_columns", "columns", CRACKS),
            LinePass::Faithful => ("comics_faithful_lines", "faithful", INK),
            LinePass::Draw => ("comics_draw_lines", "draw", INK),
        };
        let tiles = VertexState {
            shader: shader.clone(),
            shader_defs: defs.clone(),
            entry_point: Some("tile".into()),
            buffers: vec![],
        };
        let (vertex, topology) = match pass {
            LinePass::Faithful => (self.fullscreen.to_vertex_state(), TriangleList),
            LinePass::Find | LinePass::Columns | LinePass::Draw => (tiles, TriangleStrip),
        };
        RenderPipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout],
            vertex,
            primitive: PrimitiveState {
                topology,
                ..Default::default()
            },
            fragment: Some(FragmentState {
                shader: shader.clone(),
                shader_defs: defs,
                entry_point: Some(entry.into()),
                targets: vec![Some(targets)],
            }),
            ..Default::default()
        }
    }
}

/// Of the ink of two passes, the larger is kept.
const MAXIMUM: BlendState = {
    let larger = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Max,
    };
    BlendState {
        color: larger,
        alpha: larger,
    }
};

const fn target(format: TextureFormat, blend: Option<BlendState>) -> ColorTargetState {
    ColorTargetState {
        format,
        blend,
        write_mask: ColorWrites::ALL,
    }
}

/// The target of the passes that write cracks.
const CRACKS: ColorTargetState = target(CRACK_FORMAT, None);
/// The target of the passes that draw ink.
const INK: ColorTargetState = target(INK_FORMAT, Some(MAXIMUM));
