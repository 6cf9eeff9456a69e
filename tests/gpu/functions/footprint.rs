//! What a pixel covers: singular values.

use bevy_comics_testkit::reference::footprint::singular_values;

use super::*;
use crate::prelude::*;

/// Axes at any angle, turned in the picture, of which the shorter one is down to a ten-thousandth
/// of the longer one.
pub fn change() -> impl Strategy<Value = [f32; 4]> {
    let turn = 0.0f32..std::f32::consts::TAU;
    (turn.clone(), turn, -8.0f32..8.0, -13.0f32..0.0).prop_map(|(map, screen, long, ratio)| {
        let long = long.exp2();
        let short = long * ratio.exp2();
        let [a, b] = [map, screen].map(|turn| (turn.cos(), turn.sin()));
        let axis = |u: f32, v: f32| [u * a.0 - v * a.1, u * a.1 + v * a.0];
        let [right, down] = [
            axis(long * b.0, -short * b.1),
            axis(long * b.1, short * b.0),
        ];
        [right[0], right[1], down[0], down[1]]
    })
}

pub fn pair(row: &[f32; 4]) -> (DVec2, DVec2) {
    let [a, b, c, d] = row.map(f64::from);
    (DVec2::new(a, b), DVec2::new(c, d))
}

/// Relative errors of the two axes. Where both are equally long, the longer one is the root of the
/// root of a difference that vanishes: its error is at most the root of that of a number. The
/// products of the determinant are up to the square of the long axis, and cancel; the shorter axis
/// is that over the longer one.
pub fn rounding(long: f64, short: f64) -> [f64; 2] {
    let unit = 2f64.powi(-24);
    let uneven = (1.0 - short / long).max(2f64.powi(-12));
    let long_off = 8.0 * unit / uneven;
    [long_off, long_off + 4.0 * unit * long / short]
}

#[test]
fn axes_of_pixels_match_the_reference() {
    for_batches(change(), |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effect::footprint::singular_values",
            "return vec4(singular_values(vec2(i(0u), i(1u)), vec2(i(2u), i(3u))), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let (right, down) = pair(row);
            let [long, short] = singular_values(right, down);
            let most = rounding(long, short);
            for (k, axis) in [long, short].into_iter().enumerate() {
                let off = (f64::from(found[k]) - axis).abs() / axis;
                assert!(off < most[k], "{row:?}: {found:?}, {axis}: {off}");
            }
        }
    });
}
