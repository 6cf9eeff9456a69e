//! Where the planes of bits are stored.

use bevy_comics_testkit::reference::planes::{
    COLUMN_PLANES, Size, across_words, column_word, row_word, words,
};

use super::*;
use crate::prelude::*;

const PLANES: &str = "#import bevy_comics::lines::edge::Grid
    #import bevy_comics::lines::planes::{across_words, column_word, row_word}";

/// A grid of (i(0), i(1)) pixels.
const GRID: &str = "var g: Grid;
    g.rect = vec4(0, 0, i32(i(0u)), i32(i(1u)));
    g.words = (g.rect.zw + 31) / 32;";

const SIZES: [Size; 5] = [[1, 1], [31, 33], [32, 32], [65, 7], [160, 90]];

/// Words of the planes by columns: [width, height, plane, x, band].
fn column_places() -> Vec<[f32; 5]> {
    let mut places = vec![];
    for size @ [width, height] in SIZES {
        for plane in 0..COLUMN_PLANES {
            for band in 0..words(size)[1] {
                let row = (0..width).map(|x| [width, height, plane, x, band].map(|n| n as f32));
                places.extend(row);
            }
        }
    }
    places
}

/// Words of the plane by rows: [width, height, word, y].
fn row_places() -> Vec<[f32; 4]> {
    let mut places = vec![];
    for size @ [width, height] in SIZES {
        for y in 0..height {
            let row = (0..words(size)[0]).map(|word| [width, height, word, y].map(|n| n as f32));
            places.extend(row);
        }
    }
    places
}

/// No two pixels share a bit of the buffer, and no word of it is unused.
#[test]
fn every_word_of_the_planes_has_a_place_of_its_own() {
    let columns = column_places();
    let body = "return vec4(f32(column_word(g, i32(i(2u)), i32(i(3u)), i32(i(4u)))));";
    let in_columns = gpu().evaluate(PLANES, &format!("{GRID} {body}"), &columns);
    let rows = row_places();
    let body = "return vec4(f32(row_word(g, i32(i(2u)), i32(i(3u)))));";
    let in_rows = gpu().evaluate(PLANES, &format!("{GRID} {body}"), &rows);
    for size in SIZES {
        let mut places = BTreeSet::new();
        for (place, found) in columns.iter().zip(&in_columns) {
            let [width, height, plane, x, band] = place.map(|n| n as i64);
            if [width, height] == size {
                assert_eq!(found[0] as i64, column_word(size, plane, x, band));
                assert!(places.insert(found[0] as i64), "{place:?}");
            }
        }
        for (place, found) in rows.iter().zip(&in_rows) {
            let [width, height, word, y] = place.map(|n| n as i64);
            if [width, height] == size {
                assert_eq!(found[0] as i64, row_word(size, word, y));
                assert!(places.insert(found[0] as i64), "{place:?}");
            }
        }
        assert!(places.iter().copied().eq(0..places.len() as i64));
    }
}

/// A window over two words has their bits, wherever it begins.
#[test]
fn a_window_begins_at_any_bit() {
    let half = || (0..65536u32).prop_map(|n| n as f32);
    let row = (half(), half(), half(), half(), 0..32u32)
        .prop_map(|(a, b, c, d, first)| [a, b, c, d, first as f32]);
    for_batches(row, |rows| {
        let windows = gpu().evaluate(
            PLANES,
            "let word = u32(i(0u)) | (u32(i(1u)) << 16u);
             let next = u32(i(2u)) | (u32(i(3u)) << 16u);
             let bits = across_words(word, next, u32(i(4u)));
             return vec4(f32(bits & 0xffffu), f32(bits >> 16u), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(windows) {
            let [a, b, c, d, first] = row.map(|n| n as u32);
            let want = across_words(a | b << 16, c | d << 16, first);
            assert_eq!(found[0] as u32 | (found[1] as u32) << 16, want, "{row:?}");
            // Truth: bit n is that of the pixel first + n.
            for n in 0..32 {
                let at = first + n;
                let half = [a, b, c, d][at as usize / 16];
                assert_eq!(want >> n & 1, half >> (at % 16) & 1, "{row:?}");
            }
        }
    });
}
