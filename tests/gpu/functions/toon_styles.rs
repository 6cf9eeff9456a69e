//! Lines, tone bands, sketch and toon light against their references.

use bevy_comics_testkit::reference::{crack, edge, light, sketch, tone_bands};

use super::*;
use crate::prelude::*;

const EDGE: &str = "#import bevy_comics::lines::edge::{gradient, gradient_extremes, edge_response, component_response, is_outdone, step_excess, step_response, fold, fold_response, is_ridge, is_rim_ridge, line_coverage, line_offset, pack_ink, unpack_crack, encode_ink, decode_ink}";

/// A window of 5 x 5 depths, row by row (random, a step or a ramp), then `k` of Eq. 2
/// and an unused element.
fn window() -> impl Strategy<Value = [f32; 27]> {
    let value = prop_oneof![4 => 0.0f32..=1.0, 1 => select(vec![0.0f32, 1.0, 0.5])];
    (vec(value, 25), 0u8..3, 1e-4f32..0.5, 1e-3f32..1.0).prop_map(|(values, kind, k, height)| {
        let mut row = [0.0; 27];
        for (n, slot) in row[..25].iter_mut().enumerate() {
            let (x, y) = ((n % 5) as f32, (n / 5) as f32);
            *slot = match kind {
                0 => values[n],
                1 => height * if x + y * values[0] > 2.0 { 1.0 } else { 0.3 },
                _ => height * (0.2 + 0.1 * values[0] * x + 0.05 * values[1] * y),
            };
        }
        row[25] = k;
        row
    })
}

#[test]
fn gradient_and_response_are_equations_1_and_2() {
    for_batches(window(), |rows| {
        let results = gpu().evaluate(
            EDGE,
            "var v: array<f32, 25>;
             for (var n = 0u; n < 25u; n++) { v[n] = i(n); }
             let g = gradient_extremes(&v);
             let excess = step_excess(vec4(v[10]), vec4(v[11]), vec4(v[12]), vec4(v[13]), vec4(v[14]), vec4(v[15]));
             let outdone = is_outdone(vec4(v[11]), vec4(v[12]), vec4(v[13]), vec4(v[14])).x;
             return vec4(g.x, select(g.y, -g.y - 1.0, outdone), edge_response(g, i(25u)), excess.x);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let w: [[f64; 5]; 5] =
                std::array::from_fn(|r| std::array::from_fn(|c| f64::from(row[5 * r + c])));
            // The largest gradient is at least 0: a negative one says that a step is outdone.
            let outdone = result[1] < 0.0;
            let result = [
                result[0],
                if outdone { -result[1] - 1.0 } else { result[1] },
                result[2],
                result[3],
            ];
            let g = edge::gradient_extremes(&w, |a: f64, b: f64| (a - b).abs());
            // A sum of at most 12, divided by eight: 12 roundings, each half an ulp of
            // a number below 16, which is 2^-24 after the division.
            let step = 12.0 * 2f64.powi(-24);
            assert!(
                (f64::from(result[0]) - g[0]).abs() <= step,
                "{row:?}: {result:?}, {g:?}"
            );
            assert!(
                (f64::from(result[1]) - g[1]).abs() <= step,
                "{row:?}: {result:?}, {g:?}"
            );
            let k = f64::from(row[25]);
            let p = edge::edge_response(g, k);
            // p = r^2, so dp = 2 r dr, with r at most 1 and dr the error of both
            // extremes over k.
            let slack = (2.0 * 2.0 * step / k).max(4.0 * 2f64.powi(-23));
            assert!(
                (f64::from(result[2]) - p).abs() <= slack,
                "{row:?}: {result:?}, {p}"
            );
            let six = [w[2][0], w[2][1], w[2][2], w[2][3], w[2][4], w[3][0]];
            let excess = edge::step_excess(six);
            // Differences of equal steps are rounding.
            let steps = [1, 2, 3].map(|i: usize| (six[i] - six[i + 1]).abs());
            let [low, high] = [steps[0].min(steps[2]), steps[0].max(steps[2])];
            let tie = (steps[1] - high).abs().min((0.1 * steps[1] - low).abs()) < 1e-6;
            assert!(
                tie || outdone == edge::is_outdone(six),
                "{row:?}: {result:?}"
            );
            assert!(
                (f64::from(result[3]) - excess).abs() <= 2f64.powi(-22),
                "{row:?}"
            );
        }
    });
}

