//! Light of rectangles against its reference.

use bevy_comics_testkit::{device::gpu, reference::rect};

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
        "#import bevy_comics::toon::rect::{Rect, rect_light}",
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
        "#import bevy_comics::toon::rect::{Rect, mirrored, rect_light}",
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
