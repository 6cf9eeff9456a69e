//! The service of lines. `resolve.wgsl` picks a sample of every pixel of a multisampled
//! view. `walk.wgsl` looks for cracks, the borders between pixels that lines run along, in
//! depth, normals and object ids; it lists the cells that have them, and `tiles.wgsl` the
//! tiles nearby. In the cells, `cells.wgsl` measures the cracks, `link.wgsl` continues lines
//! along weak ones, `join.wgsl` joins them over faces that are thinner than a pixel, `bridge.wgsl`
//! closes gaps, and `settle.wgsl` completes them. In the tiles, `columns.wgsl`, for wide lines, and
//! `draw.wgsl` draw their ink into a texture. Effects read the ink with `read.wgsl`.

mod abstraction;
mod boil;
mod color;
mod completing;
mod cracks;
mod defs;
mod draw;
mod focus;
mod fog;
mod inputs;
mod key;
mod kinds;
mod layer_lines;
mod layouts;
mod marks;
mod memory;
mod modifiers;
mod overshoot;
mod pass;
mod persistence;
mod pipelines;
mod prepare;
pub(crate) mod request;
mod resolve;
mod settings;
mod sheet;
mod sources;
mod store;
mod tiles;
mod weight;

use bevy::{
    app::App,
    asset::{AssetServer, embedded_asset},
    core_pipeline::{
        FullscreenShader,
        schedule::{Core3d, Core3dSystems},
    },
    ecs::{
        entity::Entity,
        query::With,
        schedule::IntoScheduleConfigs,
        system::{Commands, Query, Res},
    },
    render::{
        GpuResourceAppExt, Render, RenderApp, RenderStartup,
        render_resource::{SpecializedComputePipelines, SpecializedRenderPipelines},
    },
    shader::load_shader_library,
};

pub use abstraction::LineAbstraction;
pub use boil::LineBoil;
pub use color::LineColor;
pub use focus::LineFocus;

pub use fog::LineFog;
pub(crate) use fog::{FogUniform, ViewFog, has_fog};
pub(crate) use key::reach;
pub use kinds::{Creases, LineResponse, ObjectEdges, Silhouettes};
pub use layer_lines::LineLayers;
pub(crate) use layer_lines::LineLayersUniform;
pub(crate) use layouts::{ink_entry, owners_entry, range_entry};
#[cfg(feature = "objects")]
pub(crate) use marks::MarkKey;
pub(crate) use marks::{MarkPipeline, ViewMarks, draw_marks};
pub(crate) use memory::MemoryRequest;
pub use modifiers::LineModifiers;
pub(crate) use prepare::ViewLines;
pub(crate) use settings::LinesUniform;
pub use settings::{MapJumps, Outlines};
pub use sheet::Sheet;
pub(crate) use sheet::SheetUniform;
pub use store::ViewCracks;
pub(crate) use tiles::{TileList, TileLists, tile_shader, vertices};
pub use weight::LineWeight;

use crate::schedule::{ComicsSystems, PrepareComics};
use memory::MemoryPipeline;
use pipelines::LineShaders;
use resolve::ResolvePipeline;

/// Finds the lines of the views that request them.
pub(crate) fn build_render(app: &mut App) {
    load_shaders(app);
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
        return;
    };
    render_app
        .init_gpu_resource::<SpecializedComputePipelines<LineShaders>>()
        .init_gpu_resource::<SpecializedRenderPipelines<LineShaders>>()
        .init_gpu_resource::<SpecializedRenderPipelines<ResolvePipeline>>()
        .init_gpu_resource::<SpecializedRenderPipelines<MemoryPipeline>>()
        .init_gpu_resource::<SpecializedRenderPipelines<MarkPipeline>>()
        .add_systems(RenderStartup, init_pipelines)
        .add_systems(
            Render,
            prepare::prepare_view_lines.in_set(PrepareComics::Services),
        )
        .add_systems(
            Core3d,
            draw::find_lines
                .in_set(ComicsSystems::Outlines)
                .after(ComicsSystems::DepthRange)
                .after(Core3dSystems::Prepass)
                .before(Core3dSystems::MainPass),
        );
    #[cfg(feature = "objects")]
    render_app.add_systems(
        Core3d,
        draw::find_marks
            .after(ComicsSystems::Outlines)
            .before(Core3dSystems::MainPass),
    );
}

fn load_shaders(app: &mut App) {
    load_shader_library!(app, "edge.wgsl");
    load_shader_library!(app, "coverage.wgsl");
    load_shader_library!(app, "blocks.wgsl");
    load_shader_library!(app, "rows.wgsl");
    load_shader_library!(app, "crack.wgsl");
    load_shader_library!(app, "ledge.wgsl");
    load_shader_library!(app, "jumps.wgsl");
    load_shader_library!(app, "read.wgsl");
    load_shader_library!(app, "bend.wgsl");
    load_shader_library!(app, "listed.wgsl");
    load_shader_library!(app, "weight.wgsl");
    load_shader_library!(app, "boil.wgsl");
    load_shader_library!(app, "memory.wgsl");
    load_shader_library!(app, "surface.wgsl");
    load_shader_library!(app, "hidden.wgsl");
    load_shader_library!(app, "budget.wgsl");
    load_shader_library!(app, "focus.wgsl");
    load_shader_library!(app, "abstraction.wgsl");
    load_shader_library!(app, "layer_lines.wgsl");
    load_shader_library!(app, "owner_plane.wgsl");
    load_shader_library!(app, "fog.wgsl");
    load_shader_library!(app, "fold.wgsl");
    load_shader_library!(app, "pass.wgsl");
    load_shader_library!(app, "planes.wgsl");
    load_shader_library!(app, "read_planes.wgsl");
    load_shader_library!(app, "gaps.wgsl");
    load_shader_library!(app, "lives.wgsl");
    load_shader_library!(app, "overshoot.wgsl");
    load_shader_library!(app, "chain.wgsl");
    load_shader_library!(app, "rim.wgsl");
    load_shader_library!(app, "sheet.wgsl");
    load_shader_library!(app, "stored.wgsl");
    embedded_asset!(app, "walk.wgsl");
    embedded_asset!(app, "cells.wgsl");
    embedded_asset!(app, "link.wgsl");
    embedded_asset!(app, "persist.wgsl");
    embedded_asset!(app, "join.wgsl");
    embedded_asset!(app, "bridge.wgsl");
    embedded_asset!(app, "ends.wgsl");
    embedded_asset!(app, "strokes.wgsl");
    embedded_asset!(app, "settle.wgsl");
    embedded_asset!(app, "tiles.wgsl");
    embedded_asset!(app, "tile.wgsl");
    embedded_asset!(app, "resolve.wgsl");
    embedded_asset!(app, "find.wgsl");
    embedded_asset!(app, "columns.wgsl");
    embedded_asset!(app, "faithful.wgsl");
    embedded_asset!(app, "draw.wgsl");
    embedded_asset!(app, "remember.wgsl");
    embedded_asset!(app, "marks.wgsl");
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
    commands.insert_resource(ResolvePipeline::new(&fullscreen, &assets));
    commands.insert_resource(MemoryPipeline::new(&fullscreen, &assets));
    commands.insert_resource(MarkPipeline::new(&fullscreen, &assets));
}
