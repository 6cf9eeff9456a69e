//! Reference of `lines/tiles/blocks.wgsl`: which rows and pixels matter to a block or tile.

/// Width and height of a tile in pixels.
pub const TILE: i64 = 16;
/// Rows of a block.
pub const BLOCK_HEIGHT: i64 = 32;

/// Bits of the rows of a block that begins at the row `top`, from `first` to `last`.
pub fn block_rows(top: i64, first: i64, last: i64) -> u32 {
    (0..BLOCK_HEIGHT)
        .filter(|row| (first..=last).contains(&(top + row)))
        .fold(0, |bits, row| bits | 1 << row)
}

/// First and last column and row of the pixels of the grid that may ink a tile of the
/// viewport. `from_viewport`: scale and offset; `inked`: pixels around a crack.
pub fn inked_by(first: [i64; 2], from_viewport: [f64; 4], inked: i64) -> [i64; 4] {
    let [sx, sy, ox, oy] = from_viewport;
    let [x, y] = first.map(|n| n as f64);
    let end = TILE as f64;
    [
        (x * sx + ox).floor() as i64 - inked,
        (y * sy + oy).floor() as i64 - inked,
        ((x + end) * sx + ox).ceil() as i64 + inked,
        ((y + end) * sy + oy).ceil() as i64 + inked,
    ]
}

/// The same of the pixels whose cracks are searched for a tile of the grid.
pub fn searched_by([x, y]: [i64; 2], reach: i64) -> [i64; 4] {
    [x, y - reach - 1, x + TILE - 1, y + TILE - 1 + reach]
}

/// Left, top, right and bottom of a tile in clip space.
pub fn tile_rectangle(first: [i64; 2], size: [i64; 2]) -> [f64; 4] {
    let clip = |i: usize, pixel: i64| 2.0 * pixel as f64 / size[i] as f64 - 1.0;
    let end = |i: usize| (first[i] + TILE).min(size[i]);
    [
        clip(0, first[0]),
        -clip(1, first[1]),
        clip(0, end(0)),
        -clip(1, end(1)),
    ]
}
