//! Paint and means over boxes.

use bevy_comics_testkit::{
    painting::{QUADRANTS, RADII, SLOPES, edge_moved, noisy, quadrant, random},
    reference::{
        box_statistics::{Means, Sheet, means, part_of_box, root, square},
        paint::{Scene, chosen, edge, reaching_share, sector_weight},
    },
};

use super::{
    settings::{expression, view},
    *,
};
use crate::prelude::*;

const PAINT: &str = "#import bevy_comics::effects::paint::{
        Paint, chosen, chosen_color, direction_of, no_choice, paint_radius, reaching_share, sector_direction,
        sector_weight,
    }
    #import bevy_comics::effect::box_statistics::{
        half_side, mean_color, means_of_color, packed_means, part_of_box, root, square, unpacked_means,
        variance,
    }";

#[test]
fn means_are_stored_as_they_are() {
    let row = (
        (wide_component(), wide_component(), wide_component()),
        0.0f32..4.0,
        0.0f32..=1.0,
    )
        .prop_map(|((r, g, b), square, coverage)| [r, g, b, square, coverage]);
    for_batches(row, |rows| {
        let means = "let m = means_of_color(root(vec3(i(0u), i(1u), i(2u))), i(3u), i(4u), 2.5);
            let n = unpacked_means(packed_means(m));";
        let colors = gpu().evaluate(
            PAINT,
            &format!("{means} return vec4(mean_color(n), 0.0);"),
            rows,
        );
        let rest = format!("{means} return vec4(n.square, n.coverage, variance(m), n.half);");
        let rest = gpu().evaluate(PAINT, &rest, rows);
        for ((row, color), rest) in rows.iter().zip(colors).zip(rest) {
            let want = rgb(row).map(root);
            let largest = want.iter().fold(0.0, |a, c| f64::max(a, c.abs()));
            for i in 0..3 {
                // Half a unit of 11 bits in a difference of up to twice the largest; green
                // takes on 0.4 of the errors of both.
                let apart = (f64::from(color[i]) - want[i]).abs();
                assert!(apart <= 2.1 * largest / 2048.0 + 1e-7, "{row:?}: {color:?}");
            }
            assert_eq!([rest[0], rest[3]], [row[3], 2.5]);
            assert!((rest[1] - row[4]).abs() < 1.0 / 2048.0, "{row:?}");
            let m = Means {
                color: want,
                square: f64::from(row[3]),
                coverage: 1.0,
                half: 0.0,
            };
            let scale = 1.0 + largest * largest;
            assert!(
                (f64::from(rest[2]) - m.variance()).abs() < 1e-6 * scale,
                "{row:?}"
            );
        }
    });
}

#[test]
fn parts_of_boxes_and_roots_match_the_reference() {
    let row = (0.0f32..20.0, -22i32..22, wide_component());
    for_batches(row.prop_map(|(half, by, c)| [half, by as f32, c]), |rows| {
        let body = "let c = vec3(i(2u));
            return vec4(part_of_box(i(0u), i32(i(1u))), root(c).x, square(c).x, half_side(i(0u)));";
        for (row, found) in rows.iter().zip(gpu().evaluate(PAINT, body, rows)) {
            let want = part_of_box(f64::from(row[0]), row[1] as i64);
            assert!((f64::from(found[0]) - want).abs() < 2e-6, "{row:?}");
            assert!(ulps(found[1], root(f64::from(row[2]))) < 4.0, "{row:?}");
            assert!(ulps(found[2], square(f64::from(row[2]))) < 4.0, "{row:?}");
            assert_eq!(found[3], row[0]);
        }
    });
    let odd = [[f32::NAN], [f32::INFINITY], [-1.0], [1e30]];
    let found = gpu().evaluate(PAINT, "return vec4(half_side(i(0u)));", &odd);
    let found: Vec<f32> = found.iter().map(|found| found[0]).collect();
    assert_eq!(found, [0.0, 128.0, 0.0, 128.0]);
}

