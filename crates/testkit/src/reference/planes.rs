//! Reference of `lines/cracks/planes.wgsl`: where planes of bits are stored.

/// Size of a grid in pixels.
pub type Size = [i64; 2];

/// Planes by columns; behind them is one by rows.
pub const COLUMN_PLANES: i64 = 8;

/// Words of 32 pixels across a grid and down it.
pub fn words([width, height]: Size) -> [i64; 2] {
    [(width + 31) / 32, (height + 31) / 32]
}

/// The word of a plane with the pixels (x, 32 band) to (x, 32 band + 31).
pub fn column_word(size: Size, plane: i64, x: i64, band: i64) -> i64 {
    let before = plane * words(size)[1] + band;
    before * size[0] + x
}

/// The word of the plane by rows with the pixels (32 word, y) to (32 word + 31, y).
pub fn row_word(size: Size, word: i64, y: i64) -> i64 {
    column_word(size, COLUMN_PLANES, 0, 0) + y * words(size)[0] + word
}

/// 32 bits of two words in a row, from the bit `first` of the one on.
pub fn across_words(word: u32, next: u32, first: u32) -> u32 {
    ((u64::from(next) << 32 | u64::from(word)) >> first) as u32
}
