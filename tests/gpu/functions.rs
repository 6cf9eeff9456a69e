//! The shipped functions on the GPU against their twins, on random and
//! adversarial inputs.

use bevy::color::{Color, Hsva};
use bevy_comics::{
    BlackFlats, ColorMethod, Colorization, ColorizationMode, ContourForm, ContourOperator,
    Contours, Desaturation,
};
use proptest::{
    collection::vec,
    prelude::{ProptestConfig, Strategy, any, prop_oneof},
    sample::select,
    test_runner::TestRunner,
};

use crate::{
    device::gpu,
    reference::{
        Rgb, black_flats, color, colorization, contours, desaturation,
        map::{Frame, Projection},
    },
};

const COLOR: &str = "#import bevy_comics::styles::color::{srgb_encode, srgb_decode, linear_to_oklab, oklab_to_linear, finite, hue_of, hue_color}";

/// One code of an 8-bit display.
const ONE_CODE: f64 = 1.0 / 255.0;

/// Runs `check` on batches of rows, so that a dispatch pays off.
fn for_batches<const N: usize>(row: impl Strategy<Value = [f32; N]>, check: impl Fn(&[[f32; N]])) {
    let config = ProptestConfig {
        cases: 12,
        max_shrink_iters: 64,
        ..ProptestConfig::default()
    };
    TestRunner::new(config)
        .run(&vec(row, 2048), |rows| {
            check(&rows);
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

/// A displayed component: random, or one where formulas change their mind.
fn component() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => 0.0f32..=1.0,
        2 => select(vec![0.0, 1.0, 0.5, 0.003_130_8, 0.003_130_9, 1.0 / 255.0, 0.25, 1e-7]),
    ]
}

/// The same, beyond what a display shows.
fn wide_component() -> impl Strategy<Value = f32> {
    prop_oneof![4 => component(), 1 => -2.0f32..8.0, 1 => select(vec![65504.0, -65504.0, -0.0, 1e-30])]
}

fn depth_pair() -> impl Strategy<Value = (f32, f32)> {
    // D and its exact complement, to both ends.
    prop_oneof![
        3 => (0.0f32..=1.0).prop_map(|d| (d, 1.0 - d)),
        1 => (-30i32..0).prop_map(|e| (2f32.powi(e), 1.0)),
        1 => (-30i32..0).prop_map(|e| (1.0, 2f32.powi(e))),
        1 => select(vec![(0.0, 1.0), (1.0, 0.0)]),
    ]
}

fn rgb(row: &[f32]) -> Rgb {
    [row[0], row[1], row[2]].map(f64::from)
}

/// How many codes apart two linear colours are once encoded.
fn codes_apart(gpu: [f32; 4], twin: Rgb) -> f64 {
    let gpu = color::srgb_encode([gpu[0], gpu[1], gpu[2]].map(f64::from));
    let twin = color::srgb_encode(twin);
    (0..3)
        .map(|i| (gpu[i] - twin[i]).abs() / twin[i].abs().max(1.0) / ONE_CODE)
        .fold(0.0, f64::max)
}

fn assert_same_color<const N: usize>(row: &[f32; N], gpu: [f32; 4], twin: Rgb) {
    let apart = codes_apart(gpu, twin);
    assert!(
        apart <= 1.0,
        "{row:?}: {gpu:?} on the GPU, {twin:?} in the twin, {apart} codes apart"
    );
}

/// Distance in units in the last place of the expected single.
fn ulps(gpu: f32, twin: f64) -> f64 {
    let unit = f64::from((twin as f32).abs().max(f32::MIN_POSITIVE));
    let ulp = 2f64.powi(unit.log2().floor() as i32 - 23);
    (f64::from(gpu) - twin).abs() / ulp
}

#[test]
fn the_transfer_function_and_oklab_are_their_definitions() {
    for_batches(
        (wide_component(), wide_component(), wide_component()).prop_map(|(r, g, b)| [r, g, b]),
        |rows| {
            let encoded = gpu().evaluate(
                COLOR,
                "return vec4(srgb_encode(vec3(i(0u), i(1u), i(2u))), 0.0);",
                rows,
            );
            let decoded = gpu().evaluate(
                COLOR,
                "return vec4(srgb_decode(vec3(i(0u), i(1u), i(2u))), 0.0);",
                rows,
            );
            let there_and_back = gpu().evaluate(
                COLOR,
                "return vec4(oklab_to_linear(linear_to_oklab(vec3(i(0u), i(1u), i(2u)))), 0.0);",
                rows,
            );
            for (k, row) in rows.iter().enumerate() {
                let c = rgb(row);
                for i in 0..3 {
                    // pow() is exp2(y log2 x): its relative error is that of the
                    // logarithm times the exponent of the result, 2^-16 is far
                    // below a quarter of a code.
                    let close = |got: f32, want: f64| {
                        (f64::from(got) - want).abs() <= 2e-5 * want.abs().max(0.05)
                    };
                    let e = color::srgb_encode_one(c[i]);
                    let d = color::srgb_decode_one(c[i]);
                    assert!(
                        close(encoded[k][i], e),
                        "encode {}: {} for {e}",
                        row[i],
                        encoded[k][i]
                    );
                    assert!(
                        close(decoded[k][i], d),
                        "decode {}: {} for {d}",
                        row[i],
                        decoded[k][i]
                    );
                }
                if row.iter().all(|x| (0.0..=1.0).contains(x)) {
                    assert_same_color(row, there_and_back[k], c);
                }
            }
        },
    );
}

#[test]
fn what_is_no_number_is_replaced() {
    let rows: Vec<[f32; 1]> = [
        f32::NAN,
        -f32::NAN,
        f32::from_bits(0x7f80_0001),
        f32::from_bits(0xffff_ffff),
        f32::INFINITY,
        f32::NEG_INFINITY,
        0.0,
        -0.0,
        1.0,
        -3.5,
        f32::MAX,
        f32::MIN,
        1e-40,
    ]
    .map(|x| [x])
    .to_vec();
    let results = gpu().evaluate(COLOR, "return vec4(finite(i(0u)));", &rows);
    for ([x], result) in rows.iter().zip(results) {
        assert_eq!(
            f64::from(result[0]),
            color::finite(*x),
            "finite({x}) by bits {:#x}",
            x.to_bits()
        );
    }
}

#[test]
fn hue_and_its_color_are_inverse() {
    for_batches(
        (component(), component(), component()).prop_map(|(r, g, b)| [r, g, b]),
        |rows| {
            let body = "let c = vec3(i(0u), i(1u), i(2u)); let h = hue_of(c); return vec4(hue_color(h), h);";
            for (row, result) in rows.iter().zip(gpu().evaluate(COLOR, body, rows)) {
                let twin = color::hue_color(color::hue_of(rgb(row)));
                for i in 0..3 {
                    // The hue has the error of its quotient, six times that in
                    // the colour; 1e-5 is 1/400 of a code.
                    assert!(
                        (f64::from(result[i]) - twin[i]).abs() < 1e-5,
                        "{row:?}: {result:?}, {twin:?}"
                    );
                }
            }
        },
    );
}

fn desaturation_settings() -> impl Strategy<Value = Desaturation> {
    (
        0.0f32..=1.0,
        select(vec![1.0f32, 0.5, 0.25, 2.0, 4.0, 1.7]),
        any::<bool>(),
    )
        .prop_map(|(amount, exponent, faithful)| Desaturation {
            amount,
            exponent,
            method: if faithful {
                ColorMethod::Faithful
            } else {
                ColorMethod::Corrected
            },
        })
}

#[test]
fn desaturation_is_its_twin_and_keeps_greys() {
    let row = (
        desaturation_settings(),
        wide_component(),
        wide_component(),
        wide_component(),
        depth_pair(),
        any::<bool>(),
    )
        .prop_map(|(s, r, g, b, (_, l), grey)| {
            let (g, b) = if grey { (r, r) } else { (g, b) };
            let faithful = f32::from(u8::from(s.method == ColorMethod::Faithful));
            [s.amount, s.exponent, faithful, r, g, b, l]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::styles::desaturation::{Desaturation, desaturate, saturation_left}",
            "var curve = 2u; if i(1u) == 1.0 { curve = 0u; } if i(1u) == 0.5 { curve = 1u; }
             let s = Desaturation(i(0u), i(1u), curve, u(2u));
             let k = saturation_left(s, i(6u));
             return vec4(desaturate(s, vec3(i(3u), i(4u), i(5u)), k), k);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = Desaturation {
                amount: row[0],
                exponent: row[1],
                method: if row[2] == 1.0 {
                    ColorMethod::Faithful
                } else {
                    ColorMethod::Corrected
                },
            };
            let k = desaturation::saturation_left(&s, f64::from(row[6]));
            assert_same_color(row, result, desaturation::desaturate(&s, rgb(&row[3..]), k));
            if s.method == ColorMethod::Faithful && row[3] == row[4] && row[4] == row[5] {
                assert!(
                    result[0] == result[1] && result[1] == result[2],
                    "{row:?}: grey became {result:?}"
                );
            }
        }
    });
}

