//! Screens and plates.

use bevy_comics_testkit::reference::{
    blue_noise::blue_noise,
    halftone::{Plate, inked, plate_cover, plate_tones, screen_amount},
    screen,
};

use super::*;
use crate::prelude::*;

const HALFTONE: &str = "#import bevy_comics::effects::halftone::{
        Halftone, inked, page_screen, plate_cover, plate_tones, screen_amount,
    }
    #import bevy_comics::effect::color::separated
    #import bevy_comics::effect::screen::{cos_turn, gained, sin_turn, tinted}";

/// Places up to 2000 pixels from the middle, tones with both ends, periods from 2 to 40.
/// The slope of a coverage is up to one per pixel, and places are exact to an eighth of a
/// thousandth there.
#[test]
fn coverages_of_all_shapes_match_the_reference() {
    let tone = prop_oneof![
        4 => 0.0f32..=1.0,
        1 => select(vec![0.0, 1.0, 0.5, 0.01, 0.995, 0.785, 0.786, 1.0 / 32.0, 31.0 / 32.0]),
    ];
    let row = (
        (-2000.0f32..2000.0, -2000.0f32..2000.0),
        tone,
        2.0f32..40.0,
        -180.0f32..180.0,
        0u32..4,
        (0.0f32..3.0, -1.0f32..=1.0),
    )
        .prop_map(|((x, y), tone, period, degrees, plate, (spread, height))| {
            [x, y, tone, period, degrees, plate as f32, spread, height]
        });
    for shape in SHAPES {
        let number = shape as u32;
        for_batches(row.clone(), |rows| {
            let results = gpu().evaluate(
                HALFTONE,
                &format!(
                    "var s: Halftone;
                     let turn = i(4u) * 0.017453292519943295;
                     s.cosines = vec4(cos(turn)) / i(3u);
                     s.sines = vec4(sin(turn)) / i(3u);
                     s.cell_size = i(3u);
                     s.grain = max(i(3u) / 3.0, 1.0);
                     s.shape = {number}u;
                     s.spread = i(6u);
                     let on = page_screen(s, i(7u));
                     let k = plate_cover(s, on, vec2(i(0u), i(1u)), i32(i(5u)), i(2u));
                     return vec4(k, s.cosines.x, s.sines.x, 0.0);"
                ),
                rows,
            );
            for (row, found) in rows.iter().zip(results) {
                let spread = f64::from(row[6]);
                // The angle as the adapter's cosine has it: its error would move places
                // far away by pixels.
                let degrees = f64::from(found[2]).atan2(f64::from(found[1])).to_degrees();
                let scale = f64::from(found[1]).hypot(f64::from(found[2]));
                let plate = Plate {
                    degrees,
                    period: 1.0 / scale,
                    phase: if row[5] == 3.0 { 0.25 } else { 0.0 },
                    number: row[5] as i32,
                    spread,
                    height: f64::from(row[7]),
                };
                let tone = f64::from(row[2]);
                let place = [0, 1].map(|i| f64::from(row[i]));
                let want = plate_cover(shape, plate, tone, &blue_noise)(place);
                let apart = (f64::from(found[0]) - want).abs();
                assert!(apart < 0.01, "{shape:?}, {row:?}: {found:?}, {want}");
            }
        });
    }
}

#[test]
fn tones_of_all_modes_match_the_reference() {
    let row = || {
        (
            (wide_component(), wide_component(), wide_component()),
            component(),
            0.0f32..0.3,
            0u32..7,
            (0.0f32..0.5, 0.5f32..=1.0),
        )
            .prop_map(|((r, g, b), black, gain, tints, (low, high))| {
                [r, g, b, black, gain, tints as f32, low, high]
            })
    };
    for mode in [
        HalftoneMode::Cmyk,
        HalftoneMode::Spot,
        HalftoneMode::Duotone,
        HalftoneMode::Rgb,
    ] {
        let number = mode as u32;
        let s = Halftone {
            mode,
            cyan: Color::srgb(0.9, 0.3, 0.2),
            ..Halftone::default()
        };
        let ink = bevy_comics::effect::linear_rgb(s.cyan);
        let pivot = 1.0 - (0.2126 * ink.x + 0.7152 * ink.y + 0.0722 * ink.z);
        for_batches(row(), |rows| {
            let results = gpu().evaluate(
                HALFTONE,
                &format!(
                    "var s: Halftone;
                     s.mode = {number}u;
                     s.pivot = {pivot:?};
                     s.black_generation = i(3u);
                     s.gain = i(4u);
                     s.tints = i(5u);
                     s.shadows = i(6u);
                     s.contrast = 1.0 / max(i(7u) - i(6u), 0.05);
                     return plate_tones(s, vec3(i(0u), i(1u), i(2u)));"
                ),
                rows,
            );
            for (row, found) in rows.iter().zip(results) {
                let s = Halftone {
                    black_generation: row[3],
                    gain: row[4],
                    tints: row[5] as u32,
                    shadows: row[6],
                    highlights: row[7],
                    ..s
                };
                let want = plate_tones(&s, rgb(row));
                // A tint changes within a tenth of a step: 15 times as fast as the tone,
                // twice that where dots gain most. A short range of lightness is
                // stretched, up to 20 times. Inks are divided by the light that black
                // lets through: under solid black every amount is as good.
                let slope = if s.tints > 0 { 60.0 } else { 2.5 };
                let stretch = f64::from(1.0 / (row[7] - row[6]).max(0.05));
                let most = f64::from(row[0].max(row[1]).max(row[2]).clamp(0.0, 1.0));
                let level = ((most.sqrt() - f64::from(row[6])) * stretch).clamp(0.0, 1.0);
                let through = match mode {
                    HalftoneMode::Cmyk => 1.0 - f64::from(row[3]) * (1.0 - level * level),
                    _ => 1.0,
                };
                for (found, want) in found.into_iter().zip(want) {
                    let apart = (f64::from(found) - want).abs();
                    assert!(
                        apart * through < 1e-6 * (3.0 + stretch) * slope,
                        "{mode:?} {row:?}: {found}, {want}"
                    );
                }
            }
        });
    }
}

