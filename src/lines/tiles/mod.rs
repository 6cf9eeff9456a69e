//! Where the passes after `walk.wgsl` run: the cells that it has listed, and the tiles with
//! cracks nearby, which `tiles.wgsl` lists.

use bevy::{
    asset::load_embedded_asset,
    core_pipeline::FullscreenShader,
    mesh::VertexBufferLayout,
    prelude::*,
    render::{
        render_resource::{
            BindGroup, BindGroupEntry, Buffer, BufferUsages, PrimitiveState, PrimitiveTopology,
            RenderPipeline, VertexFormat, VertexState, VertexStepMode,
        },
        renderer::{RenderDevice, RenderQueue},
    },
};

use crate::{
    gpu::{buffer, entry, is_reused},
    lines::request::LineRequest,
};

/// Width and height of a tile in pixels.
const TILE: u32 = 16;
/// Width and height of a workgroup of `tiles.wgsl` in tiles.
const WORKGROUP: u32 = 8;
/// Bytes of the arguments of an indirect draw.
const ARGUMENTS: u64 = 16;
/// Bytes of a tile.
const RECTANGLE: u64 = 16;
/// Bytes of the cells of a tile: 4 across and 2 down, 4 bytes each. The walk lists none
/// below the grid.
const CELLS: u64 = 4 * 2 * 4;

/// A list of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TileList {
    /// Tiles of the viewport that may have ink of lines, or of an effect at jumps of the
    /// depth map.
    Inked,
    /// Tiles of the grid that `columns.wgsl` draws.
    Columns,
}

/// Number of lists.
const LISTS: u32 = 2;

/// The lists of a view.
pub(crate) struct TileLists {
    /// For each list the arguments of an indirect draw.
    arguments: Buffer,
    /// The lists, one after the other, each with room for all tiles.
    tiles: Buffer,
    /// Of each tile of the viewport, the number of frames for which it is still drawn.
    frames_left: Buffer,
    /// Size of the viewport in pixels.
    size: UVec2,
    /// Number of tiles that a list has room for.
    room: u32,
    /// The arguments of an indirect dispatch for the cells, and their number.
    cell_counts: Buffer,
    cells: Buffer,
}

/// Number of tiles across and down the larger of the grid and the viewport.
fn most_tiles(request: &LineRequest) -> UVec2 {
    let size = request.size.max(request.rect.zw());
    UVec2::new(size.x.div_ceil(TILE), size.y.div_ceil(TILE)).max(UVec2::ONE)
}

impl TileLists {
    /// Empty lists for this request; the buffers of `before` are used again if they fit and the
    /// viewport has the same size. In new ones, no tile is drawn any longer.
    pub fn new(
        before: Option<Self>,
        (device, queue): (&RenderDevice, &RenderQueue),
        request: &LineRequest,
    ) -> Self {
        let tiles = most_tiles(request);
        let room = tiles.x * tiles.y;
        let lists = before
            .filter(|lists| {
                lists.size == request.size && is_reused(u64::from(lists.room), u64::from(room))
            })
            .unwrap_or_else(|| {
                let buffer =
                    |label, size, usage| buffer(device, label, size, usage | BufferUsages::STORAGE);
                let size = RECTANGLE * u64::from(LISTS * room);
                let stored = BufferUsages::empty();
                let drawn = BufferUsages::INDIRECT | BufferUsages::COPY_DST;
                Self {
                    arguments: buffer("comics_tile_counts", ARGUMENTS * u64::from(LISTS), drawn),
                    tiles: buffer("comics_tiles", size, BufferUsages::VERTEX),
                    frames_left: buffer("comics_tile_frames", 4 * u64::from(room), stored),
                    size: request.size,
                    room,
                    cell_counts: buffer("comics_cell_counts", ARGUMENTS, drawn),
                    cells: buffer("comics_cells", CELLS * u64::from(room), stored),
                }
            });
        let none: Vec<u8> = [0u32, 1, 1, 0].map(u32::to_le_bytes).concat();
        queue.write_buffer(&lists.cell_counts, 0, &none);
        let empty: Vec<u8> = [4u32, 0, 0, 0].map(u32::to_le_bytes).concat();
        queue.write_buffer(&lists.arguments, 0, &empty.repeat(LISTS as usize));
        lists
    }

    /// Workgroups of `tiles.wgsl` for the lists up to `last`.
    pub fn workgroups(request: &LineRequest, last: TileList) -> [u32; 3] {
        let tiles = most_tiles(request);
        let across = |tiles: u32| tiles.div_ceil(WORKGROUP);
        [across(tiles.x), across(tiles.y), last as u32 + 1]
    }

    /// The bindings of `tiles.wgsl`.
    pub fn entries(&self) -> [BindGroupEntry<'_>; 3] {
        let buffers = [
            (14, &self.arguments),
            (15, &self.tiles),
            (31, &self.frames_left),
        ];
        buffers.map(|(binding, buffer)| entry(binding, buffer.as_entire_binding()))
    }

    /// The bindings of the cells.
    pub fn cell_entries(&self) -> [BindGroupEntry<'_>; 2] {
        [
            entry(16, self.cell_counts.as_entire_binding()),
            entry(17, self.cells.as_entire_binding()),
        ]
    }

    /// Dispatches a compute pipeline for the cells.
    pub fn dispatch_cells(&self, pass: &mut wgpu::ComputePass) {
        pass.dispatch_workgroups_indirect(&self.cell_counts, 0);
    }

    /// Draws the tiles of a list with a pipeline of tiled [`vertices`].
    pub fn draw(&self, pass: &mut wgpu::RenderPass, list: TileList) {
        let list = list as u64;
        let first = RECTANGLE * u64::from(self.room) * list;
        pass.set_vertex_buffer(0, *self.tiles.slice(first..));
        pass.draw_indirect(&self.arguments, ARGUMENTS * list);
    }
}

/// Draws the tiles of a list, or all pixels.
pub(crate) fn draw_tiles(
    pass: &mut wgpu::RenderPass,
    (pipeline, group): (&RenderPipeline, &BindGroup),
    tiles: Option<(&TileLists, TileList)>,
) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    match tiles {
        Some((tiles, list)) => tiles.draw(pass, list),
        None => pass.draw(0..3, 0..1),
    }
}

/// The vertex shader of tiles.
pub(crate) fn tile_shader(assets: &AssetServer) -> Handle<Shader> {
    load_embedded_asset!(assets, "tile.wgsl")
}

/// The vertices of a pass that draws tiles, or all pixels, and how they are connected. `tile`:
/// `tile.wgsl`.
pub(crate) fn vertices(
    tiled: bool,
    fullscreen: &FullscreenShader,
    tile: &Handle<Shader>,
) -> (VertexState, PrimitiveState) {
    let (vertex, topology) = if tiled {
        let rectangle = [VertexFormat::Float32x4];
        let step = VertexStepMode::Instance;
        let vertex = VertexState {
            shader: tile.clone(),
            shader_defs: vec![],
            entry_point: Some("tile".into()),
            buffers: vec![VertexBufferLayout::from_vertex_formats(step, rectangle)],
        };
        (vertex, PrimitiveTopology::TriangleStrip)
    } else {
        let vertex = fullscreen.to_vertex_state();
        (vertex, PrimitiveTopology::TriangleList)
    };
    let primitive = PrimitiveState {
        topology,
        ..Default::default()
    };
    (vertex, primitive)
}
