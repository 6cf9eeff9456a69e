//! What the modes of ramps make of several lights.

use bevy_comics_testkit::{
    device::gpu,
    reference::toon::{
        ambient::brightness,
        brightest, light_fraction, per_light, ramp_light, reflect,
        surface::{Arriving, Surface},
        two_shades::{self, Evenly},
    },
};

use super::{READ, Row, assert_color, evenly, lamps, light, rows, surface};
use crate::prelude::*;

const ROWS: usize = 4096;

/// How the second axis of ramps is found.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Axis {
    None,
    Surface,
    Highlight,
}

/// Both blends, with and without a second ramp.
const VARIANTS: [(RampBlend, Axis); 5] = [
    (RampBlend::Multiply, Axis::None),
    (RampBlend::Absolute, Axis::None),
    (RampBlend::Multiply, Axis::Surface),
    (RampBlend::Absolute, Axis::Highlight),
    (RampBlend::Multiply, Axis::Highlight),
];

fn definitions(blend: RampBlend, axis: Axis) -> Vec<Definition<'static>> {
    let mut all = vec![("RAMP_STOPS", Some(3))];
    if blend == RampBlend::Absolute {
        all.push(("RAMP_ABSOLUTE", None));
    }
    if axis != Axis::None {
        all.push(("RAMP_DETAIL", None));
    }
    if axis == Axis::Highlight {
        all.push(("DETAIL_HIGHLIGHT", None));
    }
    all
}

fn axis_of(row: &Row, axis: Axis) -> Option<DetailAxis> {
    match axis {
        Axis::None => None,
        Axis::Surface => Some(DetailAxis::Constant(1.0)),
        Axis::Highlight => Some(DetailAxis::Highlight {
            power: row[super::POWER],
        }),
    }
}

/// The largest channel that all light could have without shadows and tones.
fn most(lamps: &[Arriving], e: &Evenly, color: impl Fn(&Arriving) -> DVec3) -> f64 {
    let direct: DVec3 = lamps.iter().map(|lamp| color(lamp) * lamp.diffuse).sum();
    e.exposure * ((direct + e.shine) / std::f64::consts::PI + e.around).max_element()
}

/// A quarter of a display code of all light. An edge is at least 0.1 wide and rises by 15 per unit; the
/// rounding of a cosine or of a share is below 1e-6, that of a detail by highlights, a power of up to
/// 20, below 3e-5. Two edges at once: 15 x 3e-5 x 2 = 9e-4.
const TONE: f64 = 1e-3;

fn check(
    module: &str,
    reference: impl Fn(&Row, &ToonLight, &Surface, &[Arriving], &Evenly) -> (DVec3, f64),
    is_decided: impl Fn(&Row, &ToonLight, &Surface, &[Arriving]) -> bool,
) {
    let import = format!("#import bevy_comics::toon::{module}::{{Sum, add, reflected}}\n{READ}");
    let body = "read_settings();
         let s = surface();
         var sum: Sum;
         for (var k = 0u; k < u(138u); k++) { add(&sum, s, lamp(k), 1.0); }
         return vec4(reflected(sum, v(99u), v(102u), v(105u)), 0.0);";
    for (k, (blend, axis)) in VARIANTS.into_iter().enumerate() {
        let rows = rows(ROWS, 17 + k as u64);
        let results = gpu().evaluate_alone(&definitions(blend, axis), &import, body, &rows);
        let mut undecided = 0;
        for (row, found) in rows.iter().zip(results) {
            assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
            let (s, lamps, e) = (surface(row), lamps(row), evenly(row));
            let light = light(row, blend, axis_of(row, axis));
            if !is_decided(row, &light, &s, &lamps) {
                undecided += 1;
                continue;
            }
            let (color, scale) = reference(row, &light, &s, &lamps, &e);
            assert_color(row, found, color, TONE * scale);
        }
        assert!(undecided < ROWS / 100, "{blend:?}, {axis:?}: {undecided}");
    }
}

