//! Whether the depth prepass shows a fragment, up to a tolerance.

use bevy_comics_testkit::reference::tolerance::{is_near, tolerance};

use super::*;
use crate::prelude::*;

const NEAR: &str = "#import bevy_comics::objects::tolerance::is_near";

/// Views with one sample and with several.
const VIEWS: [(bool, &[Definition]); 2] =
    [(false, &[]), (true, &[("TOLERANT_MULTISAMPLED", None)])];

/// Whether each row (drawn depth, found depth, slope) is near on the GPU.
fn found(definitions: &[Definition], rows: &[[f32; 3]]) -> Vec<bool> {
    let body = "return vec4(f32(is_near(i(0u), i(1u), i(2u))));";
    let results = gpu().evaluate_alone(definitions, NEAR, body, rows);
    results.iter().map(|result| result[0] == 1.0).collect()
}

/// Found depth, slope, and how far the drawn depth lies from there, in tolerances.
fn row() -> impl Strategy<Value = [f32; 3]> {
    let depth = prop_oneof![
        3 => 0.0f32..=1.0,
        3 => (-30i32..0, 1.0f32..2.0).prop_map(|(e, part)| part * 2f32.powi(e)),
        1 => select(vec![0.0, -0.0, 1.0, 1e-30]),
    ];
    let slope = prop_oneof![
        2 => (-9i32..1, 1.0f32..10.0).prop_map(|(e, part)| part * 10f32.powi(e)),
        1 => select(vec![0.0, 1.0, 1e30]),
    ];
    let away = prop_oneof![
        3 => 0.999f32..1.001,
        2 => 0.0f32..3.0,
        1 => select(vec![0.0, 1.0]),
    ];
    (depth, slope, away, any::<bool>())
        .prop_map(|(found, slope, away, behind)| [found, slope, if behind { -away } else { away }])
}

/// On both sides of the tolerance, in front of and behind what the prepass has.
#[test]
fn near_depths_match_the_reference() {
    for (multisampled, definitions) in VIEWS {
        for_batches(row(), |batch| {
            let drawn = |[depth, slope, away]: [f32; 3]| {
                let tolerance = tolerance(depth.into(), slope.into(), multisampled);
                (f64::from(depth) + f64::from(away) * tolerance) as f32
            };
            let rows: Vec<[f32; 3]> = batch
                .iter()
                .map(|row| [drawn(*row), row[0], row[1]])
                .collect();
            let mut decided = 0;
            for (row, near) in rows.iter().zip(found(definitions, &rows)) {
                let [drawn, depth, slope] = row.map(f64::from);
                let limit = tolerance(drawn.max(depth), slope, multisampled);
                // The difference, the products and the sums: four roundings of 2^-24.
                if ((drawn - depth).abs() - limit).abs() <= 4.0 * 2f64.powi(-24) * limit {
                    continue;
                }
                let reference = is_near(drawn, depth, slope, multisampled);
                assert_eq!(near, reference, "{row:?}, multisampled: {multisampled}");
                decided += 1;
            }
            assert!(decided > rows.len() / 2, "{decided}");
        });
    }
}

/// Depths that are exact in single precision: the tolerance itself is near, and the next depth is
/// not. Nothing is near where the prepass has nothing. Infinite depths and NaN are left out: WGSL
/// lets devices assume that there are none.
#[test]
fn the_tolerance_itself_is_near() {
    let flat = 2f32.powi(-13) + 2f32.powi(-22);
    let steep = 2f32.powi(-8);
    let next = 2f32.powi(-25);
    for (multisampled, definitions) in VIEWS {
        let pixels = if multisampled { 0.75 } else { 0.0625 };
        let sloped = flat + pixels * steep;
        let cases = [
            ([0.5, 0.5, 0.0], true),
            ([0.5 - flat, 0.5, 0.0], true),
            ([0.5 - flat - next, 0.5, 0.0], false),
            ([0.5, 0.5 - flat, 0.0], true),
            ([0.5, 0.5 - flat - next, 0.0], false),
            ([0.5 - sloped, 0.5, steep], true),
            ([0.5 - sloped - next, 0.5, steep], false),
            ([0.5, 0.5 - sloped, steep], true),
            ([0.5, 0.5 - sloped - next, steep], false),
            // Infinitely far away, in an orthographic view just in front of the far plane.
            ([0.0, 2f32.powi(-22), 0.0], true),
            ([0.0, 2f32.powi(-21), 0.0], false),
            ([0.0, 0.0, 0.0], false),
            ([1e-9, 0.0, 0.0], false),
            ([0.0, -0.0, 0.0], false),
            ([0.0, -1e-8, 0.0], false),
            ([0.5, 0.0, 1e30], false),
            ([0.5, -0.5, 1e30], false),
            ([0.0, 0.5, 1e30], true),
        ];
        let rows = cases.map(|(row, _)| row);
        for ((row, near), on_gpu) in cases.into_iter().zip(found(definitions, &rows)) {
            assert_eq!(on_gpu, near, "{row:?}, multisampled: {multisampled}");
            let [drawn, depth, slope] = row.map(f64::from);
            assert_eq!(is_near(drawn, depth, slope, multisampled), near, "{row:?}");
        }
    }
}
