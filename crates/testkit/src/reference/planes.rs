//! Reference of `lines/cracks/planes.wgsl`: where planes of bits are stored.

/// The word of a plane with the pixels (x, 32 band) to (x, 32 band + 31), in a grid of this size in
/// pixels.
pub fn column_word([width, height]: [i64; 2], plane: i64, x: i64, band: i64) -> i64 {
    let bands = (height + 31) / 32;
    (plane * bands + band) * width + x
}
