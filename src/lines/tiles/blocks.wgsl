#define_import_path bevy_comics::lines::blocks

// Blocks of 4 x 32 pixels, for each of which walk.wgsl notes the rows that may have cracks
// or jumps, and tiles of 16 x 16 pixels. The only module that declares binding 12.

#import bevy_comics::lines::edge::Grid

// One bit for each row of a block.
@group(0) @binding(12) var block_texture: texture_2d<u32>;

const BLOCK_WIDTH: i32 = 4;
const BLOCK_HEIGHT: i32 = 32;
const TILE: i32 = 16;

// Of the rows of a block that begins at the row `top`: bits of those from `first` to
// `last`.
fn block_rows(top: i32, first: i32, last: i32) -> u32 {
    let above = u32(clamp(first - top, 0, 31));
    let below = u32(clamp(top + 31 - last, 0, 31));
    return (0xffffffffu << above) & (0xffffffffu >> below);
}

// The rows from `first` to `last` of a block that may have cracks or jumps. `block`: its
// column and row.
fn crack_rows(block: vec2<i32>, first: i32, last: i32) -> u32 {
    return textureLoad(block_texture, block, 0).r & block_rows(block.y * BLOCK_HEIGHT, first, last);
}

// The pixels of the grid whose cracks and jumps may ink the tile of the viewport that
// begins at the pixel `first`: their first and last column and row.
fn inked_by(g: Grid, first: vec2<i32>) -> vec4<i32> {
    let low = floor(vec2<f32>(first) * g.from_viewport.xy + g.from_viewport.zw);
    let high = ceil(vec2<f32>(first + TILE) * g.from_viewport.xy + g.from_viewport.zw);
    return vec4(vec2<i32>(low), vec2<i32>(high)) + vec2(-g.inked, g.inked).xxyy;
}

// The pixels that columns.wgsl searches for the tile of the grid that begins at the pixel
// `first`.
fn searched_by(g: Grid, first: vec2<i32>) -> vec4<i32> {
    return vec4(first - vec2(0, g.reach + 1), first + TILE - 1 + vec2(0, g.reach));
}

// The tile that begins at the pixel `first` of a target of `size` pixels: left, top, right
// and bottom in clip space.
fn tile_rectangle(first: vec2<i32>, size: vec2<i32>) -> vec4<f32> {
    let corners = vec4<f32>(vec4(first, min(first + TILE, size)));
    return (corners / vec2<f32>(size).xyxy * 2.0 - 1.0) * vec4(1.0, -1.0, 1.0, -1.0);
}
