//! How wide a line is at a crack: each factor.

use bevy_comics_testkit::reference::map::Projection;
use bevy_comics_testkit::reference::weight::{
    kind_weight, light_weight, nib_weight, perspective_weight, taper_weight,
};

use super::*;
use crate::prelude::*;

const WEIGHT: &str = "#import bevy_comics::lines::weight::{
        Weight, kind_weight, light_weight, nib_weight, perspective_weight, taper_weight,
    }
    #import bevy_comics::depth::map::DepthFrame";

fn assert_close(found: f32, want: f64, row: &[f32]) {
    let apart = (f64::from(found) - want).abs();
    assert!(apart < 1e-5 * want.max(1.0), "{row:?}: {found}, {want}");
}

/// Every combination of kinds: a silhouette goes before an object edge, that before a crease.
#[test]
fn the_kind_of_a_line_has_its_factor() {
    let w = LineWeight {
        outer: 1.5,
        inner: 0.75,
        crease: 0.6,
        object: 0.8,
        ..LineWeight::EVEN
    };
    let rows: Vec<[f32; 2]> = (1..8)
        .flat_map(|kinds| [0.0, 1.0].map(|outer| [kinds as f32, outer]))
        .collect();
    let results = gpu().evaluate(
        WEIGHT,
        "var w: Weight;
         w.outer = 1.5; w.inner = 0.75; w.crease = 0.6; w.object = 0.8;
         return vec4(kind_weight(w, u(0u), u(1u) == 1u));",
        &rows,
    );
    for (row, found) in rows.iter().zip(results) {
        let kinds = [1, 2, 4].map(|bit| row[0] as u32 & bit != 0);
        let want = kind_weight(&w, kinds, row[1] == 1.0);
        assert_close(found[0], want, row);
        let truth = match (kinds, row[1] == 1.0) {
            ([true, ..], true) => 1.5,
            ([true, ..], false) => 0.75,
            ([false, _, true], _) => 0.8,
            _ => 0.6,
        };
        assert_close(found[0], truth, row);
    }
}

/// Lines in the shade gain, lines in the light lose, each up to what was asked.
#[test]
fn lines_are_wider_in_the_shade() {
    let row =
        (-1.0f32..=1.0, 0.0f32..=2.0, 0.0f32..=1.0).prop_map(|(n, shade, lit)| [n, shade, lit]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            WEIGHT,
            "var w: Weight;
             w.shade = i(1u); w.lit = i(2u);
             return vec4(light_weight(w, i(0u)), light_weight(w, -i(0u)), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let w = LineWeight {
                shade: row[1],
                lit: row[2],
                ..LineWeight::EVEN
            };
            assert_close(found[0], light_weight(&w, f64::from(row[0])), row);
            let [in_light, in_shade] = if row[0] > 0.0 { [0, 1] } else { [1, 0] };
            assert!(
                found[in_light] <= found[in_shade] + 1e-6,
                "{row:?}: {found:?}"
            );
            assert!(found[in_light] >= 1.0 - row[2] - 1e-6, "{row:?}: {found:?}");
            assert!(found[in_shade] <= 1.0 + row[1] + 1e-6, "{row:?}: {found:?}");
        }
    });
}

/// At full perspective a line is as wide as if drawn on the surface: twice the distance, half
/// the width, up to the bounds. The sky, an empty view and an orthographic view have 1.
#[test]
fn perspective_follows_distance() {
    let row =
        (0.01f32..1.0, 1.5f32..50.0, 0.0f32..=1.0, 0.0f32..=1.0).prop_map(|(near, ratio, t, q)| {
            [
                near,
                near / ratio,
                near / ratio + t * (near - near / ratio),
                q,
            ]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            WEIGHT,
            "var w: Weight;
             w.perspective = i(3u);
             var f: DepthFrame;
             f.near = i(0u); f.far = i(1u);
             let found = perspective_weight(w, f, i(2u));
             let half = perspective_weight(w, f, 0.5 * i(2u));
             f.flags = 1u;
             return vec4(found, half, perspective_weight(w, f, i(2u)), perspective_weight(w, f, 0.0));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [near, far, d, q] = row.map(f64::from);
            let w = LineWeight {
                perspective: row[3],
                ..LineWeight::EVEN
            };
            let frame = Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: Some([near, far]),
                logarithmic: false,
                floor: 0.0,
                sky_gap: 0.0,
            };
            assert_close(found[0], perspective_weight(&w, &frame, d), row);
            let middle = 0.5 * (1.0 / near + 1.0 / far);
            if (0.26..1.9).contains(&(middle * d)) {
                let ratio = f64::from(found[1]) / f64::from(found[0]);
                assert!((ratio - 0.5f64.powf(q)).abs() < 1e-4, "{row:?}: {ratio}");
            }
            assert!(found[0] <= 2.0 && found[1] >= 0.124, "{row:?}: {found:?}");
            assert_eq!(found[2..], [1.0, 1.0], "{row:?}");
        }
    });
}

/// A stroke along the edge of the nib has the width of the nib's side, one across it the full
/// width, whatever their direction.
#[test]
fn a_nib_is_thin_along_its_edge() {
    let row =
        (0.0f32..180.0, 0.0f32..360.0, 0.1f32..=1.0).prop_map(|(nib, line, r)| [nib, line, r]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            WEIGHT,
            "var w: Weight;
             w.nib = i(2u);
             let a = radians(i(0u));
             w.nib_edge = vec2(cos(a), -sin(a));
             let t = radians(i(1u));
             return vec4(
                 nib_weight(w, vec2(cos(t), -sin(t))), nib_weight(w, -vec2(cos(t), -sin(t))),
                 nib_weight(w, w.nib_edge), nib_weight(w, w.nib_edge.yx * vec2(1.0, -1.0)),
             );",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let w = LineWeight {
                nib_angle: row[0],
                nib_roundness: row[2],
                ..LineWeight::EVEN
            };
            let line = f64::from(row[1]).to_radians();
            let want = nib_weight(&w, [line.cos(), -line.sin()]);
            // Near the edge's direction the sine is small, and so is its precision.
            assert!(
                (f64::from(found[0]) - want).abs() < 2e-3,
                "{row:?}: {found:?}"
            );
            assert!((found[0] - found[1]).abs() < 1e-6, "{row:?}: {found:?}");
            assert!((found[2] - row[2]).abs() < 1e-5, "{row:?}: {found:?}");
            assert!((found[3] - 1.0).abs() < 1e-4, "{row:?}: {found:?}");
        }
    });
}

/// Widths grow from the loose end, and are whole from the taper's length on.
#[test]
fn a_tapered_line_is_whole_behind_its_length() {
    let rows: Vec<[f32; 2]> = [1.0f32, 7.5, 12.0, 48.0, 64.0]
        .into_iter()
        .flat_map(|taper| (0..70).map(move |cracks| [taper, cracks as f32]))
        .collect();
    let results = gpu().evaluate(
        WEIGHT,
        "var w: Weight;
         w.taper = i(0u);
         return vec4(taper_weight(w, i(1u)));",
        &rows,
    );
    let mut before = 0.0;
    for (row, found) in rows.iter().zip(results) {
        let [taper, cracks] = *row;
        assert_close(
            found[0],
            taper_weight(f64::from(taper), f64::from(cracks)),
            row,
        );
        if cracks == 0.0 {
            before = 0.0;
        }
        assert!(found[0] >= before, "{row:?}");
        assert!(
            found[0] == 1.0 || cracks + 0.5 < taper,
            "{row:?}: {found:?}"
        );
        before = found[0];
    }
}
