#define_import_path bevy_comics::lines::near

// Which cracks near a position of the grid have ink, for lines that reach no farther than the next
// pixels.

#import bevy_comics::lines::edge::Grid
#ifdef COMPLETED
#import bevy_comics::lines::read_planes::corner_rows
#else
#import bevy_comics::lines::read_planes::inked_rows
#endif

#ifdef COMPLETED
// The cracks of four rows of two columns of pixels, from the row `first` on: bit 4 * row + 2 * column + side.
fn two_columns(g: Grid, columns: vec2<i32>, first: i32) -> u32 {
    // The cracks of a pixel meet at its lower right corner: above that corner, and to the left of it.
    let corners = corner_rows(g, columns.x + 1, first + 1) | (corner_rows(g, columns.y + 1, first + 1) << 16u);
    let sides = corners & 0x55555555u;
    let pairs = (sides | (sides >> 1u)) & 0x33333333u;
    return (pairs & 0xffffu) | (pairs >> 14u);
}

// The four bits of each row, as the lower ones of eight.
fn spread(rows: u32) -> u32 {
    let halves = (rows | (rows << 8u)) & 0x00ff00ffu;
    return (halves | (halves << 4u)) & 0x0f0f0f0fu;
}

// All cracks near a position, as in near_cracks.
fn all_near(g: Grid, center: vec2<i32>) -> u32 {
    let first = center.y - 2;
    let before = two_columns(g, vec2(center.x - 1, center.x), first);
    let behind = two_columns(g, vec2(center.x + 1, center.x - 2), first);
    let rows = spread(before) | (spread(behind) << 4u);
    // The row two before the position comes last.
    return (rows >> 8u) | (rows << 24u);
}
#else
// The lower four bits of a word, in bits 0, 8, 16 and 24, the first one last.
fn spread(word: u32) -> u32 {
    let turned = ((word & 15u) >> 1u) | ((word & 1u) << 3u);
    return (turned * 0x00204081u) & 0x01010101u;
}

// All cracks near a position, as in near_cracks.
fn all_near(g: Grid, center: vec2<i32>) -> u32 {
    var near = 0u;
    for (var column = 0u; column < 4u; column++) {
        let x = center.x + near_step(column);
        let inked = inked_rows(g, x, center.y - 2, center.y + 1);
        near |= (spread(inked.x) | (spread(inked.y) << 1u)) << (2u * column);
    }
    return near;
}
#endif

// Which cracks near a position have ink: bit 8 * row + 2 * column + side, where side is
// 0 to the east and 1 to the south. Rows and columns 0 to 3 are those one before the position,
// its own, the next one, and those two before it.
fn near_cracks(g: Grid, center: vec2<i32>) -> u32 {
    let near = all_near(g, center);
#ifdef SMOOTH
    // Lines leave their cracks by up to half a pixel. The pixel two before in both directions is
    // too far away.
    return near & 0x3fffffffu;
#else
    // The cracks of the next pixel in both directions are behind it.
    return near & 0x000f3f3fu;
#endif
}

// From the position to a row or column of near_cracks.
fn near_step(place: u32) -> i32 {
    return i32((place + 1u) & 3u) - 2;
}
