//! The walk looks for tiles with cracks by bounds: no crack may be below them.

use super::*;

/// [low and high end of the ramp of the ink, k, reference, excess or fold relative to its bound]
fn row() -> impl Strategy<Value = [f32; 5]> {
    let near_the_bound = prop_oneof![
        4 => 0.99f32..1.1,
        2 => 0.9989f32..1.0001,
        1 => 0.0f32..40.0,
        1 => select(vec![-1.0, 0.0, 1.0]),
    ];
    let softness = prop_oneof![2 => 0.0f32..=1.0, 1 => select(vec![0.0, 0.001, 1.0])];
    let limit = prop_oneof![2 => 0.01f32..=0.99, 1 => select(vec![0.01, 0.5, 0.99])];
    (limit, softness, -6i32..0, -24i32..0, near_the_bound).prop_map(
        |(limit, softness, k, reference, ratio)| {
            let half = softness.max(1e-3) * limit.min(1.0 - limit);
            let k = 10f32.powi(k).max(1e-6);
            [limit - half, limit + half, k, 2f32.powi(reference), ratio]
        },
    )
}

/// Every step and every fold whose ink is not 0 after rounding is within the bound, which is a
/// thousandth lower than where ink begins. What is below the bound is left out, and so is the sky.
#[test]
fn the_walk_leaves_out_no_ink() {
    for_batches(row(), |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::edge::{
                Lines, byte, fold_response, may_be_crease, may_be_silhouette, step_response,
             }",
            "var s: Lines;
             s.silhouette_low = i(0u); s.silhouette_high = i(1u); s.silhouette_k = i(2u);
             s.crease_low = i(0u); s.crease_high = i(1u); s.crease_k = max(i(2u), 0.02);
             s.reference_constant = i(3u);
             let least = mix(i(0u), i(1u), 0.0257);
             let excess = i(4u) * 2.0 * i(2u) * sqrt(least) * i(3u);
             let step = smoothstep(i(0u), i(1u), step_response(vec4(excess), vec4(i(2u) * i(3u))).x);
             let folds = i(4u) * 4.0 * s.crease_k * s.crease_k * least;
             let bend = smoothstep(i(0u), i(1u), fold_response(vec4(folds), s.crease_k).x);
             let ink = byte(vec4(step, bend, 0.0, 0.0));
             // The second pixel is sky.
             let steps = may_be_silhouette(s, vec4(excess), vec4(0.5, 0.0, 0.5, 0.5));
             let silhouette = f32(steps.x) + 2.0 * f32(steps.y);
             return vec4(f32(ink.x), silhouette, f32(ink.y), f32(may_be_crease(s, vec4(folds)).x));",
            rows,
        );
        for (row, [step, silhouette, bend, crease]) in rows.iter().zip(results) {
            assert!(step == 0.0 || silhouette == 1.0, "a step: {row:?}");
            assert!(bend == 0.0 || crease == 1.0, "a fold: {row:?}");
            // A few units in the last place around the bound are undecided.
            if (row[4] - 0.999).abs() >= 1e-5 {
                let want = f32::from(u8::from(row[4] > 0.999));
                assert_eq!([silhouette, crease], [want; 2], "{row:?}");
            }
        }
    });
}

/// Flat surfaces at any angle, with softness 1, where ink begins at a response of 0:
/// rounding of depths is no possible line.
#[test]
fn a_plane_is_no_possible_line_of_soft_ink() {
    let slope = || prop_oneof![Just(0.0f32), -1e-3f32..1e-3, -1e-5f32..1e-5];
    let row = (1e-4f32..1.0, slope()).prop_map(|(start, slope)| [start, slope * start, 0.0]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::edge::{Lines, may_be_silhouette, step_excess}",
            "var s: Lines;
             s.silhouette_low = 0.0; s.silhouette_high = 1.0; s.silhouette_k = 0.01;
             s.reference_factor = 1.0;
             let a = vec4(i(0u)); let b = vec4(i(1u));
             let d = vec4(a + 2.0 * b);
             let excess = step_excess(a, a + b, d, a + 3.0 * b, a + 4.0 * b, a + 5.0 * b);
             return vec4(f32(may_be_silhouette(s, excess, d).x), excess.x, 0.0, 0.0);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            assert_eq!(result[0], 0.0, "{row:?}: an excess of {}", result[1]);
        }
    });
}
