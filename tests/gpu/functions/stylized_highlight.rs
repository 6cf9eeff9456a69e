//! Signs of light, rims and the detail of ramps against their references.

use bevy_comics_testkit::{
    device::gpu,
    reference::{detail, stylized_highlight, toon::rim},
};
use proptest::{collection::vec, prelude::Strategy};

use super::{ONE_CODE, for_batches};
use crate::prelude::*;

const IMPORT: &str = "#import bevy_comics::toon::stylized_highlight::{StylizedHighlight, Frame, frame_along, \
    stylized_highlight_coverage, stylized_highlight_radius, faithful_distance, moved, place_of, sign_distance}";

pub(super) const SHAPES: [HighlightShape; 7] = [
    HighlightShape::Disc,
    HighlightShape::Square,
    HighlightShape::Window,
    HighlightShape::Crescent,
    HighlightShape::Star,
    HighlightShape::Streak,
    HighlightShape::Faithful,
];

/// Numbers of a sign.
const SIGN: usize = 14;

/// Reads a sign from the row.
const SIGN_OF: &str =
    "let g = StylizedHighlight(vec2(i(0u), i(1u)), vec2(i(2u), i(3u)), vec2(i(4u), i(5u)),
     vec2(cos(radians(i(6u))), sin(radians(i(6u)))), i(7u), i(8u), i(9u), i(10u), i(11u), i(12u),
     u(13u));";

fn sign<const N: usize>(row: &[f32; N]) -> StylizedHighlight {
    let pair = |k: usize| Vec2::new(row[k], row[k + 1]);
    StylizedHighlight {
        offset: pair(0),
        scale: pair(2),
        split: pair(4),
        rotation: row[6],
        size: row[7],
        square: row[8],
        bar: row[9],
        softness: row[10],
        points: row[11] as u32,
        sharpness: row[12] as u32,
        shape: SHAPES[row[13] as usize],
        ..StylizedHighlight::default()
    }
}

/// Signs, and four numbers from -1 to 1.
fn rows() -> impl Strategy<Value = [f32; SIGN + 4]> {
    let some = || proptest::prop_oneof![1 => proptest::prelude::Just(0.0f32), 1 => 0.0f32..2.0];
    (
        (vec(-3.0f32..3.0, 2), vec(0.3f32..3.0, 2)),
        (some(), some(), -360.0f32..360.0, 0.3f32..3.0),
        (0.0f32..=1.0, 0.05f32..0.6, 0.5f32..4.0),
        (3u32..=12, 1u32..=10, 0usize..7),
        vec(-1.0f32..1.0, 4),
    )
        .prop_map(
            |(
                (offset, scale),
                (sx, sy, turn, size),
                (square, bar, soft),
                (points, sharp, shape),
                at,
            )| {
                let mut row = [0.0; SIGN + 4];
                row[..SIGN].copy_from_slice(&[
                    offset[0],
                    offset[1],
                    scale[0],
                    scale[1],
                    sx,
                    sy,
                    turn,
                    size,
                    square,
                    bar,
                    soft,
                    points as f32,
                    sharp as f32,
                    shape as f32,
                ]);
                row[SIGN..].copy_from_slice(&at);
                row
            },
        )
}

#[test]
fn signs_match_the_reference() {
    let body = format!(
        "{SIGN_OF}
         let radius = 0.05 + 0.5 * abs(i(16u));
         let place = vec2(i(14u), i(15u));
         let here = sign_distance(g, radius, place);
         return vec4(here, stylized_highlight_coverage(g, i(14u), i(15u), i(16u)), 0.0, 0.0);"
    );
    for_batches(rows(), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, &body, rows)) {
            let g = sign(row);
            let [x, y, r] = [14, 15, 16].map(|k| f64::from(row[k]));
            let reference = stylized_highlight::sign_distance(&g, 0.05 + 0.5 * r.abs(), [x, y]);
            // At most 3 / (0.3 * 0.3 * 0.05) radii away; powers of up to 8 and roots of them.
            let room = 3e-5 * (1.0 + reference.abs());
            assert!(
                (f64::from(found[0]) - reference).abs() < room,
                "{row:?}: {}, not {reference}",
                found[0]
            );
            // The width may be as small as the numbers' rounding.
            if (y - x).hypot(r - x) > 1e-3 {
                let reference = stylized_highlight::stylized_highlight_coverage(&g, x, y, r);
                assert!(
                    (f64::from(found[1]) - reference).abs() < ONE_CODE,
                    "{row:?}: {}, not {reference}",
                    found[1]
                );
            }
        }
    });
}

