#define_import_path bevy_comics::lines::read_planes

// Reads planes of bits: the only module that declares binding 20. Outside of the grid there
// are no cracks.

#import bevy_comics::lines::edge::Grid
#import bevy_comics::lines::planes::{
    FOUND_EAST, FOUND_SOUTH, LINKED_EAST, LINKED_SOUTH, across_words, column_word, corner_word, row_word,
}

@group(0) @binding(20) var<storage> planes: array<u32>;

fn load_column(g: Grid, plane: i32, x: i32, band: i32) -> u32 {
    let inside = x >= 0 && x < g.rect.z && band >= 0 && band < g.words.y;
    return select(0u, planes[column_word(g, plane, select(0, x, inside), select(0, band, inside))], inside);
}

// The bit of a pixel.
fn column_bit(g: Grid, plane: i32, x: i32, y: i32) -> u32 {
    return (load_column(g, plane, x, y >> 5u) >> u32(y & 31)) & 1u;
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

// A word of the cracks of lines in a row: of those to the south, 32 columns of the row `across`; of
// those to the east, 32 rows of the column `across`.
fn load_along(g: Grid, south: bool, word: i32, across: i32) -> u32 {
    let size = select(vec2(g.words.y, g.rect.z), vec2(g.words.x, g.rect.w), south);
    let inside = word >= 0 && word < size.x && across >= 0 && across < size.y;
    let at = select(column_word(g, LINKED_EAST, across, word), row_word(g, word, across), south);
    return select(0u, planes[select(0, at, inside)], inside);
}

// Which of the 32 cracks in a row that begin with a crack, see chain.wgsl, are parts of lines: bit 0 is that one.
fn cracks_from(g: Grid, crack: vec3<i32>) -> u32 {
    let south = crack.z == 1;
    let place = select(crack.yx, crack.xy, south);
    let word = place.x >> 5u;
    return across_words(load_along(g, south, word, place.y), load_along(g, south, word + 1, place.y), u32(place.x & 31));
}

// Which of the four cracks at a corner are parts of lines: bit 0 and 1 above and below the
// corner, bit 2 and 3 to the left and right of it.
fn cracks_at(g: Grid, corner: vec2<i32>) -> u32 {
    let eight = planes[corner_word(g, corner.x, corner.y >> 2u)];
    return (eight >> (4u * u32(corner.y & 3))) & 15u;
}

// The same of four corners in a column, from the row `first` on: four bits each. Around the grid there are none.
fn corner_rows(g: Grid, x: i32, first: i32) -> u32 {
    let quad = first >> 2u;
    let inside = x >= 0 && x <= g.rect.z && quad >= -1 && quad <= g.rect.w >> 2u;
    let eight = planes[corner_word(g, select(0, x, inside), select(0, quad, inside))];
    return select(0u, (eight >> (4u * u32(first & 3))) & 0xffffu, inside);
}
