//! The contour operators against their references.

use super::*;

/// The operators by their number in the shader.
const OPERATORS: [ContourOperator; 4] = [
    ContourOperator::Prewitt,
    ContourOperator::Sobel,
    ContourOperator::Laplace,
    ContourOperator::Roberts,
];

#[test]
fn every_operator_answers_as_its_reference() {
    let depth = || prop_oneof![5 => 0.0f32..=1.0, 1 => select(vec![-1.0f32, 0.0, 1.0, 0.5])];
    let row = (
        (0.01f32..0.9, 0.001f32..0.99),
        0u8..4,
        any::<bool>(),
        0u8..16,
        (depth(), depth(), depth(), depth(), depth()),
        (depth(), depth(), depth(), depth()),
        any::<bool>(),
    )
        .prop_map(
            |((near, ratio), operator, faithful, missing, (a, b, c, d, e), (g, h, k, l), plane)| {
                let far = near * ratio;
                // `t` is a fraction of the range, or negative for the sky.
                let mut at = |t: f32| {
                    if t < 0.0 {
                        0.0
                    } else {
                        (far + (near - far) * t).clamp(far, near)
                    }
                };
                let mut w = [a, b, c, d, e, g, h, k, l].map(&mut at);
                if plane {
                    let middle = far + 0.5 * (near - far);
                    let (sx, sy) = (
                        (near - far) * 0.2 * (a - 0.5),
                        (near - far) * 0.2 * (b - 0.5),
                    );
                    w = std::array::from_fn(|n| {
                        middle + sx * ((n % 3) as f32 - 1.0) + sy * ((n / 3) as f32 - 1.0)
                    });
                }
                let mut row = [0.0f32; 14];
                row[..2].copy_from_slice(&[near, far]);
                row[2] = f32::from(operator);
                row[3] = f32::from(u8::from(faithful));
                row[4] = f32::from(missing);
                row[5..14].copy_from_slice(&w);
                row
            },
        );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::depth::map::{DepthFrame}
             #import bevy_comics::depth::window::{Window}
             #import bevy_comics::effects::contours::{Contours, contour_response}",
            "let f = DepthFrame(i(0u), i(1u), 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
             var s: Contours; s.operator_kind = u(2u); s.faithful = u(3u);
             let w = Window(i(5u), i(6u), i(7u), i(8u), i(9u), i(10u), i(11u), i(12u), i(13u), u(4u));
             return vec4(contour_response(s, f, w));",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = Contours {
                operator: OPERATORS[row[2] as usize],
                equations: if row[3] == 1.0 {
                    Equations::Faithful
                } else {
                    Equations::Corrected
                },
                ..Contours::default()
            };
            let ends = [f64::from(row[0]), f64::from(row[1])];
            let frame = Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: Some(ends),
                logarithmic: false,
                floor: 1.0 / 16384.0,
                sky_gap: 0.05,
            };
            let bits = row[4] as u32;
            let win = window::Window {
                depths: std::array::from_fn(|r| {
                    std::array::from_fn(|c| f64::from(row[5 + 3 * r + c]))
                }),
                missing: [bits & 1 != 0, bits & 2 != 0, bits & 4 != 0, bits & 8 != 0],
            };
            let want = contours::response(&s, &frame, &win);
            // Rounding the depth of the continued plane by an ulp of `near` moves D by
            // at most 2^-23 near / (near - far) * near / far. Twice that, for a sum of
            // weights of at most twelve.
            let [near, far] = ends;
            let tolerance = 12.0 * 2f64.powi(-22) * near / (near - far) * (near / far).max(1.0)
                + 12.0 * 2f64.powi(-22);
            assert!(
                (f64::from(result[0]) - want).abs() <= tolerance,
                "{row:?}: {} for {want} +- {tolerance}",
                result[0]
            );
        }
    });
}