/// Property of the weights of Eq. 1: the gradient of a ramp along an axis is its slope
/// everywhere, so that a plane has no edge response.
#[test]
fn a_ramp_answers_with_its_slope_and_a_plane_with_no_edge() {
    for slope in [1e-5, 0.01, 0.2] {
        let ramp: [[f64; 5]; 5] =
            std::array::from_fn(|_| std::array::from_fn(|c| slope * c as f64));
        let g = edge::gradient_extremes(&ramp, |a: f64, b: f64| (a - b).abs());
        assert!(
            (g[0] - slope).abs() < 1e-15 && (g[1] - slope).abs() < 1e-15,
            "{g:?}"
        );
        // The response of a step of height h is h / 2.
        let step: [[f64; 5]; 5] =
            std::array::from_fn(|_| std::array::from_fn(|c| if c > 2 { slope } else { 0.0 }));
        let g = edge::gradient_extremes(&step, |a: f64, b: f64| (a - b).abs());
        assert!((g[1] - g[0] - 0.5 * slope).abs() < 1e-15, "{g:?}");
    }
}

/// Windows of 5 x 5 random unit normals, one in twelve of them missing.
#[test]
fn creases_match_the_reference_in_both_forms() {
    let row = (
        vec((-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0, 0u8..12), 25),
        0.02f32..1.0,
    )
        .prop_map(|(normals, k)| {
            let mut row = [0.0f32; 101];
            for (n, (x, y, z, there)) in normals.into_iter().enumerate() {
                let length = (x * x + y * y + z * z).sqrt().max(1e-3);
                row[4 * n..4 * n + 4].copy_from_slice(&[
                    x / length,
                    y / length,
                    z / length,
                    f32::from(u8::from(there > 0)),
                ]);
            }
            row[100] = k;
            row
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            EDGE,
            "var v: array<vec4<f32>, 25>;
             for (var n = 0u; n < 25u; n++) { v[n] = vec4(i(4u*n), i(4u*n+1u), i(4u*n+2u), i(4u*n+3u)); }
             let folds = vec3(fold(v[0], v[1]), fold(v[1], v[2]), fold(v[2], v[3]));
             let ridge = is_ridge(vec4(folds.x), vec4(folds.y), vec4(folds.z)).x;
             let rim = is_rim_ridge(vec4(folds.x), vec4(folds.y), vec4(folds.z)).x;
             return vec4(folds.y, fold_response(vec4(folds.y), i(100u)).x, component_response(&v, i(100u)), select(select(0.0, 2.0, rim), 1.0, ridge));",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let w: [[edge::Normal; 5]; 5] = std::array::from_fn(|r| {
                std::array::from_fn(|c| {
                    let n = &row[4 * (5 * r + c)..];
                    (n[3] > 0.0).then(|| [n[0], n[1], n[2]].map(f64::from))
                })
            });
            let folds = [0, 1, 2].map(|i: usize| edge::fold(w[0][i], w[0][i + 1]));
            let step = 40.0 * 2f64.powi(-24);
            let fold = folds[1].unwrap_or(-1.0);
            assert!(
                (f64::from(result[0]) - fold).abs() <= step,
                "{result:?} {fold}"
            );
            let k = f64::from(row[100]);
            let response = edge::fold_response(folds[1], k);
            assert!(
                (f64::from(result[1]) - response).abs() <= step / (k * k),
                "{result:?} {response}"
            );
            let rim = edge::is_rim_ridge(folds);
            let ridge = match edge::is_ridge(folds) {
                true => 1.0,
                false => 2.0 * f32::from(u8::from(rim)),
            };
            let known = folds.map(|f| f.unwrap_or(9.0));
            let tie = (known[1] - known[0]).abs().min((known[1] - known[2]).abs()) <= step
                || (known[1] - 1.0).abs() <= step;
            assert!(tie || result[3] == ridge, "{result:?} {folds:?}");
            let p = edge::component_response(&w, k);
            assert!(
                (f64::from(result[2]) - p).abs() <= 4.0 * step / k,
                "{result:?} {p}"
            );
        }
    });
}

