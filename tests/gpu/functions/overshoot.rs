//! Strokes beyond loose ends.

use super::*;

const OVERSHOOT: &str = "#import bevy_comics::lines::overshoot::{DIRECTING, end_direction}";

/// Truth: beyond points of an arc or of a straight line, evenly or unevenly far apart, a stroke
/// leaves within 5 degrees of the tangent.
#[test]
fn strokes_leave_along_the_tangent() {
    let turn = 0.0f32..std::f32::consts::TAU;
    let row = (2u32..=16, turn, -0.08f32..0.08, 0.0f32..0.4)
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
        for (row, [x, y, ..]) in rows.iter().zip(results) {
            let [count, angle, bend, _] = row.map(f64::from);
            let apart = DVec2::from_angle(angle).angle_to(DVec2::new(x.into(), y.into()));
            // A line through two points is a chord: half of the bend between them.
            let chord = if count < 3.0 {
                0.5 * bend.abs() * 1.4
            } else {
                0.0
            };
            let most = 5f64.to_radians() + chord;
            assert!(apart.abs() < most, "{row:?}: {x}, {y}");
        }
    });
}