fn modes() -> impl Strategy<Value = ColorizationMode> {
    select(vec![
        ColorizationMode::Hue,
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::Quadratic,
    ])
}

#[test]
fn colorization_is_its_twin_and_faithful_greys_stay_grey() {
    let row = (
        modes(),
        any::<bool>(),
        0.0f32..360.0,
        0.05f32..=1.0,
        0.05f32..=1.0,
        0.0f32..=1.0,
        (component(), component(), component(), any::<bool>()),
        depth_pair(),
    )
        .prop_map(
            |(mode, faithful, hue, saturation, value, amount, (r, g, b, grey), (d, l))| {
                let (g, b) = if grey { (r, r) } else { (g, b) };
                [
                    mode as u8 as f32,
                    f32::from(u8::from(faithful)),
                    hue,
                    saturation,
                    value,
                    amount,
                    r,
                    g,
                    b,
                    d,
                    l,
                ]
            },
        );
    for_batches(row, |rows| {
        // The shader's settings, from the colour, as the twin derives them.
        let settings: Vec<Colorization> = rows
            .iter()
            .map(|row| Colorization {
                mode: [
                    ColorizationMode::Hue,
                    ColorizationMode::Atmosphere,
                    ColorizationMode::Linear,
                    ColorizationMode::Quadratic,
                ][row[0] as usize],
                method: if row[1] == 1.0 {
                    ColorMethod::Faithful
                } else {
                    ColorMethod::Corrected
                },
                color: Color::hsv(row[2], row[3], row[4]),
                amount: row[5],
            })
            .collect();
        let packed: Vec<[f32; 13]> = rows
            .iter()
            .zip(&settings)
            .map(|(row, s)| {
                let (direction, cusp, chroma) = colorization::atmosphere(s.color);
                [
                    direction[0] as f32,
                    direction[1] as f32,
                    cusp as f32,
                    chroma as f32,
                    Hsva::from(s.color).hue / 360.0,
                    s.amount,
                    row[0],
                    row[1],
                    row[6],
                    row[7],
                    row[8],
                    row[9],
                    row[10],
                ]
            })
            .collect();
        let results = gpu().evaluate(
            "#import bevy_comics::styles::colorization::{Colorization, colorize}",
            "let s = Colorization(vec2(i(0u), i(1u)), i(2u), i(3u), i(4u), i(5u), u(6u), u(7u));
             return vec4(colorize(s, vec3(i(8u), i(9u), i(10u)), i(11u), i(12u), 0.75), 0.0);",
            &packed,
        );
        for ((row, s), result) in rows.iter().zip(&settings).zip(results) {
            let [d, l] = [row[9], row[10]].map(f64::from);
            assert_same_color(
                row,
                result,
                colorization::colorize(s, rgb(&row[6..]), d, l, 0.75),
            );
            if s.method == ColorMethod::Faithful && row[6] == row[7] && row[7] == row[8] {
                assert!(
                    result[0] == result[1] && result[1] == result[2],
                    "{row:?}: grey became {result:?}"
                );
            }
        }
    });
}

