//! The service of lines. `resolve.wgsl` picks a sample of every pixel of a multisampled
//! view. `walk.wgsl` looks for cracks, the borders between pixels that lines run along, in
//! depth, normals and object ids; it lists the cells that have them, and `tiles.wgsl` the
//! tiles nearby. In the cells, `cells.wgsl` measures the cracks, `link.wgsl` continues lines
//! along weak ones, `join.wgsl` joins them over faces that are thinner than a pixel, `close_gaps.wgsl`
//! closes gaps, `density.wgsl` measures how densely they lie, `corners.wgsl` notes which cracks meet,
//! and `settle.wgsl` completes them. In the tiles, `columns.wgsl`, for wide lines, and `draw.wgsl` draw their ink into a texture. Effects read the ink with `read.wgsl`.

mod cracks;
mod draw;
mod find;
mod history;
mod key;
mod modifiers;
mod passes;
mod pipelines;
mod prepare;
mod record;
mod request;
mod settings;
mod textures;
mod tiles;

use bevy::{
    asset::embedded_asset,
    core_pipeline::{
        FullscreenShader,
        schedule::{Core3d, Core3dSystems},
    },
    prelude::*,
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup,
        render_resource::{SpecializedComputePipelines, SpecializedRenderPipelines},
    },
    shader::load_shader_library,
};

pub use cracks::ViewCracks;
pub use modifiers::{LineFade, LineLayers, LineModifiers, LineSimplification, Sheet};
pub use settings::{
    CreaseSource, Creases, EdgeColor, EdgeStyle, LineBoil, LineColor, LineEdge, LineFog,
    LineResponse, LineWeight, MapJumps, ObjectEdges, Outlines, Silhouettes,
};

pub(crate) use key::{ink_entry, owners_entry, range_entry};
pub(crate) use modifiers::{LineLayersUniform, SheetUniform};
pub(crate) use passes::{FindPass, LinePasses, LinePipelines};
pub(crate) use prepare::ViewLines;
#[cfg(feature = "objects")]
pub(crate) use record::HighlightKey;
pub(crate) use record::{HighlightPipeline, ViewHighlights, draw_highlights};
pub(crate) use request::{HistoryRequest, LineRequest};
pub(crate) use settings::{FogUniform, LinesUniform, ViewFog, has_fog};
pub(crate) use tiles::{TileList, TileLists, tile_shader, vertices};

use crate::schedule::{ComicsSystems, PrepareComics};
use pipelines::LineShaders;

/// Finds the lines of the views that request them.
pub(crate) fn build_render(app: &mut App) {
    load_shaders(app);
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedComputePipelines<LineShaders>>()
        .init_gpu_resource::<SpecializedRenderPipelines<LineShaders>>()
        .init_gpu_resource::<SpecializedRenderPipelines<HighlightPipeline>>()
        .add_systems(RenderStartup, init_pipelines)
        .add_systems(
            Render,
            prepare::prepare_view_lines.in_set(PrepareComics::Services),
        )
        .add_systems(
            Core3d,
            record::find_lines
                .in_set(ComicsSystems::Outlines)
                .after(ComicsSystems::DepthRange)
                .after(Core3dSystems::Prepass)
                .before(Core3dSystems::MainPass),
        );
    #[cfg(feature = "objects")]
    render_app.add_systems(
        Core3d,
        record::find_highlights
            .after(ComicsSystems::Outlines)
            .before(Core3dSystems::MainPass),
    );
}

fn load_shaders(app: &mut App) {
    load_shader_library!(app, "cracks/edge.wgsl");
    load_shader_library!(app, "draw/coverage.wgsl");
    load_shader_library!(app, "tiles/blocks.wgsl");
    load_shader_library!(app, "find/rows.wgsl");
    load_shader_library!(app, "find/crack.wgsl");
    load_shader_library!(app, "find/ledge.wgsl");
    load_shader_library!(app, "find/jumps.wgsl");
    load_shader_library!(app, "draw/read.wgsl");
    load_shader_library!(app, "link/bend.wgsl");
    load_shader_library!(app, "tiles/listed.wgsl");
    load_shader_library!(app, "settings/weight.wgsl");
    load_shader_library!(app, "settings/boil.wgsl");
    load_shader_library!(app, "history/history.wgsl");
    load_shader_library!(app, "draw/surface.wgsl");
    load_shader_library!(app, "find/hidden.wgsl");
    load_shader_library!(app, "link/budget.wgsl");
    load_shader_library!(app, "modifiers/fade.wgsl");
    load_shader_library!(app, "modifiers/simplification.wgsl");
    load_shader_library!(app, "modifiers/layer_lines.wgsl");
    load_shader_library!(app, "modifiers/owner_plane.wgsl");
    load_shader_library!(app, "settings/fog.wgsl");
    load_shader_library!(app, "link/fold.wgsl");
    load_shader_library!(app, "request/pass.wgsl");
    load_shader_library!(app, "cracks/planes.wgsl");
    load_shader_library!(app, "cracks/read_planes.wgsl");
    load_shader_library!(app, "link/gaps.wgsl");
    load_shader_library!(app, "history/holds.wgsl");
    load_shader_library!(app, "draw/near.wgsl");
    load_shader_library!(app, "draw/overshoot.wgsl");
    load_shader_library!(app, "link/chain.wgsl");
    load_shader_library!(app, "link/rim.wgsl");
    load_shader_library!(app, "link/sign.wgsl");
    load_shader_library!(app, "modifiers/sheet.wgsl");
    load_shader_library!(app, "cracks/stored.wgsl");
    LineShaders::embed(app);
    embedded_asset!(app, "tiles/tile.wgsl");
    embedded_asset!(app, "record/highlights.wgsl");
}

fn init_pipelines(
    mut commands: Commands,
    fullscreen: Res<FullscreenShader>,
    assets: Res<AssetServer>,
    lines: Query<Entity, With<ViewLines>>,
) {
    // This runs again after a lost device, whose buffers are no longer valid.
    for view in &lines {
        commands.entity(view).remove::<(ViewLines, ViewCracks)>();
    }
    commands.insert_resource(LineShaders::new(&fullscreen, &assets));
    commands.insert_resource(HighlightPipeline::new(&fullscreen, &assets));
}
