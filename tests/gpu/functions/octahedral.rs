//! Vectors that are stored on a square against their reference.

use bevy_comics_testkit::{device::gpu, reference::octahedral::octahedral};
use proptest::prelude::Strategy;

use super::for_batches;

/// Directions of the square on which octahedral vectors are stored.
#[test]
fn octahedral_vectors_match_the_reference() {
    let import = "#import bevy_comics::toon::octahedral::octahedral";
    let body = "return vec4(octahedral(vec2(i(0u), i(1u))), 0.0);";
    let steps = [-1.0f32, -0.5, -0.0, 0.0, 0.25, 0.5, 0.75, 1.0];
    let edges = steps.into_iter().flat_map(|x| steps.map(|y| [x, y]));
    let check = |rows: &[[f32; 2]]| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let reference = octahedral(row.map(f64::from));
            for (found, reference) in found.into_iter().zip(reference) {
                // Sums of numbers up to 1, divided by a length of at least 3^-0.5.
                assert!(
                    (f64::from(found) - reference).abs() < 1e-6,
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    };
    check(&edges.collect::<Vec<_>>());
    for_batches(
        (-1.0f32..=1.0, -1.0f32..=1.0).prop_map(|(x, y)| [x, y]),
        |rows| check(rows),
    );
}
