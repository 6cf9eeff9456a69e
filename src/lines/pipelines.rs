//! The pipelines that find lines and draw their ink.

use bevy::{
    asset::{AssetServer, Handle, load_embedded_asset},
    core_pipeline::FullscreenShader,
    ecs::resource::Resource,
    render::render_resource::{
        BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
        ComputePipelineDescriptor, FragmentState, PrimitiveTopology, RenderPipelineDescriptor,
        SpecializedComputePipeline, SpecializedRenderPipeline, TextureFormat, VertexState,
    },
    shader::Shader,
};

use crate::gpu::definitions;

use super::{
    draw::stroke_layout,
    key::LineKey,
    textures::{COLUMN_FORMAT, CRACK_FORMAT, INK_FORMAT, OWNER_FORMAT},
    tiles::{tile_shader, vertices},
};

/// The shaders of the passes.
#[derive(Resource)]
pub(crate) struct LineShaders {
    fullscreen: FullscreenShader,
    walk: Handle<Shader>,
    cells: Handle<Shader>,
    link: Handle<Shader>,
    join: Handle<Shader>,
    hold: Handle<Shader>,
    close_gaps: Handle<Shader>,
    ends: Handle<Shader>,
    strokes: Handle<Shader>,
    density: Handle<Shader>,
    corners: Handle<Shader>,
    settle: Handle<Shader>,
    tiles: Handle<Shader>,
    tile: Handle<Shader>,
    find: Handle<Shader>,
    columns: Handle<Shader>,
    faithful: Handle<Shader>,
    draw: Handle<Shader>,
}

impl LineShaders {
    pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
        Self {
            fullscreen: fullscreen.clone(),
            walk: load_embedded_asset!(assets, "find/walk.wgsl"),
            cells: load_embedded_asset!(assets, "find/cells.wgsl"),
            link: load_embedded_asset!(assets, "link/link.wgsl"),
            join: load_embedded_asset!(assets, "link/join.wgsl"),
            hold: load_embedded_asset!(assets, "history/hold.wgsl"),
            close_gaps: load_embedded_asset!(assets, "link/close_gaps.wgsl"),
            ends: load_embedded_asset!(assets, "draw/ends.wgsl"),
            strokes: load_embedded_asset!(assets, "draw/strokes.wgsl"),
            density: load_embedded_asset!(assets, "link/density.wgsl"),
            corners: load_embedded_asset!(assets, "link/corners.wgsl"),
            settle: load_embedded_asset!(assets, "link/settle.wgsl"),
            tiles: load_embedded_asset!(assets, "tiles/tiles.wgsl"),
            tile: tile_shader(assets),
            find: load_embedded_asset!(assets, "find/find.wgsl"),
            columns: load_embedded_asset!(assets, "draw/columns.wgsl"),
            faithful: load_embedded_asset!(assets, "find/faithful.wgsl"),
            draw: load_embedded_asset!(assets, "draw/draw.wgsl"),
        }
    }
}

/// The passes that are compute passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SearchPass {
    /// Looks for blocks with cracks or jumps, and lists the cells with cracks.
    Walk(LineKey),
    /// Lists the tiles near these blocks.
    Tiles,
    /// Finds the cracks in the cells.
    Cells(LineKey),
    /// Continues lines along weak cracks; the last pass by the steps that are left.
    Link { last: bool },
    /// Joins lines over faces that are thinner than a pixel.
    Join,
    /// Keeps the lines of the last frames.
    Hold(LineKey),
    /// Closes gaps in lines.
    CloseGaps,
    /// Measures how densely lines lie in small squares, or in large ones.
    Measure { coarse: bool },
    /// Notes which cracks meet at corners.
    Corners,
    /// Completes the cracks in the cells.
    Settle(LineKey),
    /// Finds the loose ends of lines.
    Ends(LineKey),
}

impl SpecializedComputePipeline for LineShaders {
    type Key = SearchPass;

