//! Nested marks: numbers of nodes, breaks of strokes.

use bevy_comics_testkit::reference::nested::{mark_of_node, stroke_factor};

use super::*;

#[test]
fn numbers_of_nodes_match_the_reference() {
    let row = (-64i32..=64, -64i32..=64, 0u32..=6, -20i32..=20, 0u32..=20).prop_map(
        |(x, y, twos, exponent, seed)| {
            let [x, y] = [x, y].map(|i| (i << twos) as f32);
            [x, y, exponent as f32, seed as f32]
        },
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effect::nested::mark_of_node",
            "let node = vec2(i32(i(0u)), i32(i(1u)));
             let mark = mark_of_node(node, i32(i(2u)), u32(i(3u)));
             let coarser = mark_of_node(node * 2, i32(i(2u)) - 1, u32(i(3u)));
             return vec4(f32(mark >> 16u), f32(mark & 0xffffu), f32(coarser == mark), 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let node = [row[0], row[1]].map(|i| i as i64);
            let want = mark_of_node(node, row[2] as i32, row[3] as u32);
            let got = (found[0] as u32) << 16 | found[1] as u32;
            assert_eq!(got, want, "{row:?}");
            // The same node at the next finer level.
            assert_eq!(found[2], 1.0, "{row:?}");
        }
    });
}

/// Truth: breaks leave the mean width of a line as it is.
#[test]
fn the_mean_of_strokes_is_one() {
    for breaks in [0.0, 0.3, 1.0] {
        for grown in [0.0, 0.4, 1.0] {
            let count = 20_000;
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(count);
            let sum: f64 = (0..count)
                .map(|i| stroke_factor(at(i), grown, breaks))
                .sum();
            let mean = sum / f64::from(count);
            assert!((mean - 1.0).abs() < 1e-4, "{breaks}, {grown}: {mean}");
        }
    }
}
