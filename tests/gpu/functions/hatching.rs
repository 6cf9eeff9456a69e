//! Strokes and dots of hatching.

use std::f64::consts::PI;

use bevy_comics_testkit::reference::{
    hatching::{Hatch, Surface},
    nested::stroke_factor,
    stipple::disc_coverage,
};

use super::*;
use crate::prelude::*;

/// A view of 90 degrees, 96 x 64 pixels, from the origin; the settings, and the plane that the ray
/// of a pixel meets.
const PLACE: &str = "
    #import bevy_comics::effect::stipple::stippled
    #import bevy_comics::effect::strokes::{Strokes, Surface, hatched, page_at}
    #import bevy_comics::effects::hatching::surface_at
    const VIEW = mat4x4<f32>(
        vec4(1.5, 0.0, 0.0, 0.0), vec4(0.0, 1.0, 0.0, 0.0),
        vec4(0.0, 0.0, 0.0, 10.0), vec4(0.0, 0.0, -1.0, 0.0),
    );
    fn strokes(axes: mat3x3<f32>) -> Strokes {
        var s: Strokes;
        s.spacing = i(4u); s.length = i(5u); s.breaks = i(6u); s.wobble = i(7u);
        s.pressure = i(8u); s.layers = u32(i(9u)); s.layer_darkness = i(10u); s.seed = 7u;
        let angle = radians(i(11u));
        s.axes = mat3x3(vec3(cos(angle), 0.0, -sin(angle)), vec3(0.0, 1.0, 0.0),
            vec3(sin(angle), 0.0, cos(angle))) * axes;
        return s;
    }
    fn surface() -> Surface {
        let n = normalize(vec3(i(0u), i(1u), 1.5));
        let h = VIEW * vec4(i(12u), 0.3, 0.1 / i(2u), 1.0);
        return surface_at(VIEW, h, vec2(2.0 / 96.0, -2.0 / 64.0), n);
    }";

fn view() -> DMat4 {
    DMat4::from_cols_array(&[
        1.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, -1.0, 0.0,
    ])
}

/// The ranges of the inputs: two tilts of the plane, its distance, the darkness; spacing, length,
/// breaks, wobble, pressure, layers, darkness of a layer, angle; the place in the picture.
const STROKES: [[f32; 2]; 13] = [
    [-1.0, 1.0],
    [-1.0, 1.0],
    [0.5, 60.0],
    [0.01, 1.0],
    [2.0, 24.0],
    [10.0, 400.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [1.0, 3.0],
    [0.45, 0.45],
    [-90.0, 90.0],
    [-0.9, 0.9],
];

/// The plane and the pixel of a row: its normal, and the ray without its length.
fn plane(row: &[f32; 13]) -> [DVec3; 2] {
    let normal = DVec3::new(row[0].into(), row[1].into(), 1.5).normalize();
    [
        normal,
        DVec3::new(1.5 * f64::from(row[12]), f64::from(0.3f32), -1.0),
    ]
}

/// Whether a coverage is that of the reference, there or a little beside it: where rounding decides
/// which mark or which axis is meant, both are right.
fn is_near(hatch: &Hatch, on: &Surface, tone: f64, found: f32) -> bool {
    let near = [-0.02, 0.0, 0.02].map(|by| {
        let place = on.place + by * (on.across + on.down);
        hatch.cover(&Surface { place, ..*on }, tone)
    });
    let low = near.iter().copied().fold(f64::MAX, f64::min) - 0.01;
    let high = near.iter().copied().fold(f64::MIN, f64::max) + 0.01;
    (low..=high).contains(&f64::from(found))
}

/// Every tone, angle and level, on surfaces and on the page. `call`: the function, and the axes
/// before they turn by the angle.
fn check_marks(kind: HatchingKind, ranges: [[f32; 2]; 13], [function, axes]: [&str; 2]) {
    let row = vec(0.0f32..=1.0, 13).prop_filter_map("dots are seen from the front", |parts| {
        let mut row = std::array::from_fn(|k| {
            let [low, high]: [f32; 2] = ranges[k];
            low + (high - low) * parts[k]
        });
        row[9] = row[9].round();
        let [normal, ray] = plane(&row);
        let is_front = normal.dot(ray.normalize()) < -0.05;
        (is_front || kind == HatchingKind::Strokes).then_some(row)
    });
    let body = format!(
        "let s = strokes({axes});
         let on = surface();
         let page = page_at(on.place.xy * 9.0, s.spacing);
         return vec4({function}(s, on, i(3u)), {function}(s, page, i(3u)), 0.0, 0.0);"
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(PLACE, &body, rows);
        let mut apart = 0;
        for (row, found) in rows.iter().zip(results) {
            let s = Hatching {
                kind,
                spacing: row[4],
                length: row[5],
                breaks: row[6],
                wobble: row[7],
                pressure: row[8],
                layers: row[9] as u32,
                layer_darkness: row[10],
                angle: row[11],
                ..Hatching::default()
            };
            let hatch = Hatch::new(&s).drawn(7);
            let [normal, ray] = plane(row);
            let place = ray * f64::from(row[2]);
            let clip = DVec2::new(f64::from(row[12]), ray.y);
            let on = Surface::of_plane(view(), clip, DVec2::new(96.0, 64.0), (place, normal));
            let page = Surface::page(place.truncate() * 9.0, f64::from(s.spacing));
            for (on, found) in [on, page].iter().zip(found) {
                apart += usize::from(!is_near(&hatch, on, f64::from(row[3]), found));
            }
        }
        assert!(apart <= rows.len() / 200, "{apart} of {}", 2 * rows.len());
    });
}

