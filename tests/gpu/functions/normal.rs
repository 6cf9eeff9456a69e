//! Decoding of the normal prepass, against its reference and against the encoding.

use super::*;
use bevy_comics_testkit::reference::normal;

const NORMAL: &str = "#import bevy_comics::depth::normal::decode_normal";

/// Texels with ten bits per component, of unit normals and of arbitrary vectors.
#[test]
fn a_texel_is_its_normal_or_none() {
    let ten_bits = |c: f32| ((c * 0.5 + 0.5) * 1023.0).round() / 1023.0;
    let row = (vec(-1.0f32..1.0, 3), any::<bool>()).prop_map(move |(v, unit)| {
        let length = v.iter().map(|c| c * c).sum::<f32>().sqrt().max(1e-3);
        let scale = if unit { 1.0 / length } else { 1.0 };
        [0, 1, 2].map(|i| ten_bits((v[i] * scale).clamp(-1.0, 1.0)))
    });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            NORMAL,
            "return decode_normal(vec3(i(0u), i(1u), i(2u)));",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let wide = row.map(f64::from);
            let want = normal::decode(wide);
            let squared: f64 = wide.iter().map(|c| (2.0 * c - 1.0).powi(2)).sum();
            // At a limit, either answer is right within rounding.
            let close = [0.05, 1.5]
                .iter()
                .any(|limit| (squared - limit).abs() < 1e-5);
            assert!(
                close || (result[3] > 0.0) == want.is_some(),
                "{row:?}: {result:?}"
            );
            for (i, n) in want.into_iter().flatten().enumerate() {
                assert!(
                    (f64::from(result[i]) - n).abs() <= 2f64.powi(-21),
                    "{row:?}"
                );
            }
        }
    });
}

/// Property: between two vertices, the prepass stores normals that are shorter than 1.
/// The angles between them are those of the directions, up to 120 degrees apart.
#[test]
fn interpolated_normals_keep_their_angles() {
    for degrees in [20.0f64, 45.0, 90.0, 120.0] {
        let half = 0.5 * degrees.to_radians();
        let stored = |t: f64| {
            let n = [(2.0 * t - 1.0) * half.sin(), half.cos(), 0.0];
            let texel = n.map(|c| ((c * 0.5 + 0.5) * 1023.0).round() / 1023.0);
            texel.map(|c| c as f32)
        };
        let at: Vec<f64> = (0..=20).map(|i| f64::from(i) / 20.0).collect();
        let results = gpu().evaluate(
            NORMAL,
            "return decode_normal(vec3(i(0u), i(1u), i(2u)));",
            &at.iter().map(|t| stored(*t)).collect::<Vec<_>>(),
        );
        // Half a code step (1/1023) in two components, over the shortest length.
        let error = 2f64.sqrt() / 1023.0 / half.cos();
        let angle = |t: f64| ((2.0 * t - 1.0) * half.tan()).atan();
        for (t, pair) in at.windows(2).zip(results.windows(2)) {
            let [a, b] = [pair[0], pair[1]].map(|n| n.map(f64::from));
            assert_eq!([a[3], b[3]], [1.0, 1.0], "{degrees} degrees, {t:?}");
            let chord = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
            let folded = 2.0 * (0.5 * chord).asin();
            let want = angle(t[1]) - angle(t[0]);
            assert!(
                (folded - want).abs() < 2.0 * error,
                "{degrees} degrees, {t:?}"
            );
        }
    }
}