#[test]
fn dark_areas_are_their_twin() {
    let row = (
        component(),
        component(),
        component(),
        0.0f32..=1.0,
        0.01f32..=1.0,
        0.0f32..=1.0,
        0.0f32..=1.0,
    )
        .prop_map(|(r, g, b, value, feather, weight, l)| [r, g, b, value, feather, weight, l]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::styles::black_flats::{BlackFlats, dark_area, fill}",
            "let s = BlackFlats(vec3(0.02, 0.0, 0.05), 0.9, 1.0, 2.0, i(3u), i(4u), i(5u), 1.0);
             let c = vec3(i(0u), i(1u), i(2u));
             let dark = dark_area(s, c, i(6u));
             return vec4(fill(s, c, dark), dark);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = BlackFlats {
                value: Some(row[3]),
                feather: row[4],
                depth_weight: row[5],
                color: Color::linear_rgb(0.02, 0.0, 0.05),
                opacity: 0.9,
                slope: None,
            };
            let dark = black_flats::dark_area(&s, rgb(row), f64::from(row[6]));
            // The value is encoded to 2e-5; a ramp of width 2 f t turns that
            // into at most 1.5 * 2e-5 / (2 f t).
            let threshold =
                f64::from(row[3] * row[4]) * (1.0 - f64::from(row[5]) * (1.0 - f64::from(row[6])));
            if threshold > 1e-3 {
                assert!(
                    (f64::from(result[3]) - dark).abs() < 4e-5 / threshold + 1e-5,
                    "{row:?}: {result:?}, {dark}"
                );
                assert_same_color(
                    row,
                    result,
                    black_flats::fill(&s, rgb(row), f64::from(result[3])),
                );
            }
        }
    });
}

