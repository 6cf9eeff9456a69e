//! Ribbons along the paths of moving things.

use super::{toon::Numbers, *};

/// Truth: what a line covers of the pixels across it adds up to its width, however thin it is.
#[test]
fn ribbons_cover_their_width() {
    let import = "#import bevy_comics::motion_lines::ribbon::coverage";
    let body = "var sum = 0.0;
         for (var k = -16; k <= 16; k++) { sum += coverage(f32(k) + i(0u), i(1u)); }
         return vec4(sum);";
    for_batches(
        (-0.5f32..=0.5, 0.0f32..8.0).prop_map(|(off, half)| [off, half]),
        |rows| {
            for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
                // Seventeen pixels, whose distances are rounded to a millionth.
                assert!(
                    (found[0] - 2.0 * row[1]).abs() < 3e-5,
                    "{row:?}: {}",
                    found[0]
                );
            }
        },
    );
}

/// A path that has no direction on the screen, or that crosses the plane of the eye, is no NaN.
#[test]
fn ribbons_without_a_direction_are_finite() {
    let import = "#import bevy_comics::motion_lines::ribbon::{direction_on_screen, moved_across}
        fn clip(n: u32) -> vec4<f32> { return vec4(i(n), i(n + 1u), i(n + 2u), i(n + 3u)); }";
    let body = "let size = vec2(640.0, 360.0);
         let along = direction_on_screen(clip(0u), clip(4u), size);
         return vec4(moved_across(clip(0u), along, 3.0, size).xy, along);";
    let mut n = Numbers::new(76);
    let mut rows: Vec<[f32; 8]> = (0..256)
        .map(|_| {
            let w = 10f32.powf(n.within(-2.0, 3.0));
            let [x, y] = [0; 2].map(|_| w * n.within(-1.2, 1.2));
            [x, y, 0.1 * w, w, x, y, 0.1 * w, w]
        })
        .collect();
    for (k, row) in rows.iter_mut().enumerate() {
        // The same place twice, or a place in the plane of the eye.
        if k % 2 == 0 {
            row[7] = 0.0;
        }
    }
    for (row, found) in rows.iter().zip(gpu().evaluate(import, body, &rows)) {
        let [x, y, along @ ..] = found;
        let length = along[0].hypot(along[1]);
        assert!(x.is_finite() && y.is_finite(), "{row:?}: {found:?}");
        assert!((length - 1.0).abs() < 1e-4, "{row:?}: {found:?}");
    }
}
