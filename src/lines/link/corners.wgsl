// Notes which cracks of lines meet at each corner, so that a step along a line loads one word. See
// chain.wgsl for what a corner is, and corner_word for where its bits are, in two words: 0 and 1 are the
// cracks above and below it, 2 and 3 those to its left and right.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{COLUMNS, LINKED_EAST, LINKED_SOUTH, column_word, corner_word}

@group(0) @binding(21) var<storage, read_write> linked: array<atomic<u32>>;

// The eight rows of a cell in a column of a plane.
fn cell_rows(g: Grid, plane: i32, p: vec2<i32>) -> u32 {
    return (atomicLoad(&linked[column_word(g, plane, p.x, p.y >> 5u)]) >> u32(p.y & 31)) & 0xffu;
}

// The lowest eight bits, each as the first of four.
fn spread(bits: u32) -> u32 {
    var all = bits & 0xffu;
    all = (all | (all << 12u)) & 0x000f000fu;
    all = (all | (all << 6u)) & 0x03030303u;
    return (all | (all << 3u)) & 0x11111111u;
}

@compute @workgroup_size(32)
fn corners(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
    let g = line_pass.grid;
    let quad = cell.y >> 2u;
    var east_before = 0u;
    var south_before = 0u;
    for (var i = 0; i <= COLUMNS; i++) {
        let x = cell.x + i;
        var east = 0u;
        var south = 0u;
        if i < COLUMNS && x < g.rect.z {
            east = cell_rows(g, LINKED_EAST, vec2(x, cell.y));
            south = cell_rows(g, LINKED_SOUTH, vec2(x, cell.y));
        }
        // The last row of cracks above a corner, and of those beside it, is that of the next eight.
        let above = east_before << 1u;
        let left = south_before << 1u;
        let right = south << 1u;
        let own = spread(above) | (spread(east_before) << 1u) | (spread(left) << 2u) | (spread(right) << 3u);
        let next = (above >> 8u) | ((left >> 8u) << 2u) | ((right >> 8u) << 3u);
        if own != 0u {
            atomicOr(&linked[corner_word(g, x, quad - 1)], own << 16u);
            atomicOr(&linked[corner_word(g, x, quad)], own);
        }
        let behind = (own >> 16u) | (next << 16u);
        if behind != 0u {
            atomicOr(&linked[corner_word(g, x, quad + 1)], behind);
        }
        if next != 0u {
            atomicOr(&linked[corner_word(g, x, quad + 2)], next);
        }
        east_before = east;
        south_before = south;
    }
}
