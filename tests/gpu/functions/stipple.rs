//! Dots on surfaces.

use std::f64::consts::PI;

use bevy_comics_testkit::reference::{
    hatching::{Hatch, Surface},
    stipple::disc_coverage,
};

use super::{
    hatching::{VIEW, is_near, view},
    *,
};
use crate::prelude::*;

const STIPPLE: &str = "
    #import bevy_comics::effect::footprint::singular_values
    #import bevy_comics::effect::stipple::{disc_coverage, stippled}
    #import bevy_comics::effect::strokes::{Strokes, page_at}
    #import bevy_comics::effects::hatching::surface_at";

/// The change of a place over a pixel, turned and stretched: `[right, down]`.
fn change([x, y, long, short]: [f64; 4]) -> [DVec2; 2] {
    let [screen, plane] = [x, y].map(DVec2::from_angle);
    let of = |by: DVec2| {
        let by = by.rotate(screen);
        DVec2::new(by.x * long, by.y * short).rotate(plane)
    };
    [of(DVec2::X), of(DVec2::Y)]
}

#[test]
fn discs_match_the_reference() {
    let row = (
        (-3.0f32..=3.0, -3.0f32..=3.0),
        (0.0f32..=6.3, 0.0f32..=6.3, 0.05f32..=1.0, 0.02f32..=1.0),
        0.0f32..=3.0,
    )
        .prop_map(|((x, y), (a, b, long, part), radius)| {
            let [right, down] = change([a, b, long, long * part].map(f64::from));
            let mut row = [x, y, 0.0, 0.0, 0.0, 0.0, radius];
            for (slot, value) in row[2..6].iter_mut().zip([right.x, right.y, down.x, down.y]) {
                *slot = value as f32;
            }
            row
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            STIPPLE,
            "let right = vec2(i(2u), i(3u));
             let down = vec2(i(4u), i(5u));
             let wide = singular_values(right, down).x;
             return vec4(disc_coverage(vec2(i(0u), i(1u)), right, down, wide, i(6u)), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, a, b, c, d, radius] = row.map(f64::from);
            let [away, right, down] = [[x, y], [a, b], [c, d]].map(DVec2::from_array);
            let want = disc_coverage(away, right, down, radius);
            // The edge of a pixel is as steep as a hundredth of a unit.
            let off = (f64::from(found[0]) - want).abs();
            assert!(off < 1e-3, "{row:?}: {found:?}, {want}");
        }
    });
}

/// Every tone, angle and level. Where rounding decides which plane or which dot is meant, the reference a
/// little beside it is as good.
#[test]
fn dots_match_the_reference() {
    let fraction = || 0.0f32..=1.0;
    let row = (
        (-3.0f32..=3.0, -3.0f32..=3.0),
        (0.5f32..=60.0, 0.01f32..=1.0),
        2.0f32..=24.0,
        (fraction(), fraction()),
        (0.1f32..=0.9, -90.0f32..=90.0),
        (-0.9f32..=0.9),
    )
        .prop_filter_map(
            "seen from the front",
            |((a, b), (distance, tone), spacing, (wobble, pressure), (layer, angle), x)| {
                let normal = DVec3::new(a.into(), b.into(), 1.5).normalize();
                let ray = DVec3::new(1.5 * f64::from(x), 0.3, -1.0).normalize();
                (normal.dot(ray) < -0.05).then_some([
                    a, b, distance, tone, spacing, wobble, pressure, layer, angle, x,
                ])
            },
        );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            &format!("{STIPPLE}\n{VIEW}"),
            "var s: Strokes;
             s.spacing = i(4u); s.wobble = i(5u); s.pressure = i(6u); s.layer_darkness = i(7u);
             s.seed = 7u;
             let angle = radians(i(8u));
             s.axes = mat3x3(vec3(cos(angle), 0.0, -sin(angle)), vec3(0.0, 1.0, 0.0),
                 vec3(sin(angle), 0.0, cos(angle)));
             let n = normalize(vec3(i(0u), i(1u), 1.5));
             let h = VIEW * vec4(i(9u), 0.3, 0.1 / i(2u), 1.0);
             let on = surface_at(VIEW, h, vec2(2.0 / 96.0, -2.0 / 64.0), n);
             return vec4(stippled(s, on, i(3u)), stippled(s, page_at(on.place.xy * 9.0, s.spacing), i(3u)), 0.0, 0.0);",
            rows,
        );
        let mut apart = 0;
        for (row, found) in rows.iter().zip(results) {
            let s = Hatching {
                marks: HatchingMarks::Dots,
                spacing: row[4],
                wobble: row[5],
                pressure: row[6],
                layer_darkness: row[7],
                angle: row[8],
                ..Hatching::default()
            };
            let hatch = Hatch {
                settings: &s,
                scale: 1.0,
                drawing: 7,
            };
            let [a, b, distance, tone] = [0, 1, 2, 3].map(|k| f64::from(row[k]));
            let clip = DVec2::new(f64::from(row[9]), f64::from(0.3f32));
            let place = DVec3::new(1.5 * clip.x, clip.y, -1.0) * distance;
            let normal = DVec3::new(a, b, 1.5).normalize();
            let on = Surface::of_plane(view(), clip, DVec2::new(96.0, 64.0), (place, normal));
            let page = Surface::page(DVec2::new(place.x, place.y) * 9.0, f64::from(s.spacing));
            for (on, found) in [on, page].into_iter().zip(found) {
                apart += usize::from(!is_near(&hatch, &on, tone, f64::from(found)));
            }
        }
        assert!(apart <= rows.len() / 200, "{apart} of {}", 2 * rows.len());
    });
}

/// Truth: all pixels that a disc touches cover its area together, however small it is, and however it is
/// seen.
#[test]
fn the_sum_of_a_disc_is_its_area() {
    for [long, short] in [[1.0, 1.0], [1.0, 0.4], [1.0, 0.1]] {
        let [right, down] = change([0.4, 1.1, long, short]);
        for radius in [0.2, 0.5, 1.0, 3.0] {
            // Four places of the disc in each direction of a pixel.
            let reach = ((radius + 1.0) / short).ceil() as i32 + 1;
            let mut sum = 0.0;
            for y in -4 * reach..4 * reach {
                for x in -4 * reach..4 * reach {
                    let [x, y] = [x, y].map(|i| (f64::from(i) + 0.5) / 4.0);
                    sum += disc_coverage(right * x + down * y, right, down, radius) / 16.0;
                }
            }
            let area = PI * radius * radius / (long * short);
            let off = (sum / area - 1.0).abs();
            // Small and narrow discs are drawn wider and fainter.
            let limit = if radius < long { 0.04 } else { 0.01 };
            assert!(off < limit, "{long}, {short}, {radius}: {off}");
        }
    }
}
