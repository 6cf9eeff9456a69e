// Closes gaps in lines: where at most Grid::gap_closing cracks in a row are missing between two
// cracks of lines, the missing ones become parts of lines too. They are like the nearest found crack
// of their run. Reads the planes of one buffer and adds to those of the other, which begin as a
// copy.
//
// A gap is in the cells of its ends: it is shorter than a cell is wide.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::gaps::{gaps_between, source_of}
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{COLUMNS, LINKED_EAST, LINKED_SOUTH, column_word, row_word}
#import bevy_comics::lines::read_planes::column_window

// The cracks of every pixel, to the east and to the south.
@group(0) @binding(18) var<storage, read_write> cracks: array<u32>;
@group(0) @binding(21) var<storage, read_write> linked: array<atomic<u32>>;

// Rows of a window above a cell, and its columns: those of a cell, and three on both sides.
const ROWS_ABOVE: i32 = 12;
const SIDE: i32 = 3;
const WIDTH: i32 = 10;

// Adds the cracks of a column of a cell to a plane, and stores what they are like.
fn store_column(g: Grid, first: vec2<i32>, side: i32, rows: u32) {
    let plane = select(LINKED_EAST, LINKED_SOUTH, side == 1);
    atomicOr(&linked[column_word(g, plane, first.x, first.y >> 5u)], rows << u32(first.y & 31));
    var left = rows;
    while left != 0u {
        let p = first + vec2(0, i32(firstTrailingBit(left)));
        left &= left - 1u;
        if side == 1 {
            atomicOr(&linked[row_word(g, p.x >> 5u, p.y)], 1u << u32(p.x & 31));
        }
        let at = 2 * (p.y * g.rect.z + p.x) + side;
        // A weak crack may have been found there.
        if cracks[at] == 0u {
            let source = source_of(g, vec3(p, side));
            cracks[at] = cracks[2 * (source.y * g.rect.z + source.x) + side];
        }
    }
}

@compute @workgroup_size(32)
fn close_gaps(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
    let g = line_pass.grid;
    let top = cell.y - ROWS_ABOVE;
    var south: array<u32, WIDTH>;
    for (var i = 0; i < WIDTH; i++) {
        south[i] = column_window(g, LINKED_SOUTH, cell.x - SIDE + i, top);
    }
    for (var column = 0; column < COLUMNS; column++) {
        let i = column + SIDE;
        let first = cell + vec2(column, 0);
        let e = column_window(g, LINKED_EAST, first.x, top);
        let up = vec3(e << 1u, e << 2u, e << 3u);
        let down = vec3(e >> 1u, e >> 2u, e >> 3u);
        let before = vec3(south[i - 1], south[i - 2], south[i - 3]);
        let after = vec3(south[i + 1], south[i + 2], south[i + 3]);
        let east_gaps = gaps_between(up, down, g.gap_closing) & ~e;
        let south_gaps = gaps_between(before, after, g.gap_closing) & ~south[i];
        let gaps = (vec2(east_gaps, south_gaps) >> vec2(u32(ROWS_ABOVE))) & vec2(0xffu);
        if gaps.x != 0u {
            store_column(g, first, 0, gaps.x);
        }
        if gaps.y != 0u {
            store_column(g, first, 1, gaps.y);
        }
    }
}
