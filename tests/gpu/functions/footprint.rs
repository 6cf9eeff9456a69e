//! What a pixel covers: singular values.

use bevy_comics_testkit::reference::footprint::singular_values;

use super::*;
use crate::prelude::*;

const FOOTPRINT: &str = "#import bevy_comics::effect::footprint::singular_values";

/// Axes at any angle, turned in the picture, of which the shorter one is down to a ten-thousandth of
/// the longer one.
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
/// products of the determinant are up to the square of the long axis, and cancel; the shorter axis is
/// that over the longer one.
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
            FOOTPRINT,
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

/// Where the axes differ by 1:5000 and more, the formula of the textbook has lost the shorter one, and
/// with it the level at which it would be sharp.
#[test]
fn the_formula_of_the_textbook_fails() {
    let textbook = |row: &[f32; 4]| {
        let sum: f32 = row.iter().map(|x| x * x).sum();
        let area = row[0] * row[3] - row[1] * row[2];
        (0.5 * (sum - (sum * sum - 4.0 * area * area).max(0.0).sqrt()))
            .max(0.0)
            .sqrt()
    };
    let rows: Vec<[f32; 4]> = (0..64)
        .map(|k| {
            let (sin, cos) = (0.1 + 0.09 * k as f32).sin_cos();
            // The long axis is 1 in the direction of this angle, the short one 1/10000.
            [
                cos * cos + 1e-4 * sin * sin,
                sin * cos * (1.0 - 1e-4),
                sin * cos * (1.0 - 1e-4),
                sin * sin + 1e-4 * cos * cos,
            ]
        })
        .collect();
    let results = gpu().evaluate(
        FOOTPRINT,
        "return vec4(singular_values(vec2(i(0u), i(1u)), vec2(i(2u), i(3u))), 0.0, 0.0);",
        &rows,
    );
    let (mut stable, mut failing) = (0.0f64, 0.0f64);
    for (row, found) in rows.iter().zip(results) {
        let (right, down) = pair(row);
        let [_, short] = singular_values(right, down);
        stable = stable.max((f64::from(found[1]) / short - 1.0).abs());
        failing = failing.max((f64::from(textbook(row)) / short - 1.0).abs());
    }
    println!("off by up to {stable:.1e}, by the textbook {failing:.2}");
    assert!(stable < rounding(1.0, 1e-4)[1], "{stable}");
    assert!(failing > 0.5, "{failing}");
}