#[test]
fn a_turned_scene_has_the_same_measured_creases() {
    // Faithful creases are computed for each component, so they depend on the axes by
    // design.
    let turn = |n: [f64; 3], a: f64| {
        [
            n[0] * a.cos() - n[1] * a.sin(),
            n[0] * a.sin() + n[1] * a.cos(),
            n[2],
        ]
    };
    let crease = |a: f64| -> [[edge::Normal; 5]; 5] {
        std::array::from_fn(|_| {
            std::array::from_fn(|c| {
                let n = if c > 2 {
                    [0.5, 0.0, 0.75f64.sqrt()]
                } else {
                    [-0.5, 0.0, 0.75f64.sqrt()]
                };
                Some(turn(n, a))
            })
        })
    };
    let step = |a: f64| {
        let w = crease(a);
        edge::fold(w[2][2], w[2][3]).expect("normals").sqrt()
    };
    let p0 = edge::component_response(&crease(0.0), 1.0);
    let mut moved = 0.0f64;
    for k in 1..12 {
        let a = f64::from(k) * 0.13;
        assert!((step(a) - step(0.0)).abs() < 1e-12, "{a}: {}", step(a));
        moved = moved.max((edge::component_response(&crease(a), 1.0) - p0).abs());
    }
    assert!(
        moved > 0.05,
        "the faithful equations should depend on the axes: {moved}"
    );
    // A crease of 60 degrees has the response 1 if `k` is that of 60 degrees.
    let response = edge::fold_response(Some(step(0.0).powi(2)), 30f64.to_radians().sin());
    assert!((response - 1.0).abs() < 1e-12, "{response}");
}

#[test]
fn a_line_covers_what_it_should_and_packs_without_loss() {
    let row = (0.0f32..20.0, 0.1f32..16.0, vec(0.0f32..=1.0, 3), 0u8..4)
        .prop_map(|(d, h, ink, side)| [d, h, ink[0], ink[1], ink[2], f32::from(side)]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            EDGE,
            "let packed = pack_ink(vec4(i(2u)), vec4(i(3u)), vec4(i(1u))).x | 13u;
             let back = unpack_crack(packed);
             let ink = vec3(i(2u), i(3u), i(4u));
             let stored = round(encode_ink(ink) * 255.0) / 255.0;
             let kept = select(0.0, 1.0, back.kinds == 5u && back.owner_here
                 && abs(back.ink - i(2u)) <= 0.502 / 255.0 && abs(back.opacity - i(3u)) <= 0.502 / 255.0
                 && all(abs(decode_ink(stored) - ink) <= vec3(1.01 / 255.0)));
             return vec4(line_coverage(i(0u), i(1u)), line_offset(i(1u)), back.half_width, kept);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let (d, h) = (f64::from(row[0]), f64::from(row[1]));
            let want = edge::line_coverage(d, h);
            assert!(
                (f64::from(result[0]) - want).abs() < 1e-5,
                "{row:?} {result:?} {want}"
            );
            let offset = edge::line_offset(h);
            assert!(
                (f64::from(result[1]) - offset).abs() < 1e-5,
                "{row:?} {result:?} {offset}"
            );
            assert!(
                // Half of the last of ten bits.
                (f64::from(result[2]) - h).abs() <= (h + 0.125) / 1000.0,
                "{row:?} {result:?}"
            );
            assert_eq!(result[3], 1.0, "{row:?}");
        }
    });
}

