//! Tonal art maps on the planes of coordinates.

use super::*;
use crate::prelude::*;

/// Truth: the planes of a surface have its tone together, as far as they are independent, and the
/// planes that it faces away from have none of it.
#[test]
fn tones_of_planes_multiply_to_the_tone() {
    let row = (0.0f32..=0.99, vec(-1.0f32..=1.0, 3)).prop_filter_map("a direction", |(tone, n)| {
        let normal = Vec3::new(n[0], n[1], n[2]);
        let n = normal.try_normalize().filter(|_| normal.length() > 0.1)?;
        Some([tone, n.x, n.y, n.z])
    });
    let import = "#import bevy_comics::toon::art_map::{plane_tone, plane_weights}";
    let body = "let w = plane_weights(vec3(i(1u), i(2u), i(3u)));
         let t = i(0u);
         let light = vec3(plane_tone(t, w.x), plane_tone(t, w.y), plane_tone(t, w.z));
         return vec4(w, 1.0 - (1.0 - light.x) * (1.0 - light.y) * (1.0 - light.z));";
    for_batches(row, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let [tone, normal @ ..] = row;
            let [weights @ .., all] = found;
            // Three powers of numbers from 0.01 on, each right to 2e-4.
            assert!((all - tone).abs() < 2e-3, "{row:?}: {found:?}");
            for (n, weight) in normal.iter().zip(weights) {
                let is_away = n * n < 0.2 - 1e-6;
                assert!(
                    weight >= 0.0 && !(is_away && weight > 0.0),
                    "{row:?}: {found:?}"
                );
            }
        }
    });
}
