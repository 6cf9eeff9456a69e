// Measures the length of lines per area, in 1 / pixels of the grid, in squares of 8, 16, 32 and
// 64 pixels; COARSE: in squares of 128, 256 and 512 pixels, from those of 64. A workgroup begins
// with 8 x 8 squares, and halves their number along both axes three times.

#import bevy_comics::lines::budget::{SQUARE, square_index, squares}
#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::pass::line_pass
#ifndef COARSE
#import bevy_comics::lines::planes::{LINKED_EAST, LINKED_SOUTH}
#import bevy_comics::lines::read_planes::column_rows
#endif

@group(0) @binding(33) var<storage, read_write> densities: array<f32>;

// Levels that a workgroup adds, and squares along its sides.
const ADDED: i32 = 3;
const SIDE: u32 = 8u;

var<workgroup> means: array<f32, 64>;

#ifndef COARSE
// What a corner saves: two cracks of a diagonal, with two corners, are as long as the square root
// of 2. So straight lines are exact at 0, 45 and 90 degrees, and up to 8.3 % too long in between.
const CORNER: f32 = 0.29289322;

// A corner has one crack to its left or right, and one above or below. Bits are rows.
fn density_in(g: Grid, square: vec2<i32>) -> f32 {
    let first = square * SQUARE;
    let last = first + SQUARE - 1;
    var length = 0.0;
    var south = column_rows(g, LINKED_SOUTH, first.x, first.y, last.y);
    for (var x = first.x; x <= last.x; x++) {
        let east = column_rows(g, LINKED_EAST, x, first.y, last.y + 1);
        let beside = column_rows(g, LINKED_SOUTH, x + 1, first.y, last.y);
        let corners = (east ^ (east >> 1u)) & (south ^ beside);
        length += f32(countOneBits(east & 0xffu) + countOneBits(south)) - CORNER * f32(countOneBits(corners));
        south = beside;
    }
    let sides = vec2<f32>(min(last, g.rect.zw - 1) - first + 1);
    return length / (sides.x * sides.y);
}
#endif

@compute @workgroup_size(8, 8)
fn measure(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(local_invocation_id) place: vec3<u32>,
    @builtin(local_invocation_index) index: u32,
) {
    let g = line_pass.grid;
    let own = vec2<i32>(id.xy);
#ifdef COARSE
    let first = ADDED;
    let square = min(own, squares(g, first) - 1);
    means[index] = densities[square_index(g, first, square)];
#else
    let first = 0;
    let square = min(own, squares(g, first) - 1);
    let density = density_in(g, square);
    means[index] = density;
    densities[square_index(g, first, square)] = density;
#endif
    for (var added = 1; added <= ADDED; added++) {
        workgroupBarrier();
        let step = 1u << u32(added);
        if all(place.xy % step == vec2(0u)) {
            // The next ones across and down, and the one beyond both.
            let next = step / 2u;
            let below = index + SIDE * next;
            let mean = 0.25 * (means[index] + means[index + next] + means[below] + means[below + next]);
            means[index] = mean;
            let level = first + added;
            let wide = own >> vec2(u32(added));
            if all(wide < squares(g, level)) {
                densities[square_index(g, level, wide)] = mean;
            }
        }
    }
}