#[test]
fn moved_half_vectors_match_the_reference() {
    let body = format!(
        "{SIGN_OF}
         let n = normalize(vec3(i(14u), i(15u), 1.0));
         let h = normalize(vec3(i(16u), i(17u), 1.5));
         let f = frame_along(n, vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
         let m = moved(g, f, 0.3, h);
         return vec4(m, place_of(f, n, h).x);"
    );
    for_batches(rows(), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, &body, rows)) {
            let g = sign(row);
            let [a, b, c, d] = [14, 15, 16, 17].map(|k| f64::from(row[k]));
            let normal = stylized_highlight::unit([a, b, 1.0]);
            let half = stylized_highlight::unit([c, d, 1.5]);
            let frame = stylized_highlight::frame_along(normal, [1.0, 0.0, 0.0]);
            let reference = stylized_highlight::moved(&g, frame, 0.3, half);
            let place = stylized_highlight::place_of(frame, normal, half)[0];
            // On the border between two parts of a sign that is split, either is right.
            let flat = StylizedHighlight {
                split: Vec2::ZERO,
                ..g
            };
            let before = stylized_highlight::moved(
                &StylizedHighlight {
                    square: 0.0,
                    ..flat
                },
                frame,
                0.3,
                half,
            );
            let right = f64::from(g.rotation).to_radians();
            let [du, dv] = frame;
            let along: f64 = (0..3)
                .map(|k| before[k] * (right.cos() * du[k] + right.sin() * dv[k]))
                .sum();
            let across: f64 = (0..3)
                .map(|k| before[k] * (right.cos() * dv[k] - right.sin() * du[k]))
                .sum();
            if along.abs() < 1e-4 || across.abs() < 1e-4 {
                continue;
            }
            for (found, reference) in found[..3].iter().zip(reference) {
                assert!(
                    (f64::from(*found) - reference).abs() < 2e-4,
                    "{row:?}: {found}, not {reference}"
                );
            }
            // A quotient of two products of unit vectors, each of which is off by some roundings.
            let along: f64 = (0..3).map(|k| half[k] * normal[k]).sum();
            let room = 32.0 * 2f64.powi(-24) * (1.0 + place.abs()) / along.max(1e-4);
            let off = (f64::from(found[3]) - place).abs();
            assert!(off < room, "{row:?}: {}, not {place}", found[3]);
        }
    });
}

/// The radius of the plain highlight against a bisection of its distribution.
#[test]
fn the_radius_is_where_the_highlight_ends() {
    let rows = (0.01f32..0.99, 0.0f32..1.0).prop_map(|(edge, rough)| [edge, rough]);
    for_batches(rows, |rows| {
        let body = "return vec4(stylized_highlight_radius(i(0u), i(1u)));";
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, body, rows)) {
            let [edge, rough] = row.map(f64::from);
            let reference = stylized_highlight::stylized_highlight_radius(edge, rough);
            // Where the distribution hardly falls below the edge, the radius is not decided.
            let a2 = (rough * rough).max(0.002).powi(2);
            if (edge.sqrt() - a2).abs() < 1e-3 || reference > 100.0 {
                continue;
            }
            let found = f64::from(found[0]);
            assert!(
                (found - reference).abs() < 2e-3 * reference.max(0.01),
                "{row:?}: {found}, not {reference}"
            );
        }
    });
}

