//! The level of strokes along an axis of a map.

use bevy_comics_testkit::reference::{footprint::singular_values, stroke_level::stroke_level};

use super::{
    footprint::{change, pair, rounding},
    *,
};
use crate::prelude::*;

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
            let level = stroke_level(right, down);
            // It is kept between those of both axes; logarithms of GPUs are off by up to 3 ulp.
            let off = (f64::from(found[0]) - level).abs();
            let most = 1e-5 + 1.5 * rounding(long, short)[0];
            assert!(off < most, "{row:?}: {found:?}, {level}");
        }
    });
}

/// Rotating the screen does not change the axes: strokes do not breathe while the camera rolls.
#[test]
fn axes_do_not_depend_on_the_roll_of_the_camera() {
    for roll in 0..16 {
        let turn = DVec2::from_angle(0.4 * f64::from(roll));
        let (right, down) = (DVec2::new(3.0, 0.5), DVec2::new(-0.2, 0.7));
        let rolled = (
            right * turn.x + down * turn.y,
            down * turn.x - right * turn.y,
        );
        let [a, b] = [(right, down), rolled].map(|(right, down)| stroke_level(right, down));
        assert!((a - b).abs() < 1e-12, "{a}, {b}");
    }
}
