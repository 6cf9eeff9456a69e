// Joins lines over ledges, see are_ledges in crack.wgsl: a ledge becomes part of a line if it is on
// a path of at most twelve ledges, end to end, from one line to another. Reads the planes of one
// buffer and adds to those of the other, which begin as a copy.
//
// Lines grow along ledges from both sides, and what has met nothing is taken away again.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{
    CELL_ROWS, COLUMNS, LEDGE_EAST, LEDGE_SOUTH, LINKED_EAST, LINKED_SOUTH, column_word, row_word,
}
#import bevy_comics::lines::read_planes::{column_window, load_column}

@group(0) @binding(21) var<storage, read_write> linked: array<atomic<u32>>;

// Steps of growing, and of taking away. Columns that are read: those of a cell, and twice as many
// as steps on both sides. A word has as many rows above the cell and below.
const STEPS: i32 = 6;
const SIDE: i32 = 12;
const WIDTH: i32 = 28;

// The cracks of the window: lines, and ledges that are no lines.
var<private> east: array<u32, WIDTH>;
var<private> south: array<u32, WIDTH>;
var<private> ledge_east: array<u32, WIDTH>;
var<private> ledge_south: array<u32, WIDTH>;

// Whether the rows `own` of a cell, as bits of its band, have ledges.
fn has_ledges(g: Grid, x: i32, band: i32, own: u32) -> bool {
    var ledges = 0u;
    for (var i = 0; i < COLUMNS; i++) {
        ledges |= load_column(g, LEDGE_EAST, x + i, band) | load_column(g, LEDGE_SOUTH, x + i, band);
    }
    return (ledges & own) != 0u;
}

// Loads the window around the cell that begins at a pixel.
fn load_window(g: Grid, cell: vec2<i32>) {
    let top = cell.y - SIDE;
    for (var i = 0; i < WIDTH; i++) {
        let x = cell.x - SIDE + i;
        east[i] = column_window(g, LINKED_EAST, x, top);
        south[i] = column_window(g, LINKED_SOUTH, x, top);
        ledge_east[i] = column_window(g, LEDGE_EAST, x, top) & ~east[i];
        ledge_south[i] = column_window(g, LEDGE_SOUTH, x, top) & ~south[i];
    }
}

// Continues the lines of the window by one ledge, or takes away the ledges that have a loose
// end. Returns whether there were any.
fn move_on(takes: bool) -> bool {
    var changed = 0u;
    var east_before = 0u;
    var south_before = 0u;
    for (var i = 0; i < WIDTH; i++) {
        // A crack to the east ends at the corners above and below it; one to the south at
        // those to its left and right.
        let e = east[i];
        let s = south[i];
        let beside = select(0u, south[min(i + 1, WIDTH - 1)], i + 1 < WIDTH);
        let above = (e | s | beside) << 1u;
        let below = (e >> 1u) | s | beside;
        let left = south_before | east_before | (east_before >> 1u);
        let right = beside | e | (e >> 1u);
        // Bits of ledges that change.
        let flips_east = ledge_east[i] & select(~e & (above | below), e & ~(above & below), takes);
        let flips_south = ledge_south[i] & select(~s & (left | right), s & ~(left & right), takes);
        changed |= flips_east | flips_south;
        east[i] = e ^ flips_east;
        south[i] = s ^ flips_south;
        east_before = e;
        south_before = s;
    }
    return changed != 0u;
}

// Whether lines of the window's cell continue along ledges.
fn has_joints() -> bool {
    var joints = 0u;
    for (var i = SIDE; i < SIDE + COLUMNS; i++) {
        joints |= (east[i] & ledge_east[i]) | (south[i] & ledge_south[i]);
    }
    return ((joints >> u32(SIDE)) & 0xffu) != 0u;
}

// Adds the lines of the window's cell to the planes.
fn store_cell(g: Grid, cell: vec2<i32>) {
    let from_top = u32(cell.y & 31);
    let band = cell.y >> 5u;
    for (var i = 0; i < COLUMNS; i++) {
        let x = cell.x + i;
        let e = ((east[SIDE + i] & ledge_east[SIDE + i]) >> u32(SIDE)) & 0xffu;
        var s = ((south[SIDE + i] & ledge_south[SIDE + i]) >> u32(SIDE)) & 0xffu;
        if x < g.rect.z && (e | s) != 0u {
            atomicOr(&linked[column_word(g, LINKED_EAST, x, band)], e << from_top);
            atomicOr(&linked[column_word(g, LINKED_SOUTH, x, band)], s << from_top);
            while s != 0u {
                let y = cell.y + i32(firstTrailingBit(s));
                s &= s - 1u;
                atomicOr(&linked[row_word(g, x >> 5u, y)], 1u << u32(x & 31));
            }
        }
    }
}

@compute @workgroup_size(32)
fn join(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    let g = line_pass.grid;
    if cell.x < 0 || !has_ledges(g, cell.x, cell.y >> 5u, 0xffu << u32(cell.y & 31)) {
        return;
    }
    load_window(g, cell);
    for (var i = 0; i < STEPS; i++) {
        if !move_on(false) {
            break;
        }
    }
    if !has_joints() {
        return;
    }
    for (var i = 0; i < STEPS; i++) {
        if !move_on(true) {
            break;
        }
    }
    store_cell(g, cell);
}
