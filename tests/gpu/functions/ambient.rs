//! Light of surroundings against its reference.

use bevy_comics_testkit::{device::gpu, reference::toon::ambient};
use proptest::prelude::Strategy;

use super::for_batches;

/// Both tones are the reference's, and neither is negative.
#[test]
fn two_tones_of_surroundings_match_the_reference() {
    let side = || (0.0f32..1.0, 0.0f32..1.0, 0.0f32..1.0);
    let row = (side(), side(), side(), side(), side(), side(), 0u32..4).prop_map(
        |(a, b, c, d, e, f, kind)| {
            let all = [a, b, c, d, e, f];
            let sides = match kind {
                // All sides alike, or dark.
                0 => [a; 6],
                1 => all.map(|(r, g, b)| (0.0 * r, 0.0 * g, 1e-20 * b)),
                _ => all,
            };
            let mut row = [0.0; 18];
            for (k, (r, g, b)) in sides.into_iter().enumerate() {
                row[3 * k..3 * k + 3].copy_from_slice(&[r, g, b]);
            }
            row
        },
    );
    let axes = "let v = array(vec3(i(0u), i(1u), i(2u)), vec3(i(3u), i(4u), i(5u)),
            vec3(i(6u), i(7u), i(8u)), vec3(i(9u), i(10u), i(11u)),
            vec3(i(12u), i(13u), i(14u)), vec3(i(15u), i(16u), i(17u)));
         let t = two_tones(AxisLight(v[0], v[1], v[2], v[3], v[4], v[5]));";
    let import = "#import bevy_comics::toon::ambient::{AxisLight, two_tones}";
    for_batches(row, |rows| {
        let shade = gpu().evaluate(
            import,
            &format!("{axes} return vec4(t.shade, length(t.direction));"),
            rows,
        );
        let light = gpu().evaluate(
            import,
            &format!("{axes} return vec4(t.shade + t.more, 0.0);"),
            rows,
        );
        for (row, (shade, light)) in rows.iter().zip(shade.into_iter().zip(light)) {
            let sides = std::array::from_fn(|k| std::array::from_fn(|c| f64::from(row[3 * k + c])));
            let (bright, dark) = ambient::two_tones(sides);
            assert!((shade[3] - 1.0).abs() < 1e-3, "{row:?}: {shade:?}");
            // Where two sides are nearly alike, the direction is rounding, and so is the
            // difference of the tones.
            let tones = shade.into_iter().zip(dark);
            for (found, reference) in tones.chain(light.into_iter().zip(bright)) {
                assert!(
                    (f64::from(found) - reference).abs() < 1e-4 && found >= -1e-6,
                    "{row:?}: {shade:?} {light:?}, not {dark:?} {bright:?}"
                );
            }
        }
    });
}
