//! Tonal art maps: levels, thresholds, planes.

use bevy::math::{DVec2, DVec3};
use bevy_comics_testkit::reference::{
    art_map::{ink_at, plane_tone, plane_weights},
    footprint::singular_values,
    stroke_level::stroke_level,
};

use super::*;

const LEVEL: &str = "
    #import bevy_comics::cartoon::stroke_level::stroke_level
    #import bevy_comics::effect::footprint::singular_values";
const MAP: &str = "#import bevy_comics::cartoon::art_map::{ink_at, plane_tone, plane_weights}";

/// Axes at any angle, turned in the picture, of which the shorter one is down to a ten-thousandth of
/// the longer one.
fn change() -> impl Strategy<Value = [f32; 4]> {
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

fn pair(row: &[f32; 4]) -> (DVec2, DVec2) {
    let [a, b, c, d] = row.map(f64::from);
    (DVec2::new(a, b), DVec2::new(c, d))
}

/// Relative errors of the two axes. Where both are equally long, the longer one is the root of the
/// root of a difference that vanishes: its error is at most the root of that of a number. The
/// products of the determinant are up to the square of the long axis, and cancel; the shorter axis is
/// that over the longer one.
fn rounding(long: f64, short: f64) -> [f64; 2] {
    let unit = 2f64.powi(-24);
    let uneven = (1.0 - short / long).max(2f64.powi(-12));
    let long_off = 8.0 * unit / uneven;
    [long_off, long_off + 4.0 * unit * long / short]
}

#[test]
fn axes_of_pixels_are_those_of_the_twin() {
    for_batches(change(), |rows| {
        let results = gpu().evaluate(
            LEVEL,
            "let right = vec2(i(0u), i(1u));
             let down = vec2(i(2u), i(3u));
             return vec4(singular_values(right, down), stroke_level(right, down), 0.0);",
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
            let level = stroke_level(right, down);
            // It is kept between those of both axes; logarithms of GPUs are off by up to 3 ulp.
            let off = (f64::from(found[2]) - level).abs();
            assert!(off < 1e-5 + 1.5 * most[0], "{row:?}: {found:?}, {level}");
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
        LEVEL,
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

#[test]
fn thresholds_and_planes_are_those_of_the_twin() {
    let row = (0.0f32..=1.0, 0.0f32..=1.0, vec(-1.0f32..=1.0, 3)).prop_filter_map(
        "a direction",
        |(tone, threshold, n)| {
            let normal = bevy::math::Vec3::new(n[0], n[1], n[2]);
            let n = normal.try_normalize().filter(|_| normal.length() > 0.1)?;
            Some([tone, threshold, n.x, n.y, n.z])
        },
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            MAP,
            "let w = plane_weights(vec3(i(2u), i(3u), i(4u)));
             return vec4(w, plane_tone(i(0u), w.x));",
            rows,
        );
        let inks = gpu().evaluate(MAP, "return vec4(ink_at(i(0u), i(1u)));", rows);
        for ((row, found), ink) in rows.iter().zip(results).zip(inks) {
            let [tone, threshold, x, y, z] = row.map(f64::from);
            let w = plane_weights(DVec3::new(x, y, z));
            for (found, want) in found.iter().zip(w.to_array()) {
                // Squares minus 0.2, over a sum of at least 0.05.
                assert!(
                    (f64::from(*found) - want).abs() < 1e-4,
                    "{row:?}: {found}, {want}"
                );
            }
            let part = plane_tone(tone, w.x);
            assert!(
                (f64::from(found[3]) - part).abs() < 2e-3,
                "{row:?}: {found:?}, {part}"
            );
            let want = ink_at(tone, threshold);
            // Rounding of the difference, over the width of the step.
            assert!(
                (f64::from(ink[0]) - want).abs() < 1e-4,
                "{row:?}: {ink:?}, {want}"
            );
        }
    });
}

/// Truth: the planes of a surface have its tone together, as far as they are independent.
#[test]
fn tones_of_planes_multiply_to_the_tone() {
    for tone in [0.0, 0.2, 0.7, 0.99] {
        for normal in [DVec3::X, DVec3::new(1.0, 1.0, 0.2), DVec3::ONE] {
            let w = plane_weights(normal.normalize());
            let light: f64 = (0..3).map(|k| 1.0 - plane_tone(tone, w[k])).product();
            assert!(
                (1.0 - light - tone).abs() < 1e-12,
                "{tone}, {normal}: {light}"
            );
        }
    }
}