const MAP: &str = "#import bevy_comics::depth::map::{DepthFrame, depth_map, depth_step}";
const FRAME: &str = "let f = DepthFrame(i(0u), i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), u(7u));";

/// near, far, offset, floor, `plane_far`, extent, gap, flags, and two depths.
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

/// Ranges from the table of extreme cases, by near plane and distances.
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
    (ranges, offsets, 0.0f64..=1.0, 0.0f64..=1.0, any::<bool>()).prop_map(
        move |((plane, near, far), offset, t, t2, ratio): (
            (f64, f64, f64),
            f64,
            f64,
            f64,
            bool,
        )| {
            // With an offset a the far plane is at plane (1 + a) / a: ranges
            // beyond it are seen by an infinite projection.
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

#[test]
fn the_linear_map_is_within_5_ulp_of_the_exact_quotient() {
    for rows_of in [
        perspective_rows(false).boxed(),
        orthographic_rows(false).boxed(),
    ] {
        for_batches(rows_of, |rows| {
            let results = gpu().evaluate(
                MAP,
                &format!("{FRAME} return vec4(depth_map(f, i(8u)), 0.0, 0.0);"),
                rows,
            );
            for (row, result) in rows.iter().zip(results) {
                if row[0] <= row[1] {
                    continue;
                }
                let [d, l] = frame_of(row).depth_map(f64::from(row[8]));
                for (got, want) in [(result[0], d), (result[1], l)] {
                    assert!(
                        ulps(got, want) <= 5.0,
                        "{row:?}: {got} for {want}, {} ulp",
                        ulps(got, want)
                    );
                }
            }
        });
    }
}

#[test]
fn the_logarithmic_map_keeps_its_relative_precision() {
    // log() may be 3 ulp off, twice, and two divisions 2.5 ulp each; the inputs
    // of an orthographic logarithm are distances that were rounded before.
    for (rows_of, orthographic) in [
        (perspective_rows(true).boxed(), false),
        (orthographic_rows(true).boxed(), true),
    ] {
        for_batches(rows_of, |rows| {
            let results = gpu().evaluate(
                MAP,
                &format!("{FRAME} return vec4(depth_map(f, i(8u)), 0.0, 0.0);"),
                rows,
            );
            for (row, result) in rows.iter().zip(results) {
                if f64::from(row[0]) - f64::from(row[1]) < 1e-3 * f64::from(row[0]) && orthographic
                    || row[0] <= row[1]
                {
                    continue;
                }
                let [d, _] = frame_of(row).depth_map(f64::from(row[8]));
                let tolerance = if orthographic {
                    2e-4
                } else {
                    16.0 * 2f64.powi(-23) * d.max(2f64.powi(-20))
                };
                assert!(
                    (f64::from(result[0]) - d).abs() <= tolerance,
                    "{row:?}: {} for {d}",
                    result[0]
                );
            }
        });
    }
}

#[test]
fn what_is_no_depth_lies_at_the_far_end() {
    let rows: Vec<MapRow> = [
        0.0,
        -0.0,
        1e-40,
        -0.5,
        1.5,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
    ]
    .map(|d| [0.5, 0.001, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, d, 0.0])
    .to_vec();
    for (row, result) in rows.iter().zip(gpu().evaluate(
        MAP,
        &format!("{FRAME} return vec4(depth_map(f, i(8u)), 0.0, 0.0);"),
        &rows,
    )) {
        assert_eq!([result[0], result[1]], [1.0, 0.0], "{}", row[8]);
    }
    // A flat wall is all near; an empty view is all far.
    let flat = [
        0.25,
        0.25,
        0.0,
        1.0 / 16384.0,
        0.0,
        0.0,
        0.05,
        0.0,
        0.25,
        0.0,
    ];
    let mut empty = flat;
    empty[7] = 4.0;
    let results = gpu().evaluate(
        MAP,
        &format!("{FRAME} return vec4(depth_map(f, i(8u)), 0.0, 0.0);"),
        &[flat, empty],
    );
    assert_eq!(results[0][..2], [0.0, 1.0]);
    assert_eq!(results[1][..2], [1.0, 0.0]);
}

#[test]
fn steps_of_the_map_do_not_cancel() {
    for rows_of in [
        perspective_rows(false).boxed(),
        orthographic_rows(false).boxed(),
    ] {
        for_batches(rows_of, |rows| {
            let results = gpu().evaluate(
                MAP,
                &format!("{FRAME} return vec4(depth_step(f, i(8u), i(9u)));"),
                rows,
            );
            for (row, result) in rows.iter().zip(results) {
                if row[0] <= row[1] {
                    continue;
                }
                // D(d) - D(p) in closed form, from the stored depths.
                let [near, far, a, d, p] = [0, 1, 2, 8, 9].map(|k| f64::from(row[k]));
                let step = if row[7] == 0.0 {
                    (p - d) / (near - far) * ((near + a) / (d + a)) * ((far + a) / (p + a))
                } else {
                    (p - d) / (near - far)
                };
                assert!(
                    ulps(result[0], step) <= 10.0,
                    "{row:?}: {} for {step}",
                    result[0]
                );
            }
        });
    }
}

#[test]
fn every_operator_answers_as_its_twin() {
    let depth = || prop_oneof![5 => 0.0f32..=1.0, 1 => select(vec![-1.0f32, 0.0, 1.0, 0.5])];
    let row = (
        (0.01f32..0.9, 0.001f32..0.99),
        0u8..4,
        any::<bool>(),
        0u8..16,
        (depth(), depth(), depth(), depth(), depth()),
        (depth(), depth(), depth(), depth()),
        any::<bool>(),
    )
        .prop_map(
            |((near, ratio), operator, faithful, missing, (a, b, c, d, e), (g, h, k, l), plane)| {
                let far = near * ratio;
                // Fractions of the range; below zero is sky.
                let mut at = |t: f32| {
                    if t < 0.0 {
                        0.0
                    } else {
                        (far + (near - far) * t).clamp(far, near)
                    }
                };
                let mut w = [a, b, c, d, e, g, h, k, l].map(&mut at);
                if plane {
                    let middle = far + 0.5 * (near - far);
                    let (sx, sy) = (
                        (near - far) * 0.2 * (a - 0.5),
                        (near - far) * 0.2 * (b - 0.5),
                    );
                    w = std::array::from_fn(|n| {
                        middle + sx * ((n % 3) as f32 - 1.0) + sy * ((n / 3) as f32 - 1.0)
                    });
                }
                let mut row = [0.0f32; 14];
                row[..2].copy_from_slice(&[near, far]);
                row[2] = f32::from(operator);
                row[3] = f32::from(u8::from(faithful));
                row[4] = f32::from(missing);
                row[5..14].copy_from_slice(&w);
                row
            },
        );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::depth::map::{DepthFrame}
             #import bevy_comics::styles::contours::{Contours, Window, contour_response}",
            "let f = DepthFrame(i(0u), i(1u), 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
             var s: Contours; s.operator_kind = u(2u); s.faithful = u(3u);
             let w = Window(i(5u), i(6u), i(7u), i(8u), i(9u), i(10u), i(11u), i(12u), i(13u), u(4u));
             return vec4(contour_response(s, f, w));",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = Contours {
                operator: [
                    ContourOperator::Prewitt,
                    ContourOperator::Sobel,
                    ContourOperator::Laplace,
                    ContourOperator::Roberts,
                ][row[2] as usize],
                form: if row[3] == 1.0 {
                    ContourForm::Faithful
                } else {
                    ContourForm::PlaneAware
                },
                ..Contours::default()
            };
            let ends = [f64::from(row[0]), f64::from(row[1])];
            let frame = Frame {
                projection: Projection::Perspective { offset: 0.0 },
                ends: Some(ends),
                logarithmic: false,
                floor: 1.0 / 16384.0,
                sky_gap: 0.05,
            };
            let bits = row[4] as u32;
            let win = contours::Window {
                depths: std::array::from_fn(|r| {
                    std::array::from_fn(|c| f64::from(row[5 + 3 * r + c]))
                }),
                missing: [bits & 1 != 0, bits & 2 != 0, bits & 4 != 0, bits & 8 != 0],
            };
            let want = contours::response(&s, &frame, &win);
            // Rounding the plane's continuation moves D by ulp(d) dD/dd, at most
            // 2^-23 near / (near - far) * near / far at the far end; twelve
            // weighted taps.
            let [near, far] = ends;
            let tolerance = 12.0 * 2f64.powi(-22) * near / (near - far) * (near / far).max(1.0)
                + 12.0 * 2f64.powi(-22);
            assert!(
                (f64::from(result[0]) - want).abs() <= tolerance,
                "{row:?}: {} for {want} +- {tolerance}",
                result[0]
            );
        }
    });
}

#[test]
fn no_plane_has_a_contour_at_any_angle() {
    // Raw depth affine in the pixel, from face-on to grazing, over a range of
    // 1 : 1000: the plane-aware operators answer rounding, not slope.
    let rows: Vec<[f32; 10]> = (0..2000)
        .map(|k| {
            let (sx, sy) = (
                ((k % 40) as f32 - 20.0) * 1e-5,
                ((k / 40) as f32 - 25.0) * 1e-5,
            );
            let mut row = [0.0; 10];
            row[0] = (k % 4) as f32;
            for n in 0..9 {
                row[1 + n] = 0.002 + sx * ((n % 3) as f32 - 1.0) + sy * ((n / 3) as f32 - 1.0);
            }
            row
        })
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::{DepthFrame}
         #import bevy_comics::styles::contours::{Contours, Window, contour_response}",
        "let f = DepthFrame(1.0, 0.001, 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
         var s: Contours; s.operator_kind = u(0u);
         let w = Window(i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), i(7u), i(8u), i(9u), 0u);
         return vec4(contour_response(s, f, w));",
        &rows,
    );
    let worst = results.iter().map(|r| r[0]).fold(0.0, f32::max);
    assert!(worst < 1e-4, "a plane answers {worst}");
}
