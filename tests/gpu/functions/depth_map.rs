//! The depth map, its differences, and its contours.

use super::*;

const MAP: &str = "#import bevy_comics::depth::map::{DepthFrame, depth_map, depth_step}";
const FRAME: &str = "let f = DepthFrame(i(0u), i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), u(7u));";

/// The fields of `DepthFrame` (near, far, offset, floor, `plane_far`, extent,
/// `sky_gap`, flags), then two raw depths.
type MapRow = [f32; 10];

fn frame_of(row: &MapRow) -> Frame {
    let orthographic = row[7] as u32 & 1 == 1;
    Frame {
        projection: if orthographic {
            Projection::Orthographic {
                plane_far: f64::from(row[4]),
                extent: f64::from(row[5]),
            }
        } else {
            Projection::Perspective {
                offset: f64::from(row[2]),
            }
        },
        ends: Some([f64::from(row[0]), f64::from(row[1])]),
        logarithmic: row[7] as u32 & 2 == 2,
        floor: f64::from(row[3]),
        sky_gap: f64::from(row[6]),
    }
}

/// Extreme ranges: near plane, nearest and farthest distance.
fn perspective_rows(logarithmic: bool) -> impl Strategy<Value = MapRow> {
    let ranges = select(vec![
        (0.1, 0.1, 1e6),
        (0.1, 10.0, 10.01),
        (0.1, 100.0, 100.001),
        (0.1, 1e5, 1e7),
        (1e3, 1e3, 1e38),
        (0.1, 10_000.0, 10_100.0),
        (0.01, 1.0, 2.0),
        (1.0, 1.0, 1.5),
        (0.1, 0.1, 1e-1 * 1.000_001),
    ]);
    let offsets = select(vec![0.0f64, 1e-4, 1e-7, 0.5]);
    let places = (0.0f64..=1.0, 0.0f64..=1.0, any::<bool>());
    (ranges, offsets, places).prop_map(
        move |((plane, near, far), offset, (t, t2, ratio)): ((f64, f64, f64), f64, _)| {
            // A projection with the offset a has its far plane at plane * (1 + a) / a.
            // Ranges beyond that use an infinite projection, with the offset 0.
            let offset = if offset * far < plane * (1.0 + offset) {
                offset
            } else {
                0.0
            };
            let raw = |z: f64| (((plane * (1.0 + offset)) / z - offset).clamp(0.0, 1.0)) as f32;
            let at = |t: f64| {
                if ratio {
                    near * (far / near).powf(t)
                } else {
                    near + (far - near) * t
                }
            };
            let flags = if logarithmic { 2.0 } else { 0.0 };
            let (n, f) = (raw(near), raw(far).max(f32::MIN_POSITIVE));
            [
                n,
                f,
                offset as f32,
                0.0,
                0.0,
                0.0,
                0.05,
                flags,
                raw(at(t)).clamp(f, n),
                raw(at(t2)).clamp(f, n),
            ]
        },
    )
}

fn orthographic_rows(logarithmic: bool) -> impl Strategy<Value = MapRow> {
    (
        select(vec![(0.0f32, 100.0f32), (-50.0, 1000.0), (0.1, 10.0)]),
        0.0f32..=1.0,
        0.0f32..=1.0,
        0.0f32..=1.0,
        0.0f32..=1.0,
    )
        .prop_map(move |((near, far), a, b, t, t2)| {
            let extent = far - near;
            let (n, f) = (a.max(b).max(1e-6), a.min(b).max(1e-7));
            let at = |t: f32| (f + (n - f) * t).clamp(f, n);
            let flags = if logarithmic { 3.0 } else { 1.0 };
            [n, f, 0.0, 1e-12, far, extent, 0.05, flags, at(t), at(t2)]
        })
}