#[test]
fn strokes_match_the_reference() {
    let axes = "mat3x3<f32>(vec3(2.0, 2.0, -1.0) / 3.0, vec3(-1.0, 2.0, 2.0) / 3.0,
        vec3(2.0, -1.0, 2.0) / 3.0)";
    check_marks(HatchingKind::Strokes, STROKES, ["hatched", axes]);
}

#[test]
fn dots_match_the_reference() {
    let mut ranges = STROKES;
    ranges[..2].fill([-3.0, 3.0]);
    ranges[10] = [0.1, 0.9];
    let axes = "mat3x3<f32>(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)";
    check_marks(HatchingKind::Dots, ranges, ["stippled", axes]);
}

/// Truth: breaks leave the mean width of a line as it is.
#[test]
fn the_mean_of_strokes_is_one() {
    for breaks in [0.0, 0.3, 1.0] {
        for grown in [0.0, 0.4, 1.0] {
            let count = 20_000;
            let places = (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count));
            let sum: f64 = places.map(|at| stroke_factor(at, grown, breaks)).sum();
            let mean = sum / f64::from(count);
            assert!((mean - 1.0).abs() < 1e-4, "{breaks}, {grown}: {mean}");
        }
    }
}

/// Truth: all pixels that a disc touches cover its area together, however small it is, and however
/// it is seen.
#[test]
fn the_sum_of_a_disc_is_its_area() {
    for (long, short) in [(1.0, 1.0), (1.0, 0.4), (1.0, 0.1)] {
        // The change of a place over a pixel, turned and stretched.
        let [right, down] = [DVec2::X, DVec2::Y].map(|by| {
            let by = by.rotate(DVec2::from_angle(0.4)) * DVec2::new(long, short);
            by.rotate(DVec2::from_angle(1.1))
        });
        for radius in [0.2, 0.5, 1.0, 3.0] {
            // Four places of the disc in each direction of a pixel.
            let reach = 4 * (((radius + 1.0) / short).ceil() as i32 + 1);
            let places = (-reach..reach).flat_map(|y| (-reach..reach).map(move |x| [x, y]));
            let covers = places.map(|place| {
                let [x, y] = place.map(|i| (f64::from(i) + 0.5) / 4.0);
                disc_coverage(right * x + down * y, right, down, radius) / 16.0
            });
            let area = PI * radius * radius / (long * short);
            let off = (covers.sum::<f64>() / area - 1.0).abs();
            // Small and narrow discs are drawn wider and fainter.
            let limit = if radius < long { 0.04 } else { 0.01 };
            assert!(off < limit, "{long}, {short}, {radius}: {off}");
        }
    }
}
