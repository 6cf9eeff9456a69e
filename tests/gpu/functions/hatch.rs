//! Strokes of the toon material: tones of light, surfaces at rest, drawings.

use bevy_comics_testkit::reference::hatch::{hatch_tone, rest_normal};

use super::*;
use crate::prelude::*;

const HATCH: &str = "#import bevy_comics::toon::hatch::{Hatch, hatch_drawing, hatch_tone, light_share, rest_surface}";

#[test]
fn tones_of_light_match_the_reference() {
    let row = (
        0.0f32..=1.2,
        prop_oneof![9 => 0.1f32..=1.0, 1 => select(vec![0.0])],
        0.0f32..=0.9,
        0.05f32..=1.0,
        0.25f32..=4.0,
        0.0f32..=1.0,
    )
        .prop_map(|(part, all, low, high, gamma, near)| {
            [part * all, all, low, high.max(low + 0.05), gamma, near]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HATCH,
            "var h: Hatch;
             h.strokes.shadows = i(2u); h.strokes.highlights = i(3u); h.strokes.gamma = i(4u);
             h.factor = i(5u);
             return vec4(hatch_tone(h, light_share(i(0u), i(1u))), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let s = Hatching {
                shadows: row[2],
                highlights: row[3],
                gamma: row[4],
                at_near: row[5],
                ..Hatching::default()
            };
            let [arriving, all] = [0, 1].map(|k| f64::from(row[k]));
            let want = hatch_tone(&s, arriving, all);
            let away = (f64::from(found[0]) - want).abs();
            // As for the effect: powers of numbers near 0.
            assert!(away < 2e-3, "{row:?}: {found:?}, {want}");
        }
    });
}

#[test]
fn surfaces_at_rest_have_the_normal_of_the_reference() {
    let row = (vec(-1.0f32..=1.0, 9), 0u8..3, -12i32..12).prop_filter_map(
        "two directions",
        |(values, kind, exponent)| {
            let mut row = [0.0; 9];
            for (k, (slot, value)) in row.iter_mut().zip(values).enumerate() {
                let scale = if k < 6 { 2f32.powi(exponent) } else { 5.0 };
                *slot = if k >= 6 && kind == 0 {
                    0.0
                } else {
                    value * scale
                };
            }
            let [across, down] = [0, 3].map(|k| three(&row, k).normalize());
            (across.cross(down).length() > 0.1).then_some(row)
        },
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HATCH,
            "let on = rest_surface(vec3(1.0, 2.0, 3.0), vec3(i(0u), i(1u), i(2u)),
                 vec3(i(3u), i(4u), i(5u)), vec3(i(6u), i(7u), i(8u)));
             return vec4(on.normal, on.place.y + on.eye.x);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = rest_normal(three(row, 0), three(row, 3), three(row, 6));
            let got = DVec3::new(found[0].into(), found[1].into(), found[2].into());
            assert!(got.distance(want) < 1e-4, "{row:?}: {got}, {want}");
            assert_eq!(found[3], 2.0);
        }
    });
}

fn three(row: &[f32; 9], k: usize) -> DVec3 {
    DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into())
}

/// What has no extent has a normal, too; drawings are counted from 0 on.
#[test]
fn degenerate_surfaces_have_a_normal() {
    let rows = [[0.0f32], [1e-30], [1e-38], [1e30]];
    let results = gpu().evaluate(
        HATCH,
        "let on = rest_surface(vec3(0.0), vec3(i(0u), 0.0, 0.0), vec3(i(0u), 0.0, 0.0), vec3(0.0));
         return vec4(on.normal, 0.0);",
        &rows,
    );
    for (row, [x, y, z, _]) in rows.iter().zip(results) {
        let long = f64::from(x).hypot(y.into()).hypot(z.into());
        assert!((long - 1.0).abs() < 1e-5, "{row:?}: {long}");
    }
    let rows = [
        [0.0f32, 8.0, 0.0],
        [0.99, 8.0, 7.0],
        [1.0, 8.0, 8.0],
        [5.0, 0.0, 0.0],
    ];
    let results = gpu().evaluate(
        HATCH,
        "var h: Hatch;
         h.rate = i(1u);
         return vec4(f32(hatch_drawing(h, i(0u))));",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        assert_eq!(found[0], row[2], "{row:?}");
    }
}
