// Finds the cracks that lines run along, in the cells that walk.wgsl has listed; the rest of
// the buffer is not written. A pixel has a crack to the east (x) and one to the south (y).
// Also writes the planes of bits, see planes.wgsl: where cracks were found, and, COMPLETED,
// those by which other passes complete lines.

#import bevy_comics::depth::view::set_view
#import bevy_comics::lines::crack::{Cracks, cracks}
#import bevy_comics::lines::edge::SILHOUETTE
#import bevy_comics::lines::listed::listed_cell
#import bevy_comics::lines::pass::line_pass
#import bevy_comics::lines::planes::{
    CELL_ROWS, FOUND_EAST, FOUND_SOUTH, LEDGE_EAST, LEDGE_SOUTH, LINKED_EAST, LINKED_SOUTH,
    SILHOUETTE_EAST, SILHOUETTE_SOUTH, column_word, row_word,
}
#import bevy_comics::lines::rows::{Above, four_columns, step_down}

@group(0) @binding(18) var<storage, read_write> crack_words: array<vec2<u32>>;
@group(0) @binding(21) var<storage, read_write> planes_found: array<atomic<u32>>;

// Adds the bits of a cell's column to a plane.
fn add_column(plane: i32, x: i32, top: i32, rows: u32) {
    let g = line_pass.grid;
    if rows != 0u && x < g.rect.z {
        atomicOr(&planes_found[column_word(g, plane, x, top >> 5u)], rows << u32(top & 31));
    }
}

// Adds the bits of a cell's four columns to a plane.
fn add_columns(plane: i32, cell: vec2<i32>, rows: vec4<u32>) {
    add_column(plane, cell.x, cell.y, rows.x);
    add_column(plane, cell.x + 1, cell.y, rows.y);
    add_column(plane, cell.x + 2, cell.y, rows.z);
    add_column(plane, cell.x + 3, cell.y, rows.w);
}

#ifdef COMPLETED
// Adds cracks to the south to the plane of rows: one bit for each row of four columns.
fn add_rows(cell: vec2<i32>, south: vec4<u32>) {
    for (var row = 0; row < CELL_ROWS; row++) {
        let four = (south >> vec4(u32(row))) & vec4(1u);
        let bits = four.x | (four.y << 1u) | (four.z << 2u) | (four.w << 3u);
        if bits != 0u {
            atomicOr(&planes_found[row_word(line_pass.grid, cell.x >> 5u, cell.y + row)], bits << u32(cell.x & 31));
        }
    }
}
#endif

// Stores the cracks of four pixels of a row, of which those in the grid.
fn store_row(first: vec2<i32>, east: vec4<u32>, south: vec4<u32>) {
    let rect = line_pass.grid.rect;
    let at = first.y * rect.z + first.x;
    crack_words[at] = vec2(east.x, south.x);
    if first.x + 1 < rect.z {
        crack_words[at + 1] = vec2(east.y, south.y);
    }
    if first.x + 2 < rect.z {
        crack_words[at + 2] = vec2(east.z, south.z);
    }
    if first.x + 3 < rect.z {
        crack_words[at + 3] = vec2(east.w, south.w);
    }
}

// The cracks of four columns to one side: one bit for each row of a cell.
struct Bits {
    found: vec4<u32>,
    certain: vec4<u32>,
    ledge: vec4<u32>,
    silhouette: vec4<u32>,
}

// One bit for each crack.
fn bits(are: vec4<bool>, bit: u32) -> vec4<u32> {
    return select(vec4(0u), vec4(1u << bit), are);
}

fn add_bits(all: ptr<function, Bits>, row: Cracks, bit: u32) {
    (*all).found |= bits((row.packed != vec4(0u)) & !row.ledge, bit);
    (*all).certain |= bits(row.certain, bit);
    (*all).ledge |= bits(row.ledge, bit);
    (*all).silhouette |= bits((row.packed & vec4(SILHOUETTE)) != vec4(0u), bit);
}

// Adds the cracks of a cell to the planes. `rows`: the certain cracks to the south, in the grid.
fn store_bits(cell: vec2<i32>, east: Bits, south: Bits, rows: vec4<u32>) {
    add_columns(FOUND_EAST, cell, east.found);
    add_columns(FOUND_SOUTH, cell, south.found);
#ifdef COMPLETED
    add_columns(LINKED_EAST, cell, east.certain);
    add_columns(LINKED_SOUTH, cell, south.certain);
#ifdef SILHOUETTES
    add_columns(SILHOUETTE_EAST, cell, east.silhouette);
    add_columns(SILHOUETTE_SOUTH, cell, south.silhouette);
#endif
#ifdef LEDGES
    add_columns(LEDGE_EAST, cell, east.ledge);
    add_columns(LEDGE_SOUTH, cell, south.ledge);
#endif
    add_rows(cell, rows);
#endif
}

@compute @workgroup_size(32)
fn find_in_cells(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) place: u32,
) {
    let cell = listed_cell(group, place);
    if cell.x < 0 {
        return;
    }
    set_view(line_pass.seen);
    let s = line_pass.settings;
    let last = line_pass.grid.rect.zw - 1;
    let columns = four_columns(line_pass.grid.rect, cell.x);
    var above: Above;
    // Cracks to the east in the row above those that were found last.
    var east_before = vec4(0u);
    var all_east: Bits;
    var all_south: Bits;
    // The first rows only go before others.
    for (var i = -2; i < 2; i++) {
        step_down(&above, columns, cell.y + i);
    }
    for (var i = 2; i <= CELL_ROWS + 2; i++) {
        let borders = step_down(&above, columns, cell.y + i);
        let east = cracks(s, borders.east);
        let south = cracks(s, borders.south);
        if i <= CELL_ROWS + 1 && cell.y + i - 2 <= last.y {
            add_bits(&all_east, east, u32(i - 2));
        }
        let y = cell.y + i - 3;
        if i >= 3 && y <= last.y {
            add_bits(&all_south, south, u32(i - 3));
            store_row(vec2(cell.x, y), east_before, south.packed);
        }
        east_before = east.packed;
    }
    let own = columns.own < vec4(0, 1, 2, 3) + cell.x;
    store_bits(cell, all_east, all_south, select(all_south.certain, vec4(0u), own));
}
