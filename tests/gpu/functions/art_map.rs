//! Tonal art maps: thresholds, planes.

use bevy_comics_testkit::reference::art_map::{ink_at, plane_tone, plane_weights};

use super::*;
use crate::prelude::*;

const MAP: &str = "#import bevy_comics::toon::art_map::{ink_at, plane_tone, plane_weights}";

#[test]
fn thresholds_and_planes_match_the_reference() {
    let row = (0.0f32..=1.0, 0.0f32..=1.0, vec(-1.0f32..=1.0, 3)).prop_filter_map(
        "a direction",
        |(tone, threshold, n)| {
            let normal = Vec3::new(n[0], n[1], n[2]);
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