#[test]
fn no_plane_has_a_contour_at_any_angle() {
    // Raw depth of planes, affine in the pixel, from face-on to grazing, in a range of
    // 1 : 1000. The response of the corrected equations is rounding alone.
    let rows: Vec<[f32; 10]> = (0..2000)
        .map(|k| {
            let (sx, sy) = (
                ((k % 40) as f32 - 20.0) * 1e-5,
                ((k / 40) as f32 - 25.0) * 1e-5,
            );
            let mut row = [0.0; 10];
            row[0] = (k % 4) as f32;
            for n in 0..9 {
                row[1 + n] = 0.002 + sx * ((n % 3) as f32 - 1.0) + sy * ((n / 3) as f32 - 1.0);
            }
            row
        })
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::{DepthFrame}
         #import bevy_comics::depth::window::{Window}
         #import bevy_comics::effects::contours::{Contours, contour_response}",
        "let f = DepthFrame(1.0, 0.001, 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
         var s: Contours; s.operator_kind = u(0u);
         let w = Window(i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), i(7u), i(8u), i(9u), 0u);
         return vec4(contour_response(s, f, w));",
        &rows,
    );
    let worst = results.iter().map(|r| r[0]).fold(0.0, f32::max);
    assert!(worst < 1e-4, "a plane answers {worst}");
}

/// Taps at uneven distances: what a smaller depth texture gives.
#[test]
fn uneven_taps_answer_as_the_reference_and_find_no_contour_in_a_plane() {
    let row = (
        (0.2f32..0.8, -0.02f32..0.02, -0.02f32..0.02),
        (0u8..4, 0u8..4, 0u8..4, 0u8..4),
        0u8..4,
        (0.0f32..0.3, 0usize..9, any::<bool>()),
    )
        .prop_map(|((c, sx, sy), (w, n, e, s), operator, (step, tap, flat))| {
            let at = [w, n, e, s].map(f32::from);
            let (xs, ys) = ([-at[0], 0.0, at[2]], [-at[1], 0.0, at[3]]);
            let mut row = [0.0f32; 17];
            row[..7].copy_from_slice(&[at[0], at[1], at[2], at[3], sx, sy, f32::from(operator)]);
            for k in 0..9 {
                row[7 + k] = c + sx * xs[k % 3] + sy * ys[k / 3];
            }
            // Another surface at one tap, unless it is the centre.
            if tap != 4 && !flat {
                row[7 + tap] = (row[7 + tap] - step).max(0.1);
            }
            row[16] = f32::from(u8::from(flat || tap == 4));
            row
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::depth::map::{DepthFrame}
             #import bevy_comics::depth::window::{Window}
             #import bevy_comics::effects::contours::{scaled_response, uneven_plane_steps}",
            "let f = DepthFrame(0.9, 0.1, 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
             let w = Window(i(7u), i(8u), i(9u), i(10u), i(11u), i(12u), i(13u), i(14u), i(15u), 0u);
             let at = vec4(i(0u), i(1u), i(2u), i(3u));
             let steps = uneven_plane_steps(f, 0.05, w, at, vec2(i(4u), i(5u)));
             return vec4(scaled_response(u(6u), steps));",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = Contours {
                operator: OPERATORS[row[6] as usize],
                ..Contours::default()
            };
            let frame = Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: Some([0.9f32, 0.1].map(f64::from)),
                logarithmic: false,
                floor: 1.0 / 16384.0,
                sky_gap: 0.05,
            };
            let row = row.map(f64::from);
            let win = window::Window {
                depths: std::array::from_fn(|r| std::array::from_fn(|c| row[7 + 3 * r + c])),
                missing: [false; 4],
            };
            let (at, slope) = ([row[0], row[1], row[2], row[3]], [row[4], row[5]]);
            let want = contours::uneven_response(&s, (&frame, &win), at, slope);
            // D changes by 0.9 * 0.1 / (0.8 d^2) = 11 per unit of depth at most, at 0.1; a
            // plane at 0.8 is rounded by 2^-23 in each of three operations; eight taps.
            let tolerance = 12.0 * 8.0 * 3.0 * 2f64.powi(-23);
            let got = f64::from(result[0]);
            assert!((got - want).abs() <= tolerance, "{row:?}: {got} for {want}");
            if row[16] == 1.0 {
                assert!(got <= tolerance, "a plane: {got}");
            }
        }
    });
}