/// (D, L, step from the first raw depth to the second, 0) of every row.
fn maps(rows: &[MapRow]) -> Vec<[f32; 4]> {
    let body = "return vec4(depth_map(f, i(8u)), depth_step(f, i(8u), i(9u)), 0.0);";
    gpu().evaluate(MAP, &format!("{FRAME} {body}"), rows)
}

/// The map is within 5 ulp of the exact quotient; steps, within 10 ulp of the difference in closed
/// form, do not cancel.
#[test]
fn the_linear_map_and_its_steps_are_exact() {
    for rows in [
        perspective_rows(false).boxed(),
        orthographic_rows(false).boxed(),
    ] {
        for_batches(rows, |rows| {
            for (row, [got_d, got_l, got_step, _]) in rows.iter().zip(maps(rows)) {
                if row[0] <= row[1] {
                    continue;
                }
                let [d, l] = frame_of(row).depth_map(f64::from(row[8]));
                for (got, want) in [(got_d, d), (got_l, l)] {
                    assert!(ulps(got, want) <= 5.0, "{row:?}: {got} for {want}");
                }
                let [near, far, a, d, p] = [0, 1, 2, 8, 9].map(|k| f64::from(row[k]));
                let step = if row[7] == 0.0 {
                    (p - d) / (near - far) * ((near + a) / (d + a)) * ((far + a) / (p + a))
                } else {
                    (p - d) / (near - far)
                };
                assert!(
                    ulps(got_step, step) <= 10.0,
                    "{row:?}: {got_step} for {step}"
                );
            }
        });
    }
}

/// WGSL allows an error of 3 ulp for `log()` and of 2.5 ulp for a division; the map uses two of each.
/// An orthographic map takes logarithms of distances that are rounded already, which needs an
/// absolute tolerance.
#[test]
fn the_logarithmic_map_keeps_its_relative_precision() {
    for_batches(perspective_rows(true), |rows| {
        assert_logarithmic(rows, |d| 16.0 * 2f64.powi(-23) * d.max(2f64.powi(-20)));
    });
    for_batches(orthographic_rows(true), |rows| {
        let is_wide = |row: &&MapRow| row[0] - row[1] >= 1e-3 * row[0];
        let rows: Vec<MapRow> = rows.iter().filter(is_wide).copied().collect();
        assert_logarithmic(&rows, |_| 2e-4);
    });
}

fn assert_logarithmic(rows: &[MapRow], tolerance: impl Fn(f64) -> f64) {
    for (row, [got, ..]) in rows.iter().zip(maps(rows)) {
        let [want, _] = frame_of(row).depth_map(f64::from(row[8]));
        let apart = (f64::from(got) - want).abs();
        let is_close = row[0] <= row[1] || apart <= tolerance(want);
        assert!(is_close, "{row:?}: {got} for {want}");
    }
}

#[test]
fn what_is_no_depth_lies_at_the_far_end() {
    let infinite = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let rows: Vec<MapRow> = [&[0.0, -0.0, 1e-40, -0.5, 1.5][..], &infinite]
        .concat()
        .into_iter()
        .map(|d| [0.5, 0.001, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, d, 0.0])
        .collect();
    for (row, found) in rows.iter().zip(maps(&rows)) {
        assert_eq!(found[..2], [1.0, 0.0], "{}", row[8]);
    }
    // D is 0 on a flat wall, and 1 in a view without geometry.
    let floor = 1.0 / 16384.0;
    let [flat, empty] =
        [0.0, 4.0].map(|flags| [0.25, 0.25, 0.0, floor, 0.0, 0.0, 0.05, flags, 0.25, 0.0]);
    let found = maps(&[flat, empty]);
    assert_eq!(found[0][..2], [0.0, 1.0]);
    assert_eq!(found[1][..2], [1.0, 0.0]);
}

