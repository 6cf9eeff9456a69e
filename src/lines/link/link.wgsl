// Continues lines along weak cracks: a crack that was found becomes part of a line if a
// path of at most Grid::steps found cracks, end to end, leads to it from a line (hysteresis,
// Canny 1986). A pass goes up to eight steps; it reads the planes of one buffer and
// adds to those of the other, which begin as a copy.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{
    CELL_ROWS, COLUMNS, FOUND_EAST, FOUND_SOUTH, LINKED_EAST, LINKED_SOUTH, column_word, row_word,
}
#import bevy_comics::lines::read_planes::{column_window, load_column}

@group(0) @binding(21) var<storage, read_write> linked: array<atomic<u32>>;

// Steps of a pass, and columns that are read: those of a cell, and as many as steps on
// both sides. A word has 12 rows above the cell and 12 below.
const STEPS: i32 = 8;
const WIDTH: i32 = 20;
const ROWS_ABOVE: i32 = 12;

// The cracks of the window: lines, and all that were found.
var<private> east: array<u32, WIDTH>;
var<private> south: array<u32, WIDTH>;
var<private> found_east: array<u32, WIDTH>;
var<private> found_south: array<u32, WIDTH>;

// Whether the rows `own` of a cell, as bits of its band, have cracks that are not linked.
fn has_loose(g: Grid, x: i32, band: i32, own: u32) -> bool {
    var loose = 0u;
    for (var i = 0; i < COLUMNS; i++) {
        loose |= load_column(g, FOUND_EAST, x + i, band) & ~load_column(g, LINKED_EAST, x + i, band);
        loose |= load_column(g, FOUND_SOUTH, x + i, band) & ~load_column(g, LINKED_SOUTH, x + i, band);
    }
    return (loose & own) != 0u;
}

// Loads the window around the cell that begins at a pixel.
fn load_window(g: Grid, cell: vec2<i32>) {
    let top = cell.y - ROWS_ABOVE;
    for (var i = 0; i < WIDTH; i++) {
        let x = cell.x - STEPS + i;
        east[i] = column_window(g, LINKED_EAST, x, top);
        south[i] = column_window(g, LINKED_SOUTH, x, top);
        found_east[i] = column_window(g, FOUND_EAST, x, top);
        found_south[i] = column_window(g, FOUND_SOUTH, x, top);
    }
}

// Continues the lines of the window by one crack. Returns whether any was there to continue.
fn grow() -> bool {
    var added = 0u;
    var east_before = 0u;
    var south_before = 0u;
    for (var i = 0; i < WIDTH; i++) {
        // A crack to the east ends at the corners above and below it; one to the south at
        // those to its left and right.
        let e = east[i];
        let s = south[i];
        let beside = select(0u, south[min(i + 1, WIDTH - 1)], i + 1 < WIDTH);
        let ends = s | beside;
        let more_east = found_east[i] & ~e & ((e << 1u) | (e >> 1u) | ends | (ends << 1u));
        let sides = e | east_before;
        let more_south = found_south[i] & ~s & (south_before | beside | sides | (sides >> 1u));
        added |= more_east | more_south;
        east[i] = e | more_east;
        south[i] = s | more_south;
        east_before = e;
        south_before = s;
    }
    return added != 0u;
}

// Adds the lines of the window's cell to the planes.
fn store_cell(g: Grid, cell: vec2<i32>) {
    let from_top = u32(cell.y & 31);
    let band = cell.y >> 5u;
    var rows_south: array<u32, CELL_ROWS>;
    for (var i = 0; i < COLUMNS; i++) {
        let x = cell.x + i;
        let e = (east[STEPS + i] >> u32(ROWS_ABOVE)) & 0xffu;
        let s = (south[STEPS + i] >> u32(ROWS_ABOVE)) & 0xffu;
        if x < g.rect.z && (e | s) != 0u {
            atomicOr(&linked[column_word(g, LINKED_EAST, x, band)], e << from_top);
            atomicOr(&linked[column_word(g, LINKED_SOUTH, x, band)], s << from_top);
        }
        for (var row = 0; row < CELL_ROWS; row++) {
            rows_south[row] |= ((s >> u32(row)) & 1u) << u32(i);
        }
    }
    for (var row = 0; row < CELL_ROWS; row++) {
        if rows_south[row] != 0u {
            atomicOr(&linked[row_word(g, cell.x >> 5u, cell.y + row)], rows_south[row] << u32(cell.x & 31));
        }
    }
}

@compute @workgroup_size(32)
fn link(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    let g = line_pass.grid;
    if cell.x < 0 || !has_loose(g, cell.x, cell.y >> 5u, 0xffu << u32(cell.y & 31)) {
        return;
    }
    load_window(g, cell);
#ifdef LAST
    let steps = (g.steps - 1) % STEPS + 1;
#else
    let steps = STEPS;
#endif
    for (var step = 0; step < steps; step++) {
        if !grow() {
            break;
        }
    }
    store_cell(g, cell);
}