#[test]
fn ramps_for_each_light_match_the_reference() {
    check(
        "per_light",
        |_, light, s, lamps, e| {
            let color = per_light::reflected(light, s, lamps, e);
            (color, most(lamps, e, |lamp| lamp.color))
        },
        |_, _, _, _| true,
    );
}

/// Which light is the brightest is not decided where two are alike within rounding, unless they are
/// the same.
#[test]
fn ramps_of_the_brightest_light_match_the_reference() {
    check(
        "brightest",
        |_, light, s, lamps, e| {
            let color = brightest::reflected(light, s, lamps, e);
            (color, most(lamps, e, |lamp| lamp.color))
        },
        |_, _, _, lamps| {
            let mut bright: Vec<f64> = lamps
                .iter()
                .map(|lamp| brightness((lamp.color * lamp.diffuse).to_array()))
                .collect();
            bright.sort_by(|a, b| b.total_cmp(a));
            bright.len() < 2 || bright[0] == bright[1] || bright[1] < (1.0 - 1e-6) * bright[0]
        },
    );
}

/// What a light adds to the share of all light, if all of it arrives.
fn share_of(light: &ToonLight, s: &Surface, lamp: &Arriving) -> f64 {
    let color = lamp.smooth_color * lamp.diffuse;
    brightness(color.to_array()) * ramp_light::angle_of(light, s, lamp).0.max(0.0)
}

/// Of more than two lights with borders of shadows, two are mixed: which two is not decided where they
/// are alike within rounding, unless they are the same.
#[test]
fn ramps_of_the_share_match_the_reference() {
    check(
        "light_fraction",
        |_, light, s, lamps, e| {
            let color = light_fraction::reflected(light, s, lamps, e);
            let scale = light_fraction::strength(light, lamps, e)
                * most(lamps, e, |lamp| lamp.smooth_color);
            (color, scale)
        },
        |_, light, s, lamps| {
            let borders = lamps.iter().filter(|lamp| lamp.lit > 0.0 && lamp.lit < 1.0);
            let mut parts: Vec<f64> = borders.map(|lamp| share_of(light, s, lamp)).collect();
            parts.sort_by(|a, b| b.total_cmp(a));
            parts.len() < 3 || parts[2] <= 0.0 || parts[2] < (1.0 - 1e-4) * parts[1]
        },
    );
}

