//! The slope of the shadow in cube maps. That of flat shadow maps is checked in
//! `toon/light_shadow.rs`.

use bevy_comics_testkit::reference::shadow_texels::{SAMPLES, nearest_plane};

use super::*;
use crate::prelude::*;

const SUMS: &str =
    "#import bevy_comics::toon::shadow_texels::{Filtered, slope_of_sums, with_sample}";

/// The slope of eight samples is that of the nearest plane.
#[test]
fn slopes_of_eight_samples_match_the_reference() {
    let places: Vec<String> = (SAMPLES.iter().enumerate())
        .map(|(k, (at, weight))| {
            format!(
                "f = with_sample(f, vec2({:?}, {:?}), {weight:?}, i({k}u));",
                at.x, at.y
            )
        })
        .collect();
    let body = format!(
        "var f: Filtered; {} return vec4(f.shadow, slope_of_sums(f), 0.0);",
        places.join("\n")
    );
    let any = vec(0.0f32..=1.0, 8).prop_map(|v| <[f32; 8]>::try_from(v).expect("eight"));
    let plane = (0.0f32..=1.0, -1.0f32..=1.0, -1.0f32..=1.0)
        .prop_map(|(a, x, y)| SAMPLES.map(|(at, _)| a + x * at.x as f32 + y * at.y as f32));
    for_batches(prop_oneof![any, plane], |rows| {
        let results = gpu().evaluate(SUMS, &body, rows);
        for (row, found) in rows.iter().zip(results) {
            let sum: f64 = SAMPLES
                .iter()
                .zip(row)
                .map(|((_, w), s)| w * f64::from(*s))
                .sum();
            let slope = nearest_plane(row.map(f64::from));
            let away = slope.distance(DVec2::new(found[1].into(), found[2].into()));
            assert!(away < 1e-4, "{row:?}: {found:?}, {slope}");
            assert!((f64::from(found[0]) - sum).abs() < 1e-6);
        }
    });
}
