#define_import_path bevy_comics::lines::planes

// Sizes of blocks and cells; and where cracks are, as planes of bits: one for each pixel
// that has a crack to the east, and one for each that has a crack to the south. A word holds
// 32 pixels of a column, or, in the plane ROWS_SOUTH, of a row.

#import bevy_comics::lines::edge::Grid

// Columns and rows of a block, two of which an invocation of walk.wgsl walks through, and rows
// of a cell, which an invocation of cells.wgsl walks through.
const COLUMNS: i32 = 4;
const ROWS: i32 = 32;
const CELL_ROWS: i32 = 8;
// Cells in a workgroup of cells.wgsl, and workgroups in a row of its dispatch.
const GROUP: u32 = 32u;
const GROUPS: u32 = 1024u;

// Planes, one after the other: cracks that are part of lines, those that may be, those that only
// join lines, and silhouettes.
const LINKED_EAST: i32 = 0;
const LINKED_SOUTH: i32 = 1;
const FOUND_EAST: i32 = 2;
const FOUND_SOUTH: i32 = 3;
const LEDGE_EAST: i32 = 4;
const LEDGE_SOUTH: i32 = 5;
const SILHOUETTE_EAST: i32 = 6;
const SILHOUETTE_SOUTH: i32 = 7;
// Behind them: LINKED_SOUTH by rows.
const ROWS_SOUTH: i32 = 8;

// The word of a plane with the pixel (x, 32 * band).
fn column_word(g: Grid, plane: i32, x: i32, band: i32) -> i32 {
    return (plane * g.words.y + band) * g.rect.z + x;
}

// The word of LINKED_SOUTH by rows with the pixel (32 * word, y).
fn row_word(g: Grid, word: i32, y: i32) -> i32 {
    return ROWS_SOUTH * g.words.y * g.rect.z + y * g.words.x + word;
}

// The word with the corners (x, 4 * quad) to (x, 4 * quad + 7), behind the planes: four bits each, see
// corners.wgsl. Words overlap, so that one of them has any four corners in a column. The first quad is -1. There
// is one more corner than pixels in a row and in a column.
fn corner_word(g: Grid, x: i32, quad: i32) -> i32 {
    let first = ROWS_SOUTH * g.words.y * g.rect.z + g.words.x * g.rect.w;
    return first + (quad + 1) * (g.rect.z + 1) + x;
}

// 32 bits of two words in a row, from bit `first` of the one on.
fn across_words(word: u32, next: u32, first: u32) -> u32 {
    return select((word >> first) | (next << (32u - first)), word, first == 0u);
}
