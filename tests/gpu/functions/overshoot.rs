//! Strokes beyond loose ends.

use bevy_comics_testkit::reference::overshoot::end_direction;

use super::*;

const OVERSHOOT: &str = "#import bevy_comics::lines::overshoot::{DIRECTING, end_direction}";

/// The angle between two directions.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    let cross = a[0] * b[1] - a[1] * b[0];
    cross.atan2(a[0] * b[0] + a[1] * b[1]).abs()
}

/// Points of arcs, straight lines included, evenly and unevenly far apart: the direction is that
/// of the reference, and within 5 degrees that of the tangent.
#[test]
fn strokes_leave_along_the_tangent() {
    let row = (
        2u32..=16,
        0.0f32..std::f32::consts::TAU,
        -0.08f32..0.08,
        0.0f32..0.4,
    )
        .prop_map(|(count, angle, bend, uneven)| [count as f32, angle, bend, uneven]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            OVERSHOOT,
            "var middles: array<vec2<f32>, DIRECTING>;
             for (var n = 0; n < i32(u(0u)); n++) {
                 let s = f32(n) + i(3u) * f32(n % 2);
                 let a = i(1u) + 0.5 * i(2u) * s;
                 middles[n] = -s * vec2(cos(a), sin(a));
             }
             return vec4(end_direction(&middles, i32(u(0u))), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [count, angle, bend, uneven] = row.map(f64::from);
            let middle = |n: usize| {
                let s = n as f64 + uneven * (n % 2) as f64;
                let a = angle + 0.5 * bend * s;
                [-s * a.cos(), -s * a.sin()]
            };
            let middles: Vec<[f64; 2]> = (0..count as usize).map(middle).collect();
            let found = [found[0], found[1]].map(f64::from);
            let want = end_direction(&middles);
            assert!(apart(found, want) < 0.01, "{row:?}: {found:?}, {want:?}");
            // A line through two points is a chord: half of the bend between them.
            let chord = if count < 3.0 {
                0.5 * bend.abs() * 1.4
            } else {
                0.0
            };
            let tangent = [angle.cos(), angle.sin()];
            assert!(
                apart(found, tangent) < 5f64.to_radians() + chord,
                "{row:?}: {found:?}"
            );
        }
    });
}