/// A pixel in which the borders of two shadows cross at right angles, and the same pixel in 128 x 128
/// pieces, in each of which either light arrives or does not: a picture that is drawn larger.
#[test]
fn crossing_borders_of_shadows_are_mixed_by_their_areas() {
    const PIECES: usize = 128;
    let import =
        format!("#import bevy_comics::toon::light_fraction::{{Sum, add, reflected}}\n{READ}");
    let body = "read_settings();
         var s = surface();
         s.foot.normal_x = vec3(0.0);
         s.foot.normal_y = vec3(0.0);
         s.foot.bias = vec2(0.0);
         var sum: Sum;
         for (var k = 0u; k < 2u; k++) { add(&sum, s, lamp(k), 1.0); }
         return vec4(reflected(sum, v(99u), v(102u), v(105u)), 0.0);";
    let colors =
        |rows: &[Row]| gpu().evaluate_alone(&[("RAMP_STOPS", Some(3))], &import, body, rows);
    let mut numbers = super::Numbers::new(23);
    let both_lit = |row: &Row, lit: [f64; 2]| {
        let mut row = *row;
        row[super::COUNT] = 2.0;
        for (k, lit) in lit.into_iter().enumerate() {
            row[super::LAMP * k + super::LIT] = lit as f32;
        }
        row
    };
    let (mut pixels, mut pieces, mut parts) = (Vec::new(), Vec::new(), Vec::new());
    for (k, row) in rows(64, 23).into_iter().enumerate() {
        // Borders through the pixel: x cos a + y sin a = c, and the other one at a right angle. Every
        // second pair is parallel to the sides of the pixel.
        let angle = f64::from(numbers.within(0.0, 6.3));
        let (sin, cos) = if k % 2 == 0 {
            (0.0, 1.0)
        } else {
            angle.sin_cos()
        };
        let [c, d] = [0; 2].map(|_| f64::from(numbers.within(-0.3, 0.3)));
        let mut counts = [0usize; 4];
        for i in 0..PIECES * PIECES {
            let at = |k: usize| (k as f64 + 0.5) / PIECES as f64 - 0.5;
            let (x, y) = (at(i % PIECES), at(i / PIECES));
            let lit = [x * cos + y * sin > c, y * cos - x * sin > d];
            counts[usize::from(lit[0]) + 2 * usize::from(lit[1])] += 1;
        }
        let part = counts.map(|n| n as f64 / (PIECES * PIECES) as f64);
        pixels.push(both_lit(&row, [part[1] + part[3], part[2] + part[3]]));
        for state in 0..4 {
            pieces.push(both_lit(
                &row,
                [state & 1, state >> 1].map(|lit| lit as f64),
            ));
        }
        parts.push(part);
    }
    let (found, states) = (colors(&pixels), colors(&pieces));
    for (k, part) in parts.iter().enumerate() {
        let (row, e) = (&pixels[k], evenly(&pixels[k]));
        let light = light(row, RampBlend::Multiply, None);
        let lamps = lamps(row);
        let scale = light_fraction::strength(&light, &lamps, &e)
            * most(&lamps, &e, |lamp| lamp.smooth_color);
        // The mixture takes the borders as independent of each other, which they are in a pixel
        // whose sides they are parallel to.
        let together = part[3] - (part[1] + part[3]) * (part[2] + part[3]);
        let bound = (2.0 * together.abs() + TONE) * scale;
        assert!(
            together.abs() < if k % 2 == 0 { 1e-9 } else { 0.05 },
            "{together}"
        );
        for c in 0..3 {
            let mean: f64 = (0..4)
                .map(|s| part[s] * f64::from(states[4 * k + s][c]))
                .sum();
            let off = (f64::from(found[k][c]) - mean).abs();
            assert!(off <= bound, "{row:?}: {off}, not {bound}");
        }
    }
}

/// The light without a ramp, with the shadows of every light.
#[test]
fn light_in_two_shades_matches_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::two_shades::{{Sum, add, reflected}}
         #import bevy_comics::toon::reflect::unshadowed\n{READ}"
    );
    let body = "read_settings();
         let s = surface();
         var sum: Sum;
         for (var k = 0u; k < u(138u); k++) {
             let l = lamp(k);
             add(&sum, s, l, unshadowed(s, l));
         }
         return vec4(reflected(sum, v(99u), v(102u), v(105u)), 0.0);";
    let rows = rows(ROWS, 5);
    let results = gpu().evaluate_alone(&[("RAMP_STOPS", Some(3))], &import, body, &rows);
    for (row, found) in rows.iter().zip(results) {
        assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
        let (s, lamps, e) = (surface(row), lamps(row), evenly(row));
        let light = light(row, RampBlend::Multiply, None);
        let left = |lamp: Arriving| (lamp, reflect::unshadowed(&light, &s, &lamp));
        let lit: Vec<_> = lamps.iter().copied().map(left).collect();
        // Each light is as uncertain as its edge.
        let unsure: DVec3 = (lamps.iter())
            .map(|lamp| {
                super::reflect::doubt_of_an_edge(&s, lamp.to_light) * lamp.color * lamp.diffuse
            })
            .sum();
        let slack = e.exposure * unsure.max_element() / std::f64::consts::PI;
        let scale = most(&lamps, &e, |lamp| lamp.color);
        let reference = two_shades::reflected(&lit, &e);
        assert_color(row, found, reference, slack + 2e-6 * scale);
    }
}
