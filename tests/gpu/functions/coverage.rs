//! Fractions of pixels that drawn lines cover.

use bevy_comics_testkit::reference::coverage::{
    disc_coverage, line_ramp, segment_coverage, straight_coverage,
};

use super::*;

/// Pixels around the middle of a pixel-sized part of a line of any direction, and half widths.
#[test]
fn coverage_matches_the_reference() {
    let place = || (-20.0f32..20.0, -20.0f32..20.0);
    let row = (place(), place(), 0.05f32..16.0, 0.1f32..1.4)
        .prop_filter("a direction", |(_, (x, y), ..)| x.hypot(*y) > 0.01)
        .prop_map(|((ax, ay), (x, y), h, length)| {
            let scale = length / x.hypot(y);
            [ax, ay, x * scale, y * scale, h]
        });
    for_batches(row, |rows: &[[f32; 5]]| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::coverage::{disc_coverage, line_ramp, segment_coverage}",
            "let a = vec2(i(0u), i(1u));
             let along = vec2(i(2u), i(3u));
             return vec4(
                 line_ramp(along), disc_coverage(length(a), i(4u)),
                 segment_coverage(vec2(0.0), a, a + along, i(4u)), 0.0,
             );",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, along_x, along_y, h] = row.map(f64::from);
            let to = [row[0] + row[2], row[1] + row[3]].map(f64::from);
            let segment = segment_coverage([0.0; 2], [x, y], to, h);
            let want = [
                line_ramp([along_x, along_y]),
                disc_coverage(x.hypot(y), h),
                segment,
            ];
            for i in 0..3 {
                // Half of an ulp of distances and widths of up to 40 pixels, over a ramp; the
                // direction of a short line has the rounding of its far ends.
                let limit = if i == 2 { 1e-4 } else { 2e-5 };
                let apart = (f64::from(found[i]) - want[i]).abs();
                assert!(apart < limit, "{i} of {row:?}: {found:?}, {want:?}");
            }
        }
    });
}

/// Property: in every column, the coverage by a straight line of a slope of at most 1 adds up to
/// the line's extent along the column, wherever it lies between the pixels. So the width is exact
/// in every direction. A disc around a middle covers no pixel more than the line does.
#[test]
fn coverage_adds_up_to_the_width_in_every_direction() {
    for n in 0..=64 {
        let slope = f64::from(n) / 64.0;
        let cosine = 1.0 / slope.hypot(1.0);
        let ramp = line_ramp([1.0, slope]);
        for width in [0.3, 0.6, 1.0, 2.0, 3.0, 5.0, 8.0] {
            let half_width = 0.5 * width;
            for place in 0..16 {
                let distances =
                    (-30..30).map(|y| (f64::from(y) + f64::from(place) / 16.0).abs() * cosine);
                let sum: f64 = distances
                    .clone()
                    .map(|distance| straight_coverage(distance, half_width, ramp))
                    .sum();
                let apart = sum * cosine - width;
                assert!(apart.abs() < 1e-12, "slope {slope}, {width} px: {apart}");
                for distance in distances {
                    let disc = disc_coverage(distance, half_width);
                    let line = straight_coverage(distance, half_width, ramp);
                    assert!(
                        disc <= line + 1e-12,
                        "slope {slope}, {width} px: {distance}"
                    );
                }
            }
        }
    }
}