/// Opacities and half widths half way between two codes, and what is a few roundings above and
/// below them, have one code: the lower.
#[test]
fn what_is_half_way_between_two_codes_is_stored_one_way() {
    // Odd tenths as bytes; as widths, k + 1/2 steps of 1/512, less the 1/8 that is added when
    // they are packed.
    let tenths = [0.1f32, 0.3, 0.5, 0.7, 0.9];
    let halves = [513u16, 601, 777, 1001].map(|k| (f32::from(k) + 0.5) / 512.0 - 0.125);
    let mut rows = Vec::new();
    for opacity in tenths {
        for half_width in halves {
            for ulps in -3i32..=3 {
                let moved = |x: f32| f32::from_bits(x.to_bits().wrapping_add_signed(ulps));
                rows.push([moved(opacity), moved(half_width)]);
            }
        }
    }
    let results = gpu().evaluate(
        EDGE,
        "let back = unpack_crack(pack_ink(vec4(1.0), vec4(i(0u)), vec4(i(1u))).x | 13u);
         return vec4(back.opacity * 255.0, (back.half_width + 0.125) * 512.0, 0.0, 0.0);",
        &rows,
    );
    for (row, result) in rows.iter().zip(results) {
        let lower = (row[0] * 255.0 - 0.25).floor();
        assert_eq!(result[0].round(), lower, "{row:?}");
        assert_eq!(
            result[1],
            ((row[1] + 0.125) * 512.0 - 0.25).floor(),
            "{row:?}"
        );
        let reference = [
            crack::stored_byte(f64::from(row[0])) * 255.0,
            (crack::stored_width(f64::from(row[1])) + 0.125) * 512.0,
        ];
        assert_eq!(reference[0].round() as f32, lower, "{row:?}");
        assert_eq!(reference[1] as f32, result[1], "{row:?}");
    }
}

/// Property: the coverage of all pixels across a line adds up to its width.
#[test]
fn coverage_adds_up_to_the_width() {
    for k in 1..=64 {
        let h = 0.125 * f64::from(k);
        let sum: f64 = (-40..40)
            .map(|n| edge::line_coverage((f64::from(n) + 0.5 + edge::line_offset(h)).abs(), h))
            .sum();
        assert!((sum - 2.0 * h).abs() < 1e-12, "{h}: {sum}");
    }
}

#[test]
fn tone_bands_match_the_reference() {
    let row = (
        (component(), component(), component()),
        2u8..9,
        0.0f32..4.0,
        prop_oneof![Just(0.0f32), 0.0f32..0.3],
        0.0f32..=1.0,
        any::<bool>(),
    )
        .prop_map(|((r, g, b), levels, softness, change, amount, faithful)| {
            [
                r,
                g,
                b,
                f32::from(levels),
                softness,
                change,
                amount,
                f32::from(u8::from(faithful)),
            ]
        });
    let undecided = std::cell::Cell::new(0usize);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effects::tone_bands::{ToneBands, banded_color}",
            "let s = ToneBands(i(3u), i(4u), i(6u), u(7u));
             return vec4(banded_color(s, vec3(i(0u), i(1u), i(2u)), i(5u), 0.0), 0.0);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = ToneBands {
                equations: if row[7] == 1.0 {
                    Equations::Faithful
                } else {
                    Equations::Corrected
                },
                levels: row[3] as u32,
                softness: row[4],
                amount: row[6],
            };
            let change = f64::from(row[5]);
            let at = |nudge: f64| {
                let c = rgb(row).map(|c| c * (1.0 + nudge));
                tone_bands::banded_color(&s, c, change, 1.0)
            };
            if codes_apart(result, at(0.0)) <= 1.0 {
                continue;
            }
            // The lightness lies at a step between two bands, within its rounding.
            let apart = codes_apart([0, 1, 2, 0].map(|i: usize| at(1e-5)[i] as f32), at(-1e-5));
            assert!(apart > 1.0, "{row:?}: {result:?}, {:?}", at(0.0));
            undecided.set(undecided.get() + 1);
        }
    });
    assert!(
        undecided.get() < 12 * 2048 / 200,
        "{} undecided",
        undecided.get()
    );
}

