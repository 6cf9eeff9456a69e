#define_import_path bevy_comics::lines::holds

// For how many frames lines are still held where their edges have become weak. Pure functions.
//
// A word has the holds of four pixels in a row, a byte for each: bits 0 to 3 are the hold of the
// crack to the east, bits 4 to 7 that of the crack to the south.

// The word of a pixel of a grid of this width.
fn hold_word(width: i32, p: vec2<i32>) -> i32 {
    return p.y * ((width + 3) >> 2u) + (p.x >> 2u);
}

// The first bit of the hold of a crack in its word, see chain.wgsl.
fn hold_shift(crack: vec3<i32>) -> u32 {
    return u32((crack.x & 3) * 8 + crack.z * 4);
}

// The pixel of a crack in the grid of the last frame: the crack nearest to its place there. `scale`:
// pixels of that grid per pixel of this one. `moved`: by how much the crack has moved, in pixels of
// that grid.
fn past_pixel(crack: vec3<i32>, scale: vec2<f32>, moved: vec2<f32>) -> vec2<i32> {
    // The middle of the border that the crack is, from the corner of its pixel.
    let middle = select(vec2(1.0, 0.5), vec2(0.5, 1.0), crack.z == 1);
    let place = (vec2<f32>(crack.xy) + middle) * scale - moved;
    return vec2<i32>(floor(place - middle + 0.5));
}

// The hold of a found crack: that of a line, or a frame less than in the last frame. `past`:
// the longest hold around it in the last frame.
fn next_hold(is_line: bool, past: u32, longest: u32) -> u32 {
    return select(max(past, 1u) - 1u, longest, is_line);
}