#[test]
fn inks_and_amounts_match_the_reference() {
    let row = (
        [component(), component(), component(), component()],
        component(),
        component(),
        component(),
    )
        .prop_map(|([c, m, y, k], near, depth, below)| [c, m, y, k, near, depth, below]);
    let s = Halftone::default();
    let vector = |ink: Color| {
        let c = bevy_comics::effect::linear_rgb(ink);
        format!("vec3({:?}, {:?}, {:?})", c.x, c.y, c.z)
    };
    let [cyan, magenta, yellow, black, paper] =
        [s.cyan, s.magenta, s.yellow, s.black, s.paper].map(vector);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HALFTONE,
            &format!(
                "var s: Halftone;
                 s.cyan = vec4(1.0 - {cyan}, 0.0); s.magenta = vec4(1.0 - {magenta}, 0.0);
                 s.yellow = vec4(1.0 - {yellow}, 0.0); s.black = vec4(1.0 - {black}, 0.0);
                 s.paper = {paper};
                 s.at_near = i(4u); s.at_far = 0.25; s.shadows_only_below = i(6u);
                 let k = vec4(i(0u), i(1u), i(2u), i(3u));
                 return vec4(inked(s, k), screen_amount(s, k.xyz, i(5u)));"
            ),
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let s = Halftone {
                at_near: row[4],
                at_far: 0.25,
                shadows_only_below: row[6],
                ..s
            };
            let k = [0, 1, 2, 3].map(|i| f64::from(row[i]));
            let want = inked(&s, k);
            let amount = screen_amount(&s, rgb(row), f64::from(row[5]));
            for i in 0..3 {
                assert!((f64::from(found[i]) - want[i]).abs() < 1e-6, "{row:?}");
            }
            assert!(
                (f64::from(found[3]) - amount).abs() < 2e-5,
                "{row:?}: {found:?}, {amount}"
            );
        }
    });
}

#[test]
fn small_functions_match_the_reference() {
    let row = (-300.0f32..300.0, component(), 0.0f32..0.3, 0u32..13)
        .prop_map(|(turn, tone, gain, tints)| [turn, tone, gain, tints as f32]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HALFTONE,
            "return vec4(cos_turn(i(0u)), sin_turn(i(0u)), gained(i(1u), i(2u)), tinted(i(1u), i(3u)));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let turn = f64::from(row[0]) * std::f64::consts::TAU;
            let tone = f64::from(row[1]);
            let want = [
                turn.cos(),
                turn.sin(),
                screen::gained(tone, f64::from(row[2])),
                screen::tinted(tone, row[3] as u32),
            ];
            // Turns are exact to 2^-15 of one, 2e-4 in their cosine.
            for (i, most) in [4e-4, 4e-4, 1e-6, 1e-4].into_iter().enumerate() {
                assert!(
                    (f64::from(found[i]) - want[i]).abs() < most,
                    "{row:?}: {found:?}"
                );
            }
        }
    });
}

/// With ideal inks, the plates have the colour: what black takes is given back.
#[test]
fn separation_matches_the_reference_and_exact() {
    let row = ([component(), component(), component()], component())
        .prop_map(|([r, g, b], black)| [r, g, b, black]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            HALFTONE,
            "return separated(vec3(i(0u), i(1u), i(2u)), i(3u));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = color::separated(rgb(row), f64::from(row[3]));
            let found = found.map(f64::from);
            for i in 0..4 {
                // Where next to nothing is left for the inks, they do not matter.
                let matters = if i < 3 { 1.0 - want[3] } else { 1.0 };
                assert!(
                    (found[i] - want[i]).abs() * matters < 1e-6,
                    "{row:?}: {found:?}"
                );
            }
            for c in 0..3 {
                let light = (1.0 - found[c]) * (1.0 - found[3]);
                assert!((light - f64::from(row[c])).abs() < 1e-6, "{row:?}: {light}");
            }
        }
    });
}
