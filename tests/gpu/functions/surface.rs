//! Lines in the color of surfaces.

use bevy_comics_testkit::reference::surface::surface_ink;

use super::*;

#[test]
fn surface_ink_matches_the_reference() {
    let part = || 0.0f32..=1.0;
    let row = (part(), part(), part(), part(), 0.0f32..=2.0)
        .prop_map(|(r, g, b, darken, saturate)| [r, g, b, darken, saturate]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::surface::surface_ink",
            "return vec4(surface_ink(vec3(i(0u), i(1u), i(2u)), i(3u), i(4u)), 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = surface_ink(rgb(row), row[3].into(), row[4].into());
            for (found, want) in found.into_iter().zip(want) {
                let off = (f64::from(found) - want).abs();
                assert!(off < 1e-5, "{row:?}: {found}, {want}");
            }
        }
    });
}
