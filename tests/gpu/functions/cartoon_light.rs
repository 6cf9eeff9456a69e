//! Light of rectangles and of surroundings against their twins.

use bevy_comics_testkit::{
    device::gpu,
    reference::{rect, surroundings},
};
use proptest::prelude::Strategy;

use super::for_batches;

/// Numbers from 0 to 1 that differ for every `seed`.
fn spread(seed: u32) -> f32 {
    (seed.wrapping_mul(2_654_435_769) >> 8) as f32 / (1 << 24) as f32
}

/// Rectangles of 0.2 to 2 units, and places 0.5 to 20 units in front or behind.
fn places() -> Vec<[f32; 5]> {
    (0..600u32)
        .map(|i| {
            let r = |k: u32| spread(i * 5 + k);
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            [
                0.1 + r(0),
                0.1 + r(1),
                6.0 * (r(2) - 0.5),
                6.0 * (r(3) - 0.5),
                side * 0.5 * 40f32.powf(r(4)),
            ]
        })
        .collect()
}

/// The light vector of a rectangle is the integral over it.
#[test]
fn light_of_a_rectangle_is_the_integral_over_it() {
    let rows = places();
    let results = gpu().evaluate(
        "#import bevy_comics::cartoon::rect::{Rect, rect_light}",
        "let rect = Rect(vec3(i(0u), 0.0, 0.0), vec3(0.0, i(1u), 0.0));
         return vec4(rect_light(rect, vec3(i(2u), i(3u), i(4u))), 0.0);",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        let [w, h, x, y, z] = row.map(f64::from);
        let truth = rect::rect_light([w, 0.0, 0.0], [0.0, h, 0.0], [x, y, z], 96);
        let length = truth.iter().map(|c| c * c).sum::<f64>().sqrt();
        for (part, wanted) in found.into_iter().zip(truth) {
            // The error of the sum: its cells are at most a twentieth of the distance.
            let off = (f64::from(part) - wanted).abs();
            assert!(
                off <= 5e-4 * length + 1e-6,
                "{row:?}: {found:?}, not {truth:?}"
            );
        }
    }
}

/// A mirror shows the point that its ray meets, or one on the border; next to the
/// rectangle, corners and edges included, nothing is NaN.
#[test]
fn a_mirror_shows_a_point_of_the_rectangle() {
    let rows = places();
    let results = gpu().evaluate(
        "#import bevy_comics::cartoon::rect::{Rect, mirrored, rect_light}",
        "let rect = Rect(vec3(i(0u), 0.0, 0.0), vec3(0.0, i(1u), 0.0));
         let at = vec3(i(2u), i(3u), i(4u));
         let point = vec3(i(0u) * sin(i(2u)), i(1u) * sin(i(3u)), 0.0);
         let shown = mirrored(rect, at, normalize(point - at));
         let away = mirrored(rect, at, -normalize(point - at));
         let corner = rect_light(rect, rect.half_right + rect.half_up);
         let edge = rect_light(rect, rect.half_right);
         let outside = max(abs(away.x) - i(0u), abs(away.y) - i(1u));
         return vec4(distance(shown, point), outside, corner.x + edge.x, away.z);",
        &rows,
    );
    for (row, [off, outside, border, away]) in rows.iter().zip(results) {
        assert!(off < 2e-3, "{row:?}: {off} away from the point");
        assert!(outside < 1e-5 && away.abs() < 1e-5, "{row:?}: {outside}");
        assert!(border.is_finite(), "{row:?}");
    }
}

/// Both tones are the twin's, and neither is negative.
#[test]
fn two_tones_of_surroundings_are_their_twin() {
    let side = || (0.0f32..1.0, 0.0f32..1.0, 0.0f32..1.0);
    let row = (side(), side(), side(), side(), side(), side(), 0u32..4).prop_map(
        |(a, b, c, d, e, f, kind)| {
            let all = [a, b, c, d, e, f];
            let sides = match kind {
                // All sides alike, or dark.
                0 => [a; 6],
                1 => all.map(|(r, g, b)| (0.0 * r, 0.0 * g, 1e-20 * b)),
                _ => all,
            };
            let mut row = [0.0; 18];
            for (k, (r, g, b)) in sides.into_iter().enumerate() {
                row[3 * k..3 * k + 3].copy_from_slice(&[r, g, b]);
            }
            row
        },
    );
    let axes = "let v = array(vec3(i(0u), i(1u), i(2u)), vec3(i(3u), i(4u), i(5u)),
            vec3(i(6u), i(7u), i(8u)), vec3(i(9u), i(10u), i(11u)),
            vec3(i(12u), i(13u), i(14u)), vec3(i(15u), i(16u), i(17u)));
         let t = two_tones(AxisLight(v[0], v[1], v[2], v[3], v[4], v[5]));";
    let import = "#import bevy_comics::cartoon::surroundings::{AxisLight, two_tones}";
    for_batches(row, |rows| {
        let shade = gpu().evaluate(
            import,
            &format!("{axes} return vec4(t.shade, length(t.direction));"),
            rows,
        );
        let light = gpu().evaluate(
            import,
            &format!("{axes} return vec4(t.shade + t.more, 0.0);"),
            rows,
        );
        for (row, (shade, light)) in rows.iter().zip(shade.into_iter().zip(light)) {
            let sides = std::array::from_fn(|k| std::array::from_fn(|c| f64::from(row[3 * k + c])));
            let (bright, dark) = surroundings::two_tones(sides);
            assert!((shade[3] - 1.0).abs() < 1e-3, "{row:?}: {shade:?}");
            // Where two sides are nearly alike, the direction is rounding, and so is the
            // difference of the tones.
            let tones = shade.into_iter().zip(dark);
            for (found, twin) in tones.chain(light.into_iter().zip(bright)) {
                assert!(
                    (f64::from(found) - twin).abs() < 1e-4 && found >= -1e-6,
                    "{row:?}: {shade:?} {light:?}, not {dark:?} {bright:?}"
                );
            }
        }
    });
}
