//! Colour conversions and the effects that change colour.

use super::*;

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
                    // pow(x, y) is exp2(y * log2(x)): its relative error is ln 2 times
                    // the error of the exponent, about 2^-16. A quarter of a code is
                    // 2^-10.
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
                let reference = color::hue_color(color::hue_of(rgb(row)));
                for i in 0..3 {
                    // The error of the hue is that of a quotient, and the colour
                    // changes six times as fast as the hue. 1e-5 is 1/400 of a code.
                    assert!(
                        (f64::from(result[i]) - reference[i]).abs() < 1e-5,
                        "{row:?}: {result:?}, {reference:?}"
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
            equations: if faithful {
                Equations::Faithful
            } else {
                Equations::Corrected
            },
        })
}

#[test]
fn desaturation_matches_the_reference_and_keeps_greys() {
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
            let faithful = f32::from(u8::from(s.equations == Equations::Faithful));
            [s.amount, s.exponent, faithful, r, g, b, l]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effects::desaturation::{Desaturation, desaturate, saturation_left}",
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
                equations: if row[2] == 1.0 {
                    Equations::Faithful
                } else {
                    Equations::Corrected
                },
            };
            let k = desaturation::saturation_left(&s, f64::from(row[6]));
            assert_same_color(row, result, desaturation::desaturate(&s, rgb(&row[3..]), k));
            if s.equations == Equations::Faithful && row[3] == row[4] && row[4] == row[5] {
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
        ColorizationMode::KeepHue,
        ColorizationMode::Atmosphere,
        ColorizationMode::Linear,
        ColorizationMode::Quadratic,
    ])
}

#[test]
fn colorization_matches_the_reference_and_faithful_greys_stay_grey() {
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
        // `packed` holds what the shader takes; the reference derives it from the colour.
        let settings: Vec<Colorization> = rows
            .iter()
            .map(|row| Colorization {
                mode: [
                    ColorizationMode::KeepHue,
                    ColorizationMode::Atmosphere,
                    ColorizationMode::Linear,
                    ColorizationMode::Quadratic,
                ][row[0] as usize],
                equations: if row[1] == 1.0 {
                    Equations::Faithful
                } else {
                    Equations::Corrected
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
            "#import bevy_comics::effects::colorization::{Colorization, colorize}",
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
            if s.equations == Equations::Faithful && row[6] == row[7] && row[7] == row[8] {
                assert!(
                    result[0] == result[1] && result[1] == result[2],
                    "{row:?}: grey became {result:?}"
                );
            }
        }
    });
}

#[test]
fn dark_areas_match_the_reference() {
    let row = (
        component(),
        component(),
        component(),
        0.0f32..=1.0,
        0.01f32..=1.0,
        0.0f32..=1.0,
        0.0f32..=1.0,
    )
        .prop_map(|(r, g, b, value, softness, weight, l)| [r, g, b, value, softness, weight, l]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effects::black_flats::{BlackFlats, dark_area, fill}",
            "let s = BlackFlats(vec3(0.02, 0.0, 0.05), 0.9, 1.0, 2.0, i(3u), i(4u), i(5u), 1.0);
             let c = vec3(i(0u), i(1u), i(2u));
             let dark = dark_area(s, c, i(6u));
             return vec4(fill(s, vec4(c, i(6u)), dark), dark);",
            rows,
        );
        for (row, result) in rows.iter().zip(results) {
            let s = BlackFlats {
                value: Some(row[3]),
                softness: row[4],
                depth_weight: row[5],
                color: Color::linear_rgb(0.02, 0.0, 0.05),
                opacity: 0.9,
                slope: None,
            };
            let dark = black_flats::dark_area(&s, rgb(row), f64::from(row[6]));
            // The encoded value has an error of 2e-5. `threshold` is half the width of
            // the ramp, whose steepest slope is 0.75 / threshold.
            let threshold =
                f64::from(row[3] * row[4]) * (1.0 - f64::from(row[5]) * (1.0 - f64::from(row[6])));
            if threshold > 1e-3 {
                assert!(
                    (f64::from(result[3]) - dark).abs() < 4e-5 / threshold + 1e-5,
                    "{row:?}: {result:?}, {dark}"
                );
                let [r, g, b] = rgb(row);
                let picture = [r, g, b, f64::from(row[6])];
                assert_same_color(
                    row,
                    result,
                    black_flats::fill(&s, picture, f64::from(result[3])),
                );
            }
        }
    });
}