#[test]
fn sectors_and_radii_match_the_reference() {
    let s = Paint {
        at_near: 2.0,
        at_far: 9.0,
        ..Paint::default()
    };
    let s = expression("Paint", &["f32"; 4], &s, &view([96, 64], 1.25, 0.0));
    let row = (-1.0f32..1.0, -1.0f32..1.0, 0u32..8, -0.5f32..1.5);
    let body = format!(
        "let d = sector_direction(i32(i(2u)));
         return vec4(sector_weight(vec2(i(0u), i(1u)), d), d, paint_radius({s}, i(3u)));"
    );
    for_batches(row.prop_map(|(x, y, k, d)| [x, y, k as f32, d]), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(PAINT, &body, rows)) {
            let angle = f64::from(row[2]) * std::f64::consts::TAU / 8.0;
            let direction = [angle.cos(), angle.sin()];
            for i in 0..2 {
                assert!((f64::from(found[1 + i]) - direction[i]).abs() < 1e-6);
            }
            let want = sector_weight([row[0], row[1]].map(f64::from), direction);
            // The slope of the square is up to 8, that of eta is rounded to 5 digits.
            assert!(
                (f64::from(found[0]) - want).abs() < 5e-5,
                "{row:?}: {found:?}, {want}"
            );
            let radius = 1.25 * (2.0 + 7.0 * f64::from(row[3]).clamp(0.0, 1.0));
            assert!((f64::from(found[3]) - radius).abs() < 1e-5);
        }
    });
}

#[test]
fn boxes_that_are_too_small_count_as_the_reference_says() {
    let row = (0.0f32..9.0, 0.0f32..9.0, 0u32..10);
    let body = "return vec4(reaching_share(i(0u), i(1u), i32(i(2u))));";
    for_batches(row.prop_map(|(a, b, at)| [a, b, at as f32]), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(PAINT, body, rows)) {
            let [a, b] = [row[0], row[1]].map(f64::from);
            let want = reaching_share(a, b, row[2] as i64);
            // Parts are exact to 1e-6, and are divided by at least as much.
            let part = part_of_box(b, row[2] as i64).max(1e-6);
            let apart = (f64::from(found[0]) - want).abs();
            assert!(apart < 4e-6 / part, "{row:?}: {found:?}, {want}");
        }
    });
}

#[test]
fn directions_of_edges_match_the_reference() {
    let size = || prop_oneof![3 => -1.0f32..1.0, 1 => select(vec![0.0, 1e-6, -0.3, 0.3])];
    let row = (size(), size(), size(), size());
    // The tensor of two slopes.
    let tensor = |a: f32, b: f32, c: f32, d: f32| [a * a + c * c, a * b + c * d, b * b + d * d];
    for_batches(
        row.prop_map(move |(a, b, c, d)| tensor(a, b, c, d)),
        |rows| {
            let body = "return vec4(direction_of(vec3(i(0u), i(1u), i(2u))), 0.0);";
            for (row, found) in rows.iter().zip(gpu().evaluate(PAINT, body, rows)) {
                let want = edge(row.map(f64::from));
                let along = want[0] * f64::from(found[0]) + want[1] * f64::from(found[1]);
                let spread = (0.5 * f64::from(row[0] - row[2])).hypot(f64::from(row[1]));
                // Without an edge, the direction does not count.
                let certain = spread > 1e-3 * f64::from(row[0] + row[2]);
                assert!(
                    !certain || along.abs() > 0.999,
                    "{row:?}: {found:?}, {want:?}"
                );
                let length = f64::from(found[0]).hypot(f64::from(found[1]));
                assert!((length - 1.0).abs() < 1e-5, "{row:?}: {found:?}");
                assert!((f64::from(found[2]) - want[2]).abs() < 1e-4, "{row:?}");
            }
        },
    );
}

