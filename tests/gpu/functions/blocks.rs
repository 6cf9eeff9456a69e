//! Which rows of a block and which pixels of the grid matter to a tile.

use bevy_comics_testkit::reference::blocks::{
    TILE, block_rows, inked_by, searched_by, tile_rectangle,
};

use super::*;

const BLOCKS: &str = "#import bevy_comics::lines::edge::Grid
    #import bevy_comics::lines::blocks::{block_rows, inked_by, searched_by, tile_rectangle}";

/// Every range of rows that begins or ends in a block or up to two rows beside it.
#[test]
fn rows_of_a_block_match_the_reference() {
    for top in [0, 32, 64] {
        let rows: Vec<[f32; 3]> = (-2..34)
            .flat_map(|first| (first..34).map(move |last| [first, last]))
            .filter(|[first, last]| *last >= 0 && *first < 32)
            .map(|[first, last]| [top, top + first, top + last].map(|n| n as f32))
            .collect();
        let results = gpu().evaluate(
            BLOCKS,
            "let bits = block_rows(i32(i(0u)), i32(i(1u)), i32(i(2u)));
             return vec4(f32(bits & 0xffffu), f32(bits >> 16u), 0.0, 0.0);",
            &rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let bits = found[0] as u32 | (found[1] as u32) << 16;
            let [top, first, last] = row.map(|n| n as i64);
            assert_eq!(bits, block_rows(top, first, last), "{row:?}");
        }
    }
}

/// [column and row of the tile, scale and offset of the grid, pixels around a crack]
fn tile() -> impl Strategy<Value = [f32; 7]> {
    let scale = || prop_oneof![2 => Just(1.0f32), 2 => Just(0.5f32), 1 => 0.3f32..1.0];
    let offset = || prop_oneof![2 => Just(0.0f32), 1 => -1.0f32..1.0];
    (
        (0..200i32, 0..200i32),
        (scale(), scale()),
        (offset(), offset()),
        1..40i32,
    )
        .prop_map(|((x, y), (sx, sy), (ox, oy), around)| {
            [
                16.0 * x as f32,
                16.0 * y as f32,
                sx,
                sy,
                ox,
                oy,
                around as f32,
            ]
        })
}

fn part(row: &[f32; 7]) -> ([i64; 2], [f64; 4], i64) {
    let [x, y, sx, sy, ox, oy, around] = *row;
    (
        [x as i64, y as i64],
        [sx, sy, ox, oy].map(f64::from),
        around as i64,
    )
}

/// The part of a tile matches its reference's, up to a pixel where a position is whole, and
/// contains the surroundings of each of the tile's pixels.
#[test]
fn a_tile_knows_every_pixel_that_may_ink_it() {
    for_batches(tile(), |rows| {
        let inked = gpu().evaluate(
            BLOCKS,
            "var g: Grid;
             g.from_viewport = vec4(i(2u), i(3u), i(4u), i(5u));
             g.inked = i32(i(6u));
             return vec4<f32>(inked_by(g, vec2(i32(i(0u)), i32(i(1u)))));",
            rows,
        );
        for (row, found) in rows.iter().zip(inked) {
            let (first, [sx, sy, ox, oy], around) = part(row);
            let found = found.map(|n| n as i64);
            let want = inked_by(first, [sx, sy, ox, oy], around);
            for i in 0..4 {
                assert!(
                    (found[i] - want[i]).abs() <= 1,
                    "{row:?}: {found:?}, {want:?}"
                );
            }
            if [sx, sy].map(f64::fract) == [0.0; 2] && [ox, oy] == [0.0; 2] {
                assert_eq!(found, want, "{row:?}");
            }
            for pixel in 0..TILE {
                let x = ((first[0] + pixel) as f64 + 0.5).mul_add(sx, ox).floor() as i64;
                let y = ((first[1] + pixel) as f64 + 0.5).mul_add(sy, oy).floor() as i64;
                assert!(found[0] <= x - around && x + around <= found[2], "{row:?}");
                assert!(found[1] <= y - around && y + around <= found[3], "{row:?}");
            }
        }
    });
}

/// What is searched for a tile of the grid are its columns, and the rows in reach.
#[test]
fn the_search_for_a_tile_reaches_up_and_down() {
    for_batches(tile(), |rows| {
        let searched = gpu().evaluate(
            BLOCKS,
            "var g: Grid;
             g.reach = i32(i(6u));
             return vec4<f32>(searched_by(g, vec2(i32(i(0u)), i32(i(1u)))));",
            rows,
        );
        for (row, found) in rows.iter().zip(searched) {
            let (first, _, reach) = part(row);
            assert_eq!(
                found.map(|n| n as i64),
                searched_by(first, reach),
                "{row:?}"
            );
        }
    });
}

/// Tiles of a target of odd size cover it without gaps: the edges of a rectangle are those
/// of its pixels within 1/100 pixel.
#[test]
fn the_rectangles_of_tiles_cover_the_target() {
    let sizes = [[1, 1], [15, 17], [157, 91], [1280, 720], [3840, 2160]];
    let rows: Vec<[f32; 4]> = sizes
        .iter()
        .flat_map(|&[w, h]: &[i64; 2]| {
            let along = |n: i64| (0..n).step_by(TILE as usize);
            along(w).flat_map(move |x| along(h).map(move |y| [x, y, w, h].map(|n| n as f32)))
        })
        .collect();
    let results = gpu().evaluate(
        BLOCKS,
        "return tile_rectangle(vec2(i32(i(0u)), i32(i(1u))), vec2(i32(i(2u)), i32(i(3u))));",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        let [x, y, w, h] = row.map(|n| n as i64);
        let want = tile_rectangle([x, y], [w, h]);
        let pixels = [w, h, w, h].map(|n| n as f64 / 2.0);
        for i in 0..4 {
            let apart = (f64::from(found[i]) - want[i]).abs() * pixels[i];
            assert!(apart < 0.01, "{row:?}: {found:?}, {want:?}");
        }
    }
}