/// With flags 0 to 3 (neither, orthographic, logarithmic, both), and with the upper row of the
/// window in the sky or not.
#[test]
fn one_depth_without_a_floor_is_a_flat_wall_and_no_number_is_lost() {
    let of = |flags, sky| [0.25, 0.25, 0.0, 0.0, 10.0, 10.0, 0.05, flags, 0.25, sky];
    let rows: Vec<MapRow> = [0.0, 1.0, 2.0, 3.0]
        .into_iter()
        .flat_map(|flags| [0.0, 0.25].map(|sky| of(flags, sky)))
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::{DepthFrame, depth_map, depth_step}
         #import bevy_comics::depth::window::{Window}
         #import bevy_comics::effects::contours::{Contours, contour_response}",
        &format!(
            "{FRAME} var s: Contours; let d = i(8u); let sky = i(9u);
             let w = Window(sky, sky, sky, d, d, d, d, d, d, 0u);
             return vec4(depth_map(f, d), depth_step(f, d, d), contour_response(s, f, w));"
        ),
        &rows,
    );
    for (row, [d, l, step, response]) in rows.iter().zip(results) {
        assert_eq!([d, l, step], [0.0, 1.0, 0.0], "{row:?}");
        // The wall is at D = 0, the sky at D = 1.05.
        let (want, slack) = if row[9] == 0.0 {
            (1.05, 0.02)
        } else {
            (0.0, 0.0)
        };
        assert!((response - want).abs() <= slack, "{row:?}: {response}");
    }
}

/// In a view without geometry there is no range, and the slope of the map is 0. The
/// window of the sky is 0 there, and so are the keys of the range.
#[test]
fn a_view_without_geometry_has_no_slope() {
    let floor = 1.0 / 16384.0;
    let of = |offset, flags| [0.0, 0.0, offset, floor, 10.0, 10.0, 0.05, flags, 0.0, 0.0];
    let rows: Vec<MapRow> = [4.0, 5.0, 6.0, 7.0]
        .into_iter()
        .flat_map(|flags| [0.0, 1e-3].map(|offset| of(offset, flags)))
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::DepthFrame
         #import bevy_comics::depth::window::{Window, window_slope}
         #import bevy_comics::effects::black_flats::{BlackFlats, steep_area}",
        &format!(
            "{FRAME} let d = i(8u); let w = Window(d, d, d, d, d, d, d, d, d, 0u);
             var s: BlackFlats; s.slope_low = 0.018; s.slope_high = 0.022; s.slope_scale = 1.0;
             let slope = window_slope(f, w);
             return vec4(slope, steep_area(s, slope), 0.0, 0.0);"
        ),
        &rows,
    );
    for (row, [slope, area, ..]) in rows.iter().zip(results) {
        assert_eq!([slope, area], [0.0, 0.0], "{row:?}");
    }
}

/// Truth: planes have no contour by any operator, from face-on to grazing, in a range of 1 : 1000:
/// the response of the corrected equations is rounding alone.
#[test]
fn no_plane_has_a_contour_at_any_angle() {
    // The operator, and the raw depth, which is affine in the pixel.
    let rows: Vec<[f32; 10]> = (0..2000u16)
        .map(|k| {
            let across = (f32::from(k % 40) - 20.0) * 1e-5;
            let down = (f32::from(k / 40) - 25.0) * 1e-5;
            std::array::from_fn(|at| match at {
                0 => f32::from(k % 4),
                _ => {
                    let [x, y] = [(at - 1) % 3, (at - 1) / 3].map(|v| v as f32 - 1.0);
                    0.002 + across * x + down * y
                }
            })
        })
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::{DepthFrame}
         #import bevy_comics::depth::window::{Window}
         #import bevy_comics::effects::contours::{Contours, contour_response}",
        "let f = DepthFrame(1.0, 0.001, 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
         var s: Contours; s.operator_kind = u(0u);
         let w = Window(i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), i(7u), i(8u), i(9u), 0u);
         return vec4(contour_response(s, f, w));",
        &rows,
    );
    let worst = results.iter().map(|r| r[0]).fold(0.0, f32::max);
    assert!(worst < 1e-4, "a plane answers {worst}");
}
