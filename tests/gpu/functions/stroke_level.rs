//! The level of strokes along an axis of a map.

use bevy_comics_testkit::reference::footprint::singular_values;

use super::{
    footprint::{change, pair, rounding},
    *,
};

/// The level is that of the change across the strokes, or of a quarter of the longest change.
#[test]
fn levels_of_strokes_match_the_reference() {
    for_batches(change(), |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::toon::stroke_level::stroke_level",
            "return vec4(stroke_level(vec2(i(0u), i(1u)), vec2(i(2u), i(3u))), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let (right, down) = pair(row);
            let [long, short] = singular_values(right, down);
            let level = right.y.hypot(down.y).max(0.25 * long).log2();
            // It is kept between those of both axes; logarithms of GPUs are off by up to 3 ulp.
            let off = (f64::from(found[0]) - level).abs();
            let most = 1e-5 + 1.5 * rounding(long, short)[0];
            assert!(off < most, "{row:?}: {found:?}, {level}");
        }
    });
}