#[test]
fn equation_6_is_closed_monotone_and_makes_white_0_83() {
    let codes: Vec<f64> = (0..=255)
        .map(|c| tone_bands::equation_6(f64::from(c) / 255.0))
        .collect();
    // The printed ranges omit the codes 85, 86, 169 and 170. Here every code has a
    // tone, and tones increase strictly.
    assert!(codes.windows(2).all(|w| w[1] > w[0]), "{codes:?}");
    assert!((codes[255] - 0.83).abs() < 1e-12);
    assert!((tone_bands::equation_6(0.5) - 0.415).abs() < 1e-12);
}

#[test]
fn the_levels_are_as_many_as_asked_and_keep_the_chroma() {
    for levels in 2..=8u32 {
        let s = ToneBands {
            levels,
            softness: 0.0,
            ..ToneBands::default()
        };
        // Leaves out lightnesses within a code of a step.
        let off_step = |v: &f64| {
            let t = v * f64::from(levels);
            (t - t.round()).abs() > f64::from(levels) / 255.0
        };
        let mut tones: Vec<i64> = (0..4094)
            .map(|n| f64::from(n) / 4093.0)
            .filter(off_step)
            .map(|v| {
                let light = [v * v; 3];
                let banded = tone_bands::banded_color(&s, light, 0.0, 1.0);
                (color::lightness(banded) * 1e6).round() as i64
            })
            .collect();
        tones.dedup();
        assert_eq!(tones.len(), levels as usize, "{tones:?}");
    }
    let s = ToneBands {
        softness: 0.0,
        ..ToneBands::default()
    };
    let red = [0.2, 0.05, 0.02];
    let banded = tone_bands::banded_color(&s, red, 0.0, 1.0);
    for i in 1..3 {
        assert!(
            (banded[i] / banded[0] - red[i] / red[0]).abs() < 1e-12,
            "{banded:?}"
        );
    }
}

#[test]
fn the_sketch_matches_the_reference() {
    let row = (
        (0.0f32..2000.0, 0.0f32..2000.0),
        0u8..3,
        0u16..60000,
        (0.0f32..8.0, 2.0f32..256.0, 0.0f32..=1.0),
        (0.0f32..=1.0, 0.25f32..4.0, component()),
    )
        .prop_map(
            |((x, y), stroke, drawing, (jitter, wavelength, pressure), (ink, gamma, wash))| {
                [
                    x,
                    y,
                    f32::from(stroke),
                    f32::from(drawing),
                    jitter,
                    wavelength,
                    pressure,
                    ink,
                    gamma,
                    wash,
                ]
            },
        );
    for_batches(row, |rows| {
        let import =
            "#import bevy_comics::effects::sketch::{Sketch, stray, pen_pressure, draw_sketch}";
        let setup = "var s: Sketch; s.jitter = i(4u); s.wavelength = i(5u); s.pressure = i(6u); s.drawing = u(3u);
             s.gamma = i(8u); s.wash = i(9u); s.paper = vec3(0.9, 0.8, 0.7); s.ink = vec3(0.1, 0.05, 0.02);
             let at = vec2(i(0u), i(1u));";
        let strays = gpu().evaluate(
            import,
            &format!("{setup} return vec4(stray(s, at, u(2u)), pen_pressure(s, at, u(2u)), 0.0);"),
            rows,
        );
        let drawn = gpu().evaluate(
            import,
            &format!("{setup} return vec4(draw_sketch(s, vec4(0.3, 0.5, 0.7, 0.8), i(7u)), 0.0);"),
            rows,
        );
        for (row, (strayed, drawn)) in rows.iter().zip(strays.into_iter().zip(drawn)) {
            let s = Sketch {
                jitter: row[4],
                wavelength: row[5],
                pressure: row[6],
                gamma: row[8],
                wash: row[9],
                paper: Color::linear_rgb(0.9, 0.8, 0.7),
                ink: Color::linear_rgb(0.1, 0.05, 0.02),
                ..Sketch::default()
            };
            let at = [row[0], row[1]].map(f64::from);
            let (stroke, drawing) = (row[2] as u32, row[3] as u32);
            let want = sketch::stray(&s, at, stroke, drawing, 1.0);
            // The position is at most 1700 wavelengths and is rounded to 24 bits; the
            // noise changes by at most 3 per wavelength.
            let slack = 3.0 * 1700.0 * 2f64.powi(-23) * (1.0 + f64::from(row[4]));
            for i in 0..2 {
                assert!(
                    (f64::from(strayed[i]) - want[i]).abs() < slack,
                    "{row:?} {strayed:?} {want:?}"
                );
            }
            let pressure = sketch::pen_pressure(&s, at, stroke, drawing, 1.0);
            assert!((f64::from(strayed[2]) - pressure).abs() < slack, "{row:?}");
            assert_same_color(
                row,
                drawn,
                sketch::draw_sketch(&s, [0.3, 0.5, 0.7, 0.8], f64::from(row[7])),
            );
        }
    });
}

