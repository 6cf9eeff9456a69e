//! Which pixels of the grid matter to a tile.

use super::*;

/// Pixels along a side of a tile.
const TILE: i64 = 16;

/// [column and row of the tile, scale and offset of the grid, pixels around a crack]
fn tile() -> impl Strategy<Value = [f32; 7]> {
    let scale = || prop_oneof![2 => Just(1.0f32), 2 => Just(0.5f32), 1 => 0.3f32..1.0];
    let offset = || prop_oneof![2 => Just(0.0f32), 1 => -1.0f32..1.0];
    let first = || (0..200i32).prop_map(|n| 16.0 * n as f32);
    let grid = ((scale(), scale()), (offset(), offset()));
    (first(), first(), grid, 1..40i32)
        .prop_map(|(x, y, ((sx, sy), (ox, oy)), around)| [x, y, sx, sy, ox, oy, around as f32])
}

/// The surroundings of each of a tile's pixels are pixels that may ink it, and at most two rows
/// and columns more are.
#[test]
fn a_tile_knows_every_pixel_that_may_ink_it() {
    for_batches(tile(), |rows| {
        let inked = gpu().evaluate(
            "#import bevy_comics::lines::edge::Grid
             #import bevy_comics::lines::blocks::inked_by",
            "var g: Grid;
             g.from_viewport = vec4(i(2u), i(3u), i(4u), i(5u));
             g.inked = i32(i(6u));
             return vec4<f32>(inked_by(g, vec2(i32(i(0u)), i32(i(1u)))));",
            rows,
        );
        for (row, found) in rows.iter().zip(inked) {
            let around = row[6] as i64;
            let found = found.map(|n| n as i64);
            for axis in [0, 1] {
                let [first, scale, offset] = [axis, axis + 2, axis + 4].map(|i| f64::from(row[i]));
                let at = |pixel: i64| (first + pixel as f64 + 0.5).mul_add(scale, offset).floor();
                let [low, high] = [at(0) as i64 - around, at(TILE - 1) as i64 + around];
                let [before, behind] = [low - found[axis], found[axis + 2] - high];
                let is_tight = |more: i64| (0..=2).contains(&more);
                assert!(is_tight(before) && is_tight(behind), "{row:?}: {found:?}");
            }
        }
    });
}
