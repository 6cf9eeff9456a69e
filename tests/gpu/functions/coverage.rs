//! Fractions of pixels that drawn lines cover.

use bevy_comics_testkit::reference::coverage::{disc_coverage, line_ramp, straight_coverage};

use super::*;

/// Distances, half widths and directions.
#[test]
fn coverage_is_its_twin() {
    let row = (0.0f32..20.0, 0.05f32..16.0, -4.0f32..4.0, -4.0f32..4.0)
        .prop_filter("a direction", |(_, _, x, y)| x.hypot(*y) > 0.01)
        .prop_map(|(d, h, x, y)| [d, h, x, y]);
    for_batches(row, |rows: &[[f32; 4]]| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::coverage::{disc_coverage, line_ramp, straight_coverage}",
            "let ramp = line_ramp(vec2(i(2u), i(3u)));
             return vec4(ramp, straight_coverage(i(0u), i(1u), ramp), disc_coverage(i(0u), i(1u)), 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [d, h, x, y] = row.map(f64::from);
            let ramp = line_ramp([x, y]);
            let want = [ramp, straight_coverage(d, h, ramp), disc_coverage(d, h)];
            for i in 0..3 {
                // Half of an ulp of distances and widths of up to 20 pixels, over a ramp.
                let apart = (f64::from(found[i]) - want[i]).abs();
                assert!(apart < 1e-5, "{row:?}: {found:?}, {want:?}");
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
                let distances = (-30..30)
                    .map(|y| (f64::from(y) + f64::from(place) / 16.0).abs() * cosine);
                let sum: f64 = distances
                    .clone()
                    .map(|distance| straight_coverage(distance, half_width, ramp))
                    .sum();
                let apart = sum * cosine - width;
                assert!(apart.abs() < 1e-12, "slope {slope}, {width} px: {apart}");
                for distance in distances {
                    let disc = disc_coverage(distance, half_width);
                    let line = straight_coverage(distance, half_width, ramp);
                    assert!(disc <= line + 1e-12, "slope {slope}, {width} px: {distance}");
                }
            }
        }
    }
}
