//! Where the planes of bits are stored.

use bevy_comics_testkit::reference::planes::column_word;

use super::*;

const PLANES: &str = "#import bevy_comics::lines::edge::Grid
    #import bevy_comics::lines::planes::{across_words, column_word, row_word}";

/// Width and height in pixels.
const SIZES: [[i64; 2]; 5] = [[1, 1], [31, 33], [32, 32], [65, 7], [160, 90]];

/// No two pixels share a bit of the buffer, and no word of it is unused: behind eight planes by
/// columns is one by rows. Where the planes by columns are read back, they are as they are stored.
#[test]
fn every_word_of_the_planes_has_a_place_of_its_own() {
    for size @ [width, height] in SIZES {
        let [across, down] = size.map(|n| (n + 31) / 32);
        let columns = (0..8).flat_map(|plane| {
            (0..down).flat_map(move |band| (0..width).map(move |x| [plane, x, band]))
        });
        let rows = (0..height).flat_map(|y| (0..across).map(move |word| [8, word, y]));
        let all: Vec<[i64; 3]> = columns.chain(rows).collect();
        let body = format!(
            "var g: Grid;
             g.rect = vec4(0, 0, {width}, {height});
             g.words = (g.rect.zw + 31) / 32;
             let p = vec3(i32(i(0u)), i32(i(1u)), i32(i(2u)));
             if p.x == 8 {{ return vec4(f32(row_word(g, p.y, p.z))); }}
             return vec4(f32(column_word(g, p.x, p.y, p.z)));"
        );
        let numbers: Vec<[f32; 3]> = all.iter().map(|word| word.map(|n| n as f32)).collect();
        let mut places = BTreeSet::new();
        for (word, found) in all.iter().zip(gpu().evaluate(PLANES, &body, &numbers)) {
            let place = found[0] as i64;
            let [plane, x, band] = *word;
            if plane < 8 {
                assert_eq!(place, column_word(size, plane, x, band), "{word:?}");
            }
            assert!(places.insert(place), "{size:?}: {word:?}");
        }
        assert!(places.iter().copied().eq(0..places.len() as i64));
    }
}

/// Bit n of a window over two words is that of the pixel `first` + n, wherever it begins.
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
            let [a, b, c, d, first] = row.map(|n| n as u64);
            let want = (a | b << 16 | c << 32 | d << 48) >> first;
            let found = found[0] as u64 | (found[1] as u64) << 16;
            assert_eq!(found, want & 0xffff_ffff, "{row:?}");
        }
    });
}