#[test]
fn areas_are_chosen_as_the_reference_does() {
    let area = || {
        (
            component(),
            component(),
            component(),
            0.0f32..0.3,
            0.0f32..=1.0,
        )
    };
    let numbers = |(a, b, c, sharpness)| {
        let of = |(r, g, b, v, share): (f32, f32, f32, f32, f32)| [r, g, b, v, share];
        let all = [of(a), of(b), of(c)].concat();
        std::array::from_fn::<f32, 16, _>(|i| all.get(i).copied().unwrap_or(sharpness))
    };
    for eighth in [false, true] {
        let body = format!(
            "var c = no_choice();
            for (var k = 0u; k < 3u; k++) {{
                let color = vec3(i(5u * k), i(5u * k + 1u), i(5u * k + 2u));
                let mean = dot(color, vec3(0.2126, 0.7152, 0.0722));
                let m = means_of_color(color, mean * mean + i(5u * k + 3u), 1.0, 0.0);
                c = chosen(c, m, i(5u * k + 4u), 0.5 * i(15u), {eighth});
            }}
            return vec4(chosen_color(c), c.sum.w);"
        );
        let row = (area(), area(), area(), 1.0f32..16.0).prop_map(numbers);
        for_batches(row, |rows| {
            for (row, found) in rows.iter().zip(gpu().evaluate(PAINT, &body, rows)) {
                let area = |k: usize| {
                    let row = &row[5 * k..];
                    let color = rgb(row);
                    let m = Means {
                        color,
                        square: color::luminance(color).powi(2) + f64::from(row[3]),
                        coverage: 1.0,
                        half: 0.0,
                    };
                    (m, f64::from(row[4]))
                };
                let sharpness = if eighth { 8.0 } else { f64::from(row[15]) };
                let Some(want) = chosen(&[0, 1, 2].map(area), sharpness) else {
                    assert_eq!(found[3], 0.0);
                    continue;
                };
                // Variances are differences of numbers up to 1.3 with errors of 1.2e-7: the
                // weight of an even area is off by up to 8 * 1.3e-7 / 1e-4 = 1 %.
                let apart = codes_apart(found, want);
                assert!(apart < 2.0, "{row:?}: {found:?}, {want:?}: {apart}");
            }
        });
    }
}

/// Truth: the box of radius 4 around the middle of a quadrant is the quadrant of Kuwahara
/// (1976): 25 pixels, of which one is the pixel itself.
#[test]
fn boxes_of_even_radii_are_the_quadrants_of_kuwahara() {
    let sheet = noisy([21, 17]);
    for radius in [2usize, 4, 6] {
        let half = radius / 2;
        let boxes = means(&sheet, &|_| half as f64);
        for (x, y) in [(10, 8), (7, 9), (12, 7)] {
            for [sx, sy] in QUADRANTS {
                let pixels = quadrant(&sheet, [x, y], [sx, sy], radius as i64);
                let count = pixels.len() as f64;
                let of = |f: &dyn Fn(&Means) -> f64| pixels.iter().map(f).sum::<f64>() / count;
                let lum = |m: &Means| color::luminance(m.color);
                let mean = of(&lum);
                let variance = of(&|m| (lum(m) - mean).powi(2));
                let middle = [x + sx * half as i64, y + sy * half as i64];
                let found = boxes[middle[1] as usize * 21 + middle[0] as usize];
                for c in 0..3 {
                    let apart = found.color[c] - of(&|m| m.color[c]);
                    assert!(apart.abs() < 1e-9, "{radius}: {apart}");
                }
                assert!((found.variance() - variance).abs() < 1e-9, "{radius}");
            }
        }
    }
}

