//! The pipelines that find lines and draw their ink.

use bevy::{
    asset::{embedded_asset, load_embedded_asset},
    core_pipeline::FullscreenShader,
    prelude::*,
    render::render_resource::{
        BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
        ComputePipelineDescriptor, FragmentState, PrimitiveTopology, RenderPipelineDescriptor,
        SpecializedComputePipeline, SpecializedRenderPipeline, TextureFormat, VertexState,
    },
};

use crate::{gpu::definitions, samples};

use super::{
    draw::stroke_layout,
    find::resolved_formats,
    history::HISTORY_FORMATS,
    key::{LineKey, LinePass, SearchPass},
    textures::{COLUMN_FORMAT, CRACK_FORMAT, INK_FORMAT, OWNER_FORMAT},
    tiles::{tile_shader, vertices},
};

macro_rules! line_shaders {
    ($($name:ident: $path:literal,)*) => {
        /// The shaders of the passes.
        #[derive(Resource)]
        pub(crate) struct LineShaders {
            fullscreen: FullscreenShader,
            tile: Handle<Shader>,
            $($name: Handle<Shader>,)*
        }

        impl LineShaders {
            pub fn new(fullscreen: &FullscreenShader, assets: &AssetServer) -> Self {
                Self {
                    fullscreen: fullscreen.clone(),
                    tile: tile_shader(assets),
                    $($name: load_embedded_asset!(assets, $path),)*
                }
            }

            pub fn embed(app: &mut App) {
                $(embedded_asset!(app, $path);)*
            }
        }
    };
}

line_shaders! {
    walk: "find/walk.wgsl",
    cells: "find/cells.wgsl",
    link: "link/link.wgsl",
    join: "link/join.wgsl",
    hold: "history/hold.wgsl",
    close_gaps: "link/close_gaps.wgsl",
    ends: "draw/ends.wgsl",
    strokes: "draw/strokes.wgsl",
    density: "link/density.wgsl",
    corners: "link/corners.wgsl",
    settle: "link/settle.wgsl",
    tiles: "tiles/tiles.wgsl",
    resolve: "find/resolve.wgsl",
    find: "find/find.wgsl",
    columns: "draw/columns.wgsl",
    faithful: "find/faithful.wgsl",
    draw: "draw/draw.wgsl",
    accumulate: "history/accumulate.wgsl",
}

impl SpecializedComputePipeline for LineShaders {
    type Key = SearchPass;

    fn specialize(&self, pass: SearchPass) -> ComputePipelineDescriptor {
        let (entry, shader) = match pass {
            SearchPass::Walk(_) => ("walk", &self.walk),
            SearchPass::Tiles => ("list_tiles", &self.tiles),
            SearchPass::Cells(_) => ("find_in_cells", &self.cells),
            SearchPass::Link { .. } => ("link", &self.link),
            SearchPass::Join => ("join", &self.join),
            SearchPass::Hold(_) => ("hold_lines", &self.hold),
            SearchPass::CloseGaps => ("close_gaps", &self.close_gaps),
            SearchPass::Measure { .. } => ("measure", &self.density),
            SearchPass::Corners => ("corners", &self.corners),
            SearchPass::Settle(_) => ("settle", &self.settle),
            SearchPass::Ends(_) => ("ends", &self.ends),
        };
        let flags = [
            (pass == SearchPass::Link { last: true }, "LAST"),
            (pass == SearchPass::Measure { coarse: true }, "COARSE"),
        ];
        ComputePipelineDescriptor {
            label: Some(pass.label().into()),
            layout: vec![pass.layout()],
            shader: shader.clone(),
            shader_defs: pass
                .key()
                .defs()
                .into_iter()
                .chain(definitions(flags))
                .collect(),
            entry_point: Some(entry.into()),
            ..Default::default()
        }
    }
}

impl LinePass {
    /// What the pass draws to; `None`: that is not written.
    fn targets(self, key: LineKey) -> Vec<Option<ColorTargetState>> {
        // The pass that draws ink has the second target too; the faithful equations do not write it.
        let inked = |write_mask| -> Vec<_> {
            let owners = ColorTargetState {
                write_mask,
                ..target(OWNER_FORMAT, None)
            };
            let owners = key.contains(LineKey::SURFACE).then_some(owners);
            let ink = target(INK_FORMAT, Some(MAXIMUM));
            [ink].into_iter().chain(owners).map(Some).collect()
        };
        let plain = |format| Some(target(format, None));
        match self {
            Self::Resolve { .. } => resolved_formats(key).map(|f| f.and_then(plain)).to_vec(),
            Self::Find => vec![plain(CRACK_FORMAT)],
            Self::Columns => vec![plain(COLUMN_FORMAT)],
            Self::Faithful => inked(ColorWrites::empty()),
            Self::Draw | Self::Strokes => inked(ColorWrites::ALL),
            Self::Accumulate { .. } => HISTORY_FORMATS.map(plain).to_vec(),
        }
    }
}

impl SpecializedRenderPipeline for LineShaders {
    type Key = (LinePass, LineKey);

    fn specialize(&self, (pass, key): (LinePass, LineKey)) -> RenderPipelineDescriptor {
        let (entry, shader) = match pass {
            LinePass::Resolve { .. } => ("resolve", &self.resolve),
            LinePass::Find => ("find", &self.find),
            LinePass::Columns => ("columns", &self.columns),
            LinePass::Faithful => ("faithful", &self.faithful),
            LinePass::Draw => ("draw", &self.draw),
            LinePass::Strokes => ("stroke", &self.strokes),
            LinePass::Accumulate { .. } => ("accumulate", &self.accumulate),
        };
        let mut defs = key.defs();
        if let LinePass::Resolve { samples } = pass {
            defs.extend(samples::definitions(samples));
        }
        let tiled = match pass {
            LinePass::Accumulate { tiled } => tiled,
            _ => key.contains(LineKey::BLOCKS),
        };
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
            label: Some(pass.label().into()),
            layout: vec![pass.layout(key)],
            vertex,
            primitive,
            fragment: Some(FragmentState {
                shader: shader.clone(),
                shader_defs: defs,
                entry_point: Some(entry.into()),
                targets: pass.targets(key),
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