    fn specialize(&self, pass: SearchPass) -> ComputePipelineDescriptor {
        let (label, entry, shader) = match pass {
            SearchPass::Walk(_) => ("comics_walk", "walk", &self.walk),
            SearchPass::Tiles => ("comics_list_tiles", "list_tiles", &self.tiles),
            SearchPass::Cells(_) => ("comics_find_in_cells", "find_in_cells", &self.cells),
            SearchPass::Link { .. } => ("comics_link_lines", "link", &self.link),
            SearchPass::Join => ("comics_join_lines", "join", &self.join),
            SearchPass::Hold(_) => ("comics_hold_lines", "hold_lines", &self.hold),
            SearchPass::Ends(_) => ("comics_line_ends", "ends", &self.ends),
            SearchPass::CloseGaps => ("comics_close_gaps", "close_gaps", &self.close_gaps),
            SearchPass::Measure { .. } => ("comics_measure_lines", "measure", &self.density),
            SearchPass::Corners => ("comics_line_corners", "corners", &self.corners),
            SearchPass::Settle(_) => ("comics_settle_lines", "settle", &self.settle),
        };
        let (layout, shader_defs) = match pass {
            SearchPass::Walk(key) => (key.walk_layout(), key.defs()),
            SearchPass::Tiles => (LineKey::tiles_layout(), vec![]),
            SearchPass::Cells(key) => (key.cells_layout(), key.defs()),
            SearchPass::Link { last } => (
                LineKey::link_layout(),
                definitions([(last, "LAST")]).collect(),
            ),
            SearchPass::Measure { coarse } => (
                LineKey::measure_layout(),
                definitions([(coarse, "COARSE")]).collect(),
            ),
            SearchPass::Join => (LineKey::link_layout(), vec![]),
            SearchPass::Hold(key) => (key.hold_layout(), key.defs()),
            SearchPass::Ends(key) => (LineKey::ends_layout(), key.defs()),
            SearchPass::CloseGaps => (LineKey::gaps_layout(), vec![]),
            SearchPass::Corners => (LineKey::corners_layout(), vec![]),
            SearchPass::Settle(key) => (key.settle_layout(), key.defs()),
        };
        ComputePipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout],
            shader: shader.clone(),
            shader_defs,
            entry_point: Some(entry.into()),
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
    Strokes,
}

impl LinePass {
    /// The part of a key that the pass depends on.
    pub fn part(self, key: LineKey) -> LineKey {
        match self {
            Self::Find => key.for_find(),
            Self::Columns => key.for_columns(),
            Self::Faithful => key.for_faithful(),
            Self::Draw => key.for_draw(),
            Self::Strokes => key.for_strokes(),
        }
    }
}

impl SpecializedRenderPipeline for LineShaders {
    type Key = (LinePass, LineKey);

    fn specialize(&self, (pass, key): (LinePass, LineKey)) -> RenderPipelineDescriptor {
        let (shader, layout) = match pass {
            LinePass::Find => (&self.find, key.find_layout()),
            LinePass::Columns => (&self.columns, key.columns_layout()),
            LinePass::Faithful => (&self.faithful, key.faithful_layout()),
            LinePass::Draw => (&self.draw, key.draw_layout()),
            LinePass::Strokes => (&self.strokes, key.strokes_layout()),
        };
        let (label, entry, targets) = match pass {
            LinePass::Find => ("comics_find_lines", "find", CRACKS),
            LinePass::Columns => ("comics_line_columns", "columns", COLUMNS),
            LinePass::Faithful => ("comics_faithful_lines", "faithful", INK),
            LinePass::Draw => ("comics_draw_lines", "draw", INK),
            LinePass::Strokes => ("comics_line_strokes", "stroke", INK),
        };
        let defs = key.defs();
        // The pass that draws ink has this target too; the faithful equations do not write it.
        let owners = Some(ColorTargetState {
            write_mask: match pass {
                LinePass::Draw | LinePass::Strokes => ColorWrites::ALL,
                _ => ColorWrites::empty(),
            },
            ..target(OWNER_FORMAT, None)
        });
        let inks = !matches!(pass, LinePass::Find | LinePass::Columns);
        let count = 1 + usize::from(inks && key.contains(LineKey::SURFACE));
        let tiled = key.contains(LineKey::BLOCKS);
        let (mut vertex, mut primitive) = vertices(tiled, &self.fullscreen, &self.tile);
        if pass == LinePass::Strokes {
            vertex = VertexState {
                shader: shader.clone(),
                shader_defs: defs.clone(),
                entry_point: Some("corner".into()),
                buffers: vec![stroke_layout()],
            };
            primitive.topology = PrimitiveTopology::TriangleStrip;
        }
        RenderPipelineDescriptor {
            label: Some(label.into()),
            layout: vec![layout],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: shader.clone(),
                shader_defs: defs,
                entry_point: Some(entry.into()),
                targets: [Some(targets), owners].into_iter().take(count).collect(),
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

/// The target of the pass that writes cracks.
const CRACKS: ColorTargetState = target(CRACK_FORMAT, None);
/// The target of the pass that searches columns.
const COLUMNS: ColorTargetState = target(COLUMN_FORMAT, None);
/// The target of the passes that draw ink.
const INK: ColorTargetState = target(INK_FORMAT, Some(MAXIMUM));