/// Truth: boxes of any size are direct sums over the pixels, each by its part that is inside.
#[test]
fn boxes_are_direct_sums() {
    let sheet = noisy([15, 11]);
    for half in [0.0, 0.3, 1.0, 2.25, 4.5] {
        let boxes = means(&sheet, &|_| half);
        for (i, found) in boxes.iter().enumerate() {
            let at = [i % 15, i / 15].map(|v| v as f64);
            let (mut sum, mut weight) = (0.0, 0.0);
            for (j, pixel) in sheet.pixels.iter().enumerate() {
                let other = [j % 15, j / 15].map(|v| v as f64);
                // The overlap of a pixel's side with the box's side.
                let overlap = |axis: usize| -> f64 {
                    let by = (other[axis] - at[axis]).abs();
                    ((half + 0.5).min(by + 0.5) - (by - 0.5)).clamp(0.0, 1.0)
                };
                let part = overlap(0) * overlap(1);
                sum += part * pixel[1].sqrt();
                weight += part;
            }
            assert!((found.color[1] - sum / weight).abs() < 1e-9, "{half}, {i}");
            let area = (2.0 * half + 1.0f64).powi(2);
            assert!((found.coverage - weight / area).abs() < 1e-9);
        }
    }
}

fn painted(sheet: &Sheet, s: &Paint) -> Sheet {
    let scene = Scene {
        sheet,
        depth: &|_| 0.0,
        id: &|_| 0,
        scale: 1.0,
    };
    scene.painted(s)
}

const FORMS: [PaintKernel; 2] = [PaintKernel::Box, PaintKernel::Anisotropic];

/// Truth: the variance of noise on one colour falls to less than a tenth; a mean over one box of
/// 25 pixels would be a twenty-fifth, but areas are chosen by their noise.
#[test]
fn noise_is_painted_over() {
    let size = [40, 30];
    let sheet = Sheet::new(size, |[x, y]| {
        let root = 0.5 + 0.1 * (random(y * 40 + x) - 0.5);
        [root * root, root * root, root * root, 1.0]
    });
    let variance = |sheet: &Sheet| {
        let inside = (8..22).flat_map(|y| (8..32).map(move |x| [x, y]));
        let values: Vec<f64> = inside.map(|at| sheet.at(at)[1].sqrt()).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = |v: &f64| (v - mean).powi(2);
        values.iter().map(square).sum::<f64>() / values.len() as f64
    };
    for form in FORMS {
        let s = Paint {
            kernel: form,
            ..Paint::default()
        };
        let fraction = variance(&painted(&sheet, &s)) / variance(&sheet);
        assert!(fraction < 0.1, "{form:?}: {fraction}");
    }
}

/// Truth: edges of all directions, anti-aliased, stay within a tenth of a pixel on the mean of
/// their rows, measured as they are seen: in square roots of light.
#[test]
fn edges_stay_in_place() {
    for slope in SLOPES {
        for form in FORMS {
            for radius in RADII {
                let moved = edge_moved(form, radius, slope);
                assert!(moved.abs() < 0.1, "{form:?}, {radius}, {slope}: {moved}");
            }
        }
    }
}

/// Truth: a narrow brush on what is near does not carry its colour into what is painted with a
/// wide brush behind it, nor the other way.
#[test]
fn brushes_of_two_widths_keep_to_their_sides() {
    let sheet = Sheet::new([40, 9], |[x, _]| {
        let light = if x < 20 { 0.9 } else { 0.2 };
        [light, light, light, 1.0]
    });
    for (near, far) in [(0.0, 8.0), (1.0, 8.0), (3.0, 5.0), (8.0, 1.0), (4.5, 4.0)] {
        let s = Paint {
            at_near: near,
            at_far: far,
            ..Paint::default()
        };
        let scene = Scene {
            sheet: &sheet,
            depth: &|[x, _]| if x < 20 { 0.0 } else { 1.0 },
            id: &|_| 0,
            scale: 1.0,
        };
        let painted = scene.painted(&s);
        for (i, (before, after)) in sheet.pixels.iter().zip(&painted.pixels).enumerate() {
            let apart = (before[1] - after[1]).abs();
            assert!(apart < 0.02, "{near}, {far}: {}: {apart}", i % 40);
        }
    }
}