#[test]
fn the_toons_light_matches_the_reference() {
    let row = (
        (0.05f32..1.0, 0.0f32..=1.0, 0.0f32..0.1),
        (0.01f32..2000.0, 0.0f32..0.01, 0.01f32..100.0, 0.0f32..0.1),
        prop_oneof![Just(0.0f32), 0.25f32..4.0],
    )
        .prop_map(
            |((rough, n_dot_h, width), (d2, inverse, bright, pixel), falloff)| {
                [rough, n_dot_h, width, d2, inverse, bright, pixel, falloff]
            },
        );
    let import = "#import bevy_comics::toon::light::{ToonLight, highlight, highlight_fraction, flat_falloff}";
    let undecided = std::cell::Cell::new(0usize);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            import,
            "let s = ToonLight(0.08, 1.0, 1.0, 1.0, 0.5, i(7u), 1.0);
             return vec4(highlight_fraction(i(0u), i(1u)), highlight(s, i(0u), i(1u), i(2u)),
                 flat_falloff(s, i(3u), i(4u), i(5u), i(6u)), 0.0);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let r = row.map(f64::from);
            let s = ToonLight {
                falloff: row[7],
                ..ToonLight::default()
            };
            // The rounding of cos^2, at most 2^-23, is relative to a denominator of at
            // least roughness^2, and the quotient is squared: twice that, times four.
            let fraction = light::highlight_fraction(r[0], r[1]);
            let slack = (8.0 * 2f64.powi(-23) / (r[0] * r[0])).min(1.0);
            assert!(
                (f64::from(result[0]) - fraction).abs() <= slack.max(1e-6),
                "{row:?} {result:?} {fraction}"
            );
            let close = |got: f32, want: [f64; 3], what: &str| {
                let [want, low, high] = want;
                let spread = (high - low).abs() + 2e-4 * want.abs().max(1e-6);
                let off = (f64::from(got) - want).abs();
                if off > spread.min(2e-4 * want.abs().max(1e-6)) {
                    assert!(
                        off <= spread,
                        "{what}: {row:?}: {got}, {want} within {spread}"
                    );
                    undecided.set(undecided.get() + 1);
                }
            };
            let at = |n: f64| light::highlight(&s, r[0], (r[1] + n).clamp(0.0, 1.0), r[2]);
            if r[0] > 0.1 {
                close(result[1], [at(0.0), at(-3e-6), at(3e-6)], "highlight");
            }
            let at = |n: f64| light::flat_falloff(&s, r[3] * (1.0 + n), r[4], r[5], r[6]);
            close(result[2], [at(0.0), at(-1e-5), at(1e-5)], "falloff");
        }
    });
    assert!(
        undecided.get() < 12 * 2048 / 20,
        "{} undecided",
        undecided.get()
    );
}
