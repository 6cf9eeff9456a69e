//! The filters of shadow maps and their slopes.

use bevy_comics_testkit::reference::shadow_texels::{SAMPLES, filtered, nearest_plane, slope};

use super::*;
use crate::prelude::*;

/// Shadow maps in which a half plane, a stripe or scattered texels are lit.
const MAP: &str = "
    #import bevy_comics::toon::shadow_texels::{Filtered, texels_at, with_texels}
    fn texel(at: vec2<f32>) -> f32 {
        let d = dot(vec2(i(2u), i(3u)), at) + i(4u);
        let kind = u(5u);
        if kind == 0u { return select(0.0, 1.0, d > 0.0); }
        if kind == 1u { return select(0.0, 1.0, abs(d) < 1.5); }
        let n = u32(at.x) * 73u + u32(at.y) * 151u;
        return f32((n * n / 8u) % 2u);
    }
    fn filtered() -> Filtered {
        let on = texels_at(vec2(i(0u), i(1u)));
        var f: Filtered;
        for (var y = 0u; y < 3u; y++) {
            for (var x = 0u; x < 3u; x++) {
                // The order of `textureGatherCompare`.
                let low = on.corner + 2.0 * vec2(f32(x), f32(y)) - 3.0;
                let four = vec4(
                    texel(low + vec2(0.0, 1.0)), texel(low + vec2(1.0, 1.0)),
                    texel(low + vec2(1.0, 0.0)), texel(low),
                );
                f = with_texels(f, four, vec2(x, y), on.part);
            }
        }
        return f;
    }";

fn texel(row: &[f32; 6]) -> impl Fn(i64, i64) -> f64 + '_ {
    move |x, y| {
        let d = row[2] * x as f32 + row[3] * y as f32 + row[4];
        let lit = match row[5] as u32 {
            0 => d > 0.0,
            1 => d.abs() < 1.5,
            _ => {
                let n = (x as u32).wrapping_mul(73) + (y as u32).wrapping_mul(151);
                (n.wrapping_mul(n) / 8) % 2 == 1
            }
        };
        f64::from(u8::from(lit))
    }
}

/// The filter of 36 texels is that of the engine's nine samples, and its slope is its change.
#[test]
fn filtered_shadows_and_their_slopes_match_the_reference() {
    let row = (
        (4.0f32..=60.0, 4.0f32..=60.0),
        (0.0f32..6.3, -3.0f32..=3.0),
        0u32..3,
    )
        .prop_filter_map(
            "not where the texels change",
            |((x, y), (angle, c), kind)| {
                // Exact in both number formats, so that the same texels are lit.
                let round = |v: f32| (v * 256.0).round() / 256.0;
                let [x, y, nx, ny] = [x, y, angle.cos(), angle.sin()].map(round);
                let d = round(c - nx * x - ny * y);
                let far = |v: f32| ((v + 0.5).fract() - 0.5).abs() < 0.498;
                (far(x) && far(y)).then_some([x, y, nx, ny, d, kind as f32])
            },
        );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            MAP,
            "let f = filtered(); return vec4(f.shadow, f.slope, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let at = DVec2::new(row[0].into(), row[1].into());
            let shadow = filtered(texel(row), at);
            assert!(
                (f64::from(found[0]) - shadow).abs() < 1e-5,
                "{row:?}: {found:?}, {shadow}"
            );
            let slope = slope(texel(row), at);
            let away = slope.distance(DVec2::new(found[1].into(), found[2].into()));
            assert!(away < 1e-4, "{row:?}: {found:?}, {slope}");
        }
    });
}

const SUMS: &str =
    "#import bevy_comics::toon::shadow_texels::{Filtered, slope_of_sums, with_sample}";

/// The slope of eight samples is that of the nearest plane, and exact where they are in one.
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
    for_batches(prop_oneof![any, plane.clone()], |rows| {
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
    for_batches(plane, |rows| {
        for row in rows {
            let slope = nearest_plane(row.map(f64::from));
            // Two samples of the plane, 0.25 apart in x and 0.75 in y.
            let rise = f64::from(row[1] - row[0]);
            let along = slope.dot(SAMPLES[1].0 - SAMPLES[0].0);
            assert!((rise - along).abs() < 1e-5, "{row:?}: {slope}");
        }
    });
}
