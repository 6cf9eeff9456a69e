// Lists the tiles, see blocks.wgsl, that the passes after walk.wgsl draw, as rectangles
// in clip space. Pixels of other tiles cost nothing. Layers of the dispatch are lists.

#import bevy_comics::lines::blocks::{
    BLOCK_HEIGHT, BLOCK_WIDTH, TILE, crack_rows, inked_by, searched_by, tile_rectangle,
}
#import bevy_comics::lines::pass::line_pass

// For each list the arguments of an indirect draw: vertices, instances, and two zeros.
@group(0) @binding(14) var<storage, read_write> arguments: array<atomic<u32>>;
// The lists, one after the other: left, top, right, bottom in clip space.
@group(0) @binding(15) var<storage, read_write> tiles: array<vec4<f32>>;

// Of each tile, the number of frames for which it is drawn, this one included.
@group(0) @binding(31) var<storage, read_write> frames_left: array<u32>;

// TileList of mod.rs.
const INKED: u32 = 0u;
const LISTS: u32 = 2u;

// Whether there are cracks in a part of the grid, which has `size` pixels.
fn has_cracks(low: vec2<i32>, high: vec2<i32>, size: vec2<i32>) -> bool {
    let from_pixel = clamp(low, vec2(0), size - 1);
    let to_pixel = clamp(high, vec2(0), size - 1);
    var rows = 0u;
    for (var y = from_pixel.y / BLOCK_HEIGHT; y <= to_pixel.y / BLOCK_HEIGHT; y++) {
        for (var x = from_pixel.x / BLOCK_WIDTH; x <= to_pixel.x / BLOCK_WIDTH; x++) {
            rows |= crack_rows(vec2(x, y), from_pixel.y, to_pixel.y);
        }
    }
    return rows != 0u;
}

@compute @workgroup_size(8, 8)
fn list_tiles(@builtin(global_invocation_id) id: vec3<u32>) {
    let list = id.z;
    let g = line_pass.grid;
    let size = select(g.rect.zw, line_pass.seen.viewport.zw, list == INKED);
    let first = vec2<i32>(id.xy) * TILE;
    if any(first >= size) {
        return;
    }
    let part = select(searched_by(g, first), inked_by(g, first), list == INKED);
    var listed = has_cracks(part.xy, part.zw, g.rect.zw);
    let tile_frames = line_pass.history.tile_frames;
    if list == INKED && tile_frames > 0u {
        // Lines that are missing in this frame are still in the history.
        let across = u32(size.x + TILE - 1) / u32(TILE);
        let tile = id.y * across + id.x;
        let left = select(max(frames_left[tile], 1u) - 1u, tile_frames + 1u, listed);
        frames_left[tile] = left;
        listed = left > 0u;
    }
    if !listed {
        return;
    }
    let index = atomicAdd(&arguments[4u * list + 1u], 1u);
    tiles[list * (arrayLength(&tiles) / LISTS) + index] = tile_rectangle(first, size);
}
