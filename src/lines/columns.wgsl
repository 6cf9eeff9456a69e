// The first half of the search for lines wider than the neighbouring pixels: for every
// pixel, the crack in its column whose line covers it most, and the place of the next
// one. The second half, in draw.wgsl, compares the results of the columns nearby.
// Together they load 2 r pixels around a pixel instead of r^2.
//
// x: the packed crack; y: its place in the lower half, that of the next crack in the upper.

#import bevy_comics::depth::view::View
#ifdef BLOCKS
#import bevy_comics::lines::blocks::{BLOCK_HEIGHT, BLOCK_WIDTH, marked_rows}
#endif
#import bevy_comics::lines::edge::{
    Grid, Lines, Place, crack_opacity, is_apart, line_coverage, line_offset, pack_place, place_middle, unpack_width,
}

struct ColumnUniform {
    seen: View,
    settings: Lines,
    grid: Grid,
}

@group(0) @binding(1) var<uniform> column_uniform: ColumnUniform;
@group(0) @binding(11) var crack_texture: texture_2d<u32>;

// The best two cracks in the column so far.
struct Best {
    packed: u32,
    places: vec2<u32>,
    // Middles of the lines, seen from the pixel.
    first: vec2<f32>,
    scores: vec2<f32>,
}

// Compares a crack with the best two.
fn compare(best: ptr<function, Best>, packed: u32, row: i32, south: bool) {
    let half_width = unpack_width(packed >> 20u);
    let shift = select(1.0, -1.0, (packed & 8u) != 0u) * line_offset(half_width);
    let place = Place(row, south, 0.5 + shift);
    let middle = place_middle(place);
    // In pixels of the viewport, as widths are.
    let away = abs(middle.y) / column_uniform.grid.from_viewport.y;
    let value = line_coverage(away, half_width) * crack_opacity(column_uniform.settings, packed);
    // Of equal ink, the line is taken whose border is farther out: it reaches farther.
    let exists = (packed & 7u) != 0u;
    let score = select(-1.0, value + 1e-4 * (half_width - away), exists);
    let better = score > (*best).scores.x;
    // Both cracks at a corner of a line of odd width have their middle in one pixel.
    let other = is_apart(middle, (*best).first);
    let pushed = better && other;
    let next = other && score > (*best).scores.y;
    let packed_place = pack_place(place);
    (*best).places.y = select(select((*best).places.y, packed_place, next), (*best).places.x, pushed);
    (*best).scores.y = select(select((*best).scores.y, score, next), (*best).scores.x, pushed);
    (*best).packed = select((*best).packed, packed, better);
    (*best).places.x = select((*best).places.x, packed_place, better);
    (*best).first = select((*best).first, middle, better);
    (*best).scores.x = max((*best).scores.x, score);
}

// Compares both cracks of the pixel in row `y` of the column of `p`.
fn compare_row(best: ptr<function, Best>, p: vec2<i32>, y: i32) {
    let packed = textureLoad(crack_texture, vec2(p.x, y), 0).xy;
    compare(best, packed.x, y - p.y, false);
    compare(best, packed.y, y - p.y, true);
}

@fragment
fn columns(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    let g = column_uniform.grid;
    let p = vec2<i32>(position.xy);
    var best = Best(0u, vec2(0u), vec2(1e6), vec2(-1.0));
    let first = max(p.y - g.reach - 1, 0);
    let last = min(p.y + g.reach, g.rect.w - 1);
#ifdef BLOCKS
    for (var block = first / BLOCK_HEIGHT; block <= last / BLOCK_HEIGHT; block++) {
        var rows = marked_rows(vec2(p.x / BLOCK_WIDTH, block), first, last);
        while rows != 0u {
            compare_row(&best, p, block * BLOCK_HEIGHT + i32(firstTrailingBit(rows)));
            rows &= rows - 1u;
        }
    }
#else
    for (var y = first; y <= last; y++) {
        compare_row(&best, p, y);
    }
#endif
    return vec2(best.packed, best.places.x | (best.places.y << 16u));
}