/// Nothing is not a number where directions are opposite or zero.
#[test]
fn signs_of_degenerate_directions_are_finite() {
    let body = format!(
        "{SIGN_OF}
         var n = vec3(0.0, 0.0, 1.0);
         var h = vec3(0.0, 0.0, -1.0);
         if i(14u) > 0.5 {{ n = vec3(0.0); }} else if i(14u) > 0.0 {{ h = vec3(1.0, 0.0, 0.0); }}
         let f = frame_along(n, n, vec3(0.0, 1.0, 0.0));
         let a = faithful_distance(g, f, 0.3, n, h);
         let b = sign_distance(g, 0.3, place_of(f, n, h));
         return vec4(a, b, stylized_highlight_coverage(g, a, a, a), stylized_highlight_coverage(g, b, b, b));"
    );
    for_batches(rows(), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, &body, rows)) {
            assert!(
                found[1..].iter().all(|x| x.is_finite()),
                "{row:?}: {found:?}"
            );
        }
    });
}

/// Distances from a ten-thousandth to ten thousand, or cosines.
#[test]
fn details_match_the_reference() {
    let import = "#import bevy_comics::toon::detail::{Detail, detail_by_depth, \
        detail_in_focus, detail_of_highlight, detail_of_rim}";
    let body = "let z = i(4u);
         let d = Detail(i(0u), 1.0 / log(i(1u)), log(1.0 + i(2u)), i(3u));
         return vec4(detail_by_depth(d, z), detail_in_focus(d, z), detail_of_rim(d, i(5u)),
             detail_of_highlight(d, i(5u)));";
    let rows = (
        -3.0f32..3.0,
        1.1f32..100.0,
        0.0f32..2.0,
        0.5f32..8.0,
        -4.0f32..4.0,
        -1.0f32..1.0,
    )
        .prop_map(|(a, b, c, d, e, f)| [10f32.powf(a), b, c, d, 10f32.powf(e), f]);
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let [near, ratio, clear, power, z, cosine] = *row;
            let (z, cosine) = (f64::from(z), f64::from(cosine));
            let focus = DetailAxis::Focus {
                distance: near,
                clear,
                ratio,
            };
            let references = [
                detail::detail(DetailAxis::Depth { from: near, ratio }, z),
                detail::detail(focus, z),
                detail::detail(DetailAxis::Rim { power }, cosine),
                detail::detail(DetailAxis::Highlight { power }, cosine),
            ];
            for (found, reference) in found.into_iter().zip(references) {
                let far = (f64::from(found) - reference).abs();
                // Logarithms are right to 2^-21 near 1; at most ten of it per ratio of 1.1.
                assert!(
                    far < 1e-3 || (power < 0.6 && cosine.abs() < 1e-3),
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    });
}

/// The ends of the axes are exact, and they do not depend on the unit of the world.
#[test]
fn details_begin_and_end_where_they_should() {
    for scale in [1.0, 1000.0] {
        let depth = DetailAxis::Depth {
            from: 2.0 * scale,
            ratio: 8.0,
        };
        let scale = f64::from(scale);
        for (z, wanted) in [
            (0.1, 1.0),
            (2.0, 1.0),
            (4.0, 2.0 / 3.0),
            (16.0, 0.0),
            (99.0, 0.0),
        ] {
            assert!((detail::detail(depth, z * scale) - wanted).abs() < 1e-12);
        }
        let focus = DetailAxis::Focus {
            distance: 4.0 * scale as f32,
            clear: 0.0,
            ratio: 2.0,
        };
        for (z, wanted) in [(4.0, 1.0), (2.0, 0.0), (8.0, 0.0), (4.0 * 2f64.sqrt(), 0.5)] {
            assert!((detail::detail(focus, z * scale) - wanted).abs() < 1e-12);
        }
    }
}

