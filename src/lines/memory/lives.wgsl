#define_import_path bevy_comics::lines::lives

// For how many frames lines stay where their edges have become weak: their lives. Pure functions.
//
// A word has the lives of four pixels in a row, a byte for each: bits 0 to 3 are the life of the
// crack to the east, bits 4 to 7 that of the crack to the south.

#import bevy_comics::lines::edge::Grid

// The word of a pixel of the grid.
fn life_word(g: Grid, p: vec2<i32>) -> i32 {
    return p.y * ((g.rect.z + 3) >> 2u) + (p.x >> 2u);
}

// The first bit of the life of a crack in its word, see chain.wgsl.
fn life_shift(crack: vec3<i32>) -> u32 {
    return u32((crack.x & 3) * 8 + crack.z * 4);
}

// The life of a found crack: that of a line, or a frame less than in the last frame. `past`:
// the longest life around it in the last frame.
fn next_life(is_line: bool, past: u32, longest: u32) -> u32 {
    return select(max(past, 1u) - 1u, longest, is_line);
}
