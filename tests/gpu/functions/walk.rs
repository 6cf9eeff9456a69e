//! The walk looks for tiles with cracks by bounds: no crack may be below them.

use bevy_comics_testkit::reference::walk::{BELOW, may_be_crease, may_be_silhouette};

use super::*;

/// [edge limit, softness, k, reference, excess or fold relative to its bound]
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

/// Every step and every fold whose ink is not 0 after rounding is within the bound, and
/// the bound is its twin.
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
             let excess = i(4u) * 2.0 * i(2u) * sqrt(i(0u)) * i(3u);
             let step = smoothstep(i(0u), i(1u), step_response(vec4(excess), vec4(i(2u) * i(3u))).x);
             let folds = i(4u) * 4.0 * s.crease_k * s.crease_k * i(0u);
             let bend = smoothstep(i(0u), i(1u), fold_response(vec4(folds), s.crease_k).x);
             let ink = byte(vec4(step, bend, 0.0, 0.0));
             return vec4(
                 f32(ink.x), f32(may_be_silhouette(s, vec4(excess), vec4(0.5)).x),
                 f32(ink.y), f32(may_be_crease(s, vec4(folds)).x),
             );",
            rows,
        );
        for (row, [step, silhouette, bend, crease]) in rows.iter().zip(results) {
            assert!(step == 0.0 || silhouette == 1.0, "a step: {row:?}");
            assert!(bend == 0.0 || crease == 1.0, "a fold: {row:?}");
            let [low, _, k, reference, ratio] = row.map(f64::from);
            // A few units in the last place around the bound are undecided.
            if (ratio - BELOW).abs() < 1e-5 {
                continue;
            }
            let excess = ratio * 2.0 * k * low.sqrt() * reference;
            let want = may_be_silhouette([low, k], excess, reference, 0.5);
            assert_eq!(silhouette == 1.0, want, "a step: {row:?}");
            let k = k.max(f64::from(0.02f32));
            let want = may_be_crease([low, k], ratio * 4.0 * k * k * low);
            assert_eq!(crease == 1.0, want, "a fold: {row:?}");
        }
    });
}

/// Without geometry there is no silhouette, whatever the bound.
#[test]
fn the_walk_finds_nothing_in_the_sky() {
    assert!(!may_be_silhouette([0.25, 0.01], 1.0, 0.0, 0.0));
}