/// Two ramps of three stops, mixed.
#[test]
fn mixed_ramps_match_the_reference() {
    const STOPS: usize = 3;
    let import = "#import bevy_comics::toon::ramp::{Ramp, Stop, mixed_ramp, tone}
        #import bevy_comics::effect::color::linear_to_oklab";
    // Of each stop: both places, greys and softnesses; then the detail, what arrives and its width.
    let body = "var ramp: Ramp;
         for (var k = 0u; k < 8u; k++) {
             let n = 6u * min(k, 2u);
             let a = linear_to_oklab(vec3(i(n + 2u), 1.0 - i(n + 2u), 0.5));
             let b = linear_to_oklab(vec3(0.3, i(n + 3u), i(n + 3u)));
             ramp.stops[k] = Stop(a, i(n), b, i(n + 1u), i(n + 4u), i(n + 5u));
         }
         return vec4(tone(mixed_ramp(ramp, i(18u)), i(19u), i(20u)), 0.0);";
    let rows = (
        vec(0.0f32..=1.0, 6 * STOPS),
        0.0f32..=1.0,
        -1.0f32..=1.0,
        0.002f32..0.2,
    )
        .prop_map(|(stops, detail, arriving, width)| {
            let mut row = [0.0; 6 * STOPS + 3];
            row[..6 * STOPS].copy_from_slice(&stops);
            row[6 * STOPS..].copy_from_slice(&[detail, arriving, width]);
            row
        });
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let of = |k: usize| &row[6 * k.min(STOPS - 1)..][..6];
            let all = 0..Ramp::MOST_STOPS;
            let full = all.clone().map(|k| {
                let n = of(k);
                RampStop::new(n[0], Color::linear_rgb(n[2], 1.0 - n[2], 0.5)).soft(n[4])
            });
            let plain: Vec<RampStop> = all
                .map(|k| {
                    let n = of(k);
                    RampStop::new(n[1], Color::linear_rgb(0.3, n[3], n[3])).soft(n[5])
                })
                .collect();
            let [detail, arriving, width] = [0, 1, 2].map(|k| f64::from(row[6 * STOPS + k]));
            let reference = detail::tone(&Ramp::new(full), &plain, detail, arriving, width);
            for (found, reference) in found.into_iter().zip(reference) {
                assert!(
                    (f64::from(found) - reference).abs() < 0.5 * ONE_CODE,
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    });
}

#[test]
fn rims_match_the_reference() {
    let import = "#import bevy_comics::toon::rim::{Rim, facing_rim, is_behind, rim_side}";
    let body = "let r = Rim(vec3(1.0), 1.0, 1.0 - i(0u), i(1u), 3.0, i(2u));
         return vec4(facing_rim(r, i(3u), i(4u)), rim_side(r, i(3u)), is_behind(1.0 + 0.1 * i(5u), 0.02 * i(3u)),
             0.0);";
    let rows = (
        0.0f32..1.0,
        0.0f32..0.5,
        0.0f32..=1.0,
        -1.0f32..=1.0,
        0.003f32..0.2,
        0.0f32..1.0,
    )
        .prop_map(|(share, softness, side, cosine, width, behind)| {
            [share, softness, side, cosine, width, behind]
        });
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let [share, softness, lit_side, cosine, width, behind] = *row;
            let rim = Rim {
                width: RimWidth::Facing { share, softness },
                lit_side,
                ..Rim::default()
            };
            let references = [
                rim::facing_rim(&rim, f64::from(cosine), f64::from(width)),
                rim::rim_side(&rim, f64::from(cosine)),
                rim::is_behind(1.0 + 0.1 * f64::from(behind), 0.02 * f64::from(cosine)),
            ];
            for (found, reference) in found.into_iter().zip(references) {
                let far = (f64::from(found) - reference).abs();
                assert!(far < 0.2 * ONE_CODE, "{row:?}: {found}, not {reference}");
            }
        }
    });
}
