// Lists the tiles of 16 x 16 pixels that the passes after walk.wgsl draw, as rectangles
// in clip space. Pixels of other tiles cost nothing. Layers of the dispatch are lists.

#import bevy_comics::depth::view::View
#import bevy_comics::lines::edge::{Grid, Lines, block_rows}

struct TilesUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> tiles_uniform: TilesUniform;
// For each block of 4 x 32 pixels, one bit for each row that may have a
// crack or jump: see walk.wgsl.
@group(0) @binding(12) var block_texture: texture_2d<u32>;
// For each list the arguments of an indirect draw: vertices, instances, and two zeros.
@group(0) @binding(14) var<storage, read_write> arguments: array<atomic<u32>>;
// The lists, one after the other: left, top, right, bottom in clip space.
@group(0) @binding(15) var<storage, read_write> tiles: array<vec4<f32>>;

const TILE: i32 = 16;
// TileList of tiles.rs.
const INKED: u32 = 0u;
const COLUMNS: u32 = 1u;
const LISTS: u32 = 2u;

// Whether there are cracks in a part of the grid, which has `size` pixels.
fn has_cracks(low: vec2<i32>, high: vec2<i32>, size: vec2<i32>) -> bool {
    let from_pixel = clamp(low, vec2(0), size - 1);
    let to_pixel = clamp(high, vec2(0), size - 1);
    var rows = 0u;
    for (var y = from_pixel.y >> 5u; y <= to_pixel.y >> 5u; y++) {
        let mask = block_rows(y * 32, from_pixel.y, to_pixel.y);
        for (var x = from_pixel.x >> 2u; x <= to_pixel.x >> 2u; x++) {
            rows |= textureLoad(block_texture, vec2(x, y), 0).r & mask;
        }
    }
    return rows != 0u;
}

// The part of the grid whose cracks matter to a tile of a list: its first and last pixel.
fn nearby(list: u32, first: vec2<i32>) -> vec4<i32> {
    let g = tiles_uniform.grid;
    let last = first + TILE - 1;
    if list == COLUMNS {
        return vec4(first - vec2(0, g.reach + 1), last + vec2(0, g.reach));
    }
    let low = floor(vec2<f32>(first) * g.from_viewport.xy + g.from_viewport.zw);
    let high = ceil(vec2<f32>(first + TILE) * g.from_viewport.xy + g.from_viewport.zw);
    return vec4(vec2<i32>(low), vec2<i32>(high)) + vec2(-g.inked, g.inked).xxyy;
}

@compute @workgroup_size(8, 8)
fn list_tiles(@builtin(global_invocation_id) id: vec3<u32>) {
    let list = id.z;
    let size = select(tiles_uniform.grid.rect.zw, tiles_uniform.seen.viewport.zw, list == INKED);
    let first = vec2<i32>(id.xy) * TILE;
    if any(first >= size) {
        return;
    }
    let part = nearby(list, first);
    if !has_cracks(part.xy, part.zw, tiles_uniform.grid.rect.zw) {
        return;
    }
    let corners = vec4<f32>(vec4(first, min(first + TILE, size)));
    let ndc = (corners / vec2<f32>(size).xyxy * 2.0 - 1.0) * vec4(1.0, -1.0, 1.0, -1.0);
    let index = atomicAdd(&arguments[4u * list + 1u], 1u);
    tiles[list * (arrayLength(&tiles) / LISTS) + index] = ndc;
}
