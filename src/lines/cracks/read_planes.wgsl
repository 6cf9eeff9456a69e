#define_import_path bevy_comics::lines::read_planes

// Reads planes of bits: the only module that declares binding 20. Outside of the grid there
// are no cracks.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::planes::{
    FOUND_EAST, FOUND_SOUTH, LINKED_EAST, LINKED_SOUTH, across_words, column_word, row_word,
}

@group(0) @binding(20) var<storage> planes: array<u32>;

fn load_column(g: Grid, plane: i32, x: i32, band: i32) -> u32 {
    let inside = x >= 0 && x < g.rect.z && band >= 0 && band < g.words.y;
    return select(0u, planes[column_word(g, plane, select(0, x, inside), select(0, band, inside))], inside);
}

fn load_row(g: Grid, word: i32, y: i32) -> u32 {
    let inside = word >= 0 && word < g.words.x && y >= 0 && y < g.rect.w;
    return select(0u, planes[row_word(g, select(0, word, inside), select(0, y, inside))], inside);
}

// The rows y to y + 31 of a column.
fn column_window(g: Grid, plane: i32, x: i32, y: i32) -> u32 {
    let band = y >> 5u;
    return across_words(load_column(g, plane, x, band), load_column(g, plane, x, band + 1), u32(y & 31));
}

// The rows `first` to `last` of a column, of which there are at most 32: bit 0 is the first.
fn column_rows(g: Grid, plane: i32, x: i32, first: i32, last: i32) -> u32 {
    let band = first >> 5u;
    var next = 0u;
    if last >> 5u > band {
        next = load_column(g, plane, x, band + 1);
    }
    let rows = across_words(load_column(g, plane, x, band), next, u32(first & 31));
    return rows & (0xffffffffu >> u32(31 + first - last));
}

// The same of the cracks with ink, to the east (x) and to the south (y). COMPLETED: only parts
// of lines have ink.
fn inked_rows(g: Grid, x: i32, first: i32, last: i32) -> vec2<u32> {
#ifdef COMPLETED
    return vec2(column_rows(g, LINKED_EAST, x, first, last), column_rows(g, LINKED_SOUTH, x, first, last));
#else
    return vec2(column_rows(g, FOUND_EAST, x, first, last), column_rows(g, FOUND_SOUTH, x, first, last));
#endif
}

// The columns x to x + 31 of a row of LINKED_SOUTH.
fn row_window(g: Grid, x: i32, y: i32) -> u32 {
    let word = x >> 5u;
    return across_words(load_row(g, word, y), load_row(g, word + 1, y), u32(x & 31));
}
