//! Codes of cracks, and tone bands.

use bevy_comics_testkit::reference::crack;

use super::*;
use crate::prelude::*;

/// Opacities and half widths half way between two codes, and what is a few roundings above and
/// below them, have one code: the lower.
#[test]
fn what_is_half_way_between_two_codes_is_stored_one_way() {
    // Odd tenths as bytes; as widths, k + 1/2 steps of 1/512, less the 1/8 that is added when
    // they are packed.
    let tenths = [0.1f32, 0.3, 0.5, 0.7, 0.9];
    let halves = [513u16, 601, 777, 1001].map(|k| (f32::from(k) + 0.5) / 512.0 - 0.125);
    let pairs = tenths.into_iter().flat_map(|x| halves.map(|y| [x, y]));
    let moved = |x: f32, ulps: i32| f32::from_bits(x.to_bits().wrapping_add_signed(ulps));
    let rows: Vec<[f32; 2]> = pairs
        .flat_map(|pair| (-3..=3).map(move |ulps| pair.map(|x| moved(x, ulps))))
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::lines::edge::{pack_ink, unpack_crack}",
        "let back = unpack_crack(pack_ink(vec4(1.0), vec4(i(0u)), vec4(i(1u))).x | 13u);
         return vec4(back.opacity * 255.0, (back.half_width + 0.125) * 512.0, 0.0, 0.0);",
        &rows,
    );
    for (row, result) in rows.iter().zip(results) {
        let lower = [row[0] * 255.0, (row[1] + 0.125) * 512.0].map(|code| (code - 0.25).floor());
        assert_eq!([result[0].round(), result[1]], lower, "{row:?}");
        let byte = crack::stored_byte(f64::from(row[0])) * 255.0;
        let width = (crack::stored_width(f64::from(row[1])) + 0.125) * 512.0;
        assert_eq!([byte.round() as f32, width as f32], lower, "{row:?}");
    }
}

const BANDS: &str = "#import bevy_comics::effects::tone_bands::{ToneBands, banded_color}";

/// Truth: the tones of \[CL\] Eq. 6 increase strictly with the code, and white becomes 0.83. (The
/// ranges in print omit the codes 85, 86, 169 and 170.)
#[test]
fn equation_6_is_closed_monotone_and_makes_white_0_83() {
    let codes = (0..=255u8).map(|c| f32::from(c) / 255.0);
    let rows: Vec<[f32; 1]> = codes.chain([0.5]).map(|c| [c]).collect();
    let found = gpu().evaluate_alone(
        &[("EFFECT_TONE_BANDS_FAITHFUL", None)],
        &format!("{COLOR}\n{BANDS}"),
        "let s = ToneBands(5.0, 1.0, 1.0);
         return vec4(srgb_encode(banded_color(s, srgb_decode(vec3(i(0u))), 0.0, 0.0)), 0.0);",
        &rows,
    );
    let increases = found[..256].windows(2).all(|w| w[1][0] > w[0][0]);
    assert!(increases, "{found:?}");
    // The powers of both conversions are exact to 2e-5.
    for (found, want) in [(found[255][0], 0.83), (found[256][0], 0.415)] {
        assert!((found - want).abs() < 4e-5, "{found} for {want}");
    }
}

/// Truth: each of the levels is one tone, that of the middle of its band, and keeps the color.
#[test]
fn the_levels_are_as_many_as_asked_and_keep_the_chroma() {
    let rows: Vec<[f32; 2]> = (2..=8u8)
        .flat_map(|levels| (0..4094u16).map(move |n| [f32::from(levels), f32::from(n) / 4093.0]))
        .collect();
    let results = gpu().evaluate(
        BANDS,
        "let s = ToneBands(i(0u), 0.0, 1.0); let y = i(1u) * i(1u);
         let red = banded_color(s, y * vec3(0.2, 0.05, 0.02), 0.0, 0.0);
         return vec4(banded_color(s, vec3(y), 0.0, 0.0).x, red);",
        &rows,
    );
    for ([levels, v], [gray, r, g, b]) in rows.into_iter().zip(results) {
        // Leaves out lightnesses within a code of a step.
        let t = v * levels;
        if (t - t.round()).abs() > levels / 255.0 {
            let middle = (t.floor() + 0.5) / levels;
            assert!((gray.sqrt() - middle).abs() < 1e-4, "{v} of {levels}");
        }
        let kept = (g / r - 0.25).abs() < 1e-5 && (b / r - 0.1).abs() < 1e-5;
        assert!(v < 0.01 || kept, "{v} of {levels}: {r}, {g}, {b}");
    }
}
