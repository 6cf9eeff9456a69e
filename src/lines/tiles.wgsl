#define_import_path bevy_comics::lines::tiles

// Tiles of 16 x 16 pixels. A pass draws all of them as instances, row by row, and those
// without cracks collapse into a point: their pixels cost nothing on any adapter.

#ifndef BY_FRAGMENTS
// For each block of 4 x 32 pixels, one bit for each row with a crack: see walk.wgsl.
@group(0) @binding(12) var block_texture: texture_2d<u32>;
#endif

const TILE: i32 = 16;

// The first pixel of a tile of a picture of this size.
fn tile_origin(instance: u32, size: vec2<i32>) -> vec2<i32> {
    let across = (size.x + TILE - 1) / TILE;
    return vec2(i32(instance) % across, i32(instance) / across) * TILE;
}

// A corner of a tile in clip space, for a strip of two triangles.
fn tile_corner(first: vec2<i32>, vertex: u32, size: vec2<i32>, drawn: bool) -> vec4<f32> {
    let corner = first + vec2(i32(vertex & 1u), i32(vertex >> 1u)) * TILE;
    let ndc = vec2<f32>(corner) / vec2<f32>(size) * 2.0 - 1.0;
    return select(vec4(-2.0, -2.0, 0.0, 1.0), vec4(ndc.x, -ndc.y, 0.0, 1.0), drawn);
}

// Whether there are cracks in a part of the grid, which has `size` pixels.
fn has_cracks(low: vec2<i32>, high: vec2<i32>, size: vec2<i32>) -> bool {
#ifdef BY_FRAGMENTS
    return true;
#else
    let from_pixel = clamp(low, vec2(0), size - 1);
    let to_pixel = clamp(high, vec2(0), size - 1);
    var rows = 0u;
    for (var y = from_pixel.y >> 5u; y <= to_pixel.y >> 5u; y++) {
        let above = u32(clamp(from_pixel.y - y * 32, 0, 31));
        let below = u32(31 - clamp(to_pixel.y - y * 32, 0, 31));
        let mask = (0xffffffffu << above) & (0xffffffffu >> below);
        for (var x = from_pixel.x >> 2u; x <= to_pixel.x >> 2u; x++) {
            rows |= textureLoad(block_texture, vec2(x, y), 0).r & mask;
        }
    }
    return rows != 0u;
#endif
}
