//! How exactly the page is printed: tones of screens, jumps between tones, moire, and colours of
//! four inks; and how exactly a harmony of colours keeps the lightness.

use bevy_comics::{ColorHarmony, Halftone, HarmonyMode};
use bevy_comics_testkit::{
    reference::{color, color_harmony::harmonize, halftone::plate_tones},
    screens::{PERIODS, SHAPES, colors, ideal, largest_jump, moire, printed_mean, tone_error},
};

use crate::{Run, table::Table};

/// The largest difference of the mean light of a print from its colour, of 20 colours.
fn color_error(black_generation: f32) -> f64 {
    let s = Halftone {
        black_generation,
        ..ideal()
    };
    let differences = colors().flat_map(|light| {
        let printed = printed_mean(&s, plate_tones(&s, light), 0.25);
        [0, 1, 2].map(|c| (printed[c] - light[c]).abs())
    });
    differences.fold(0.0, f64::max)
}

/// The largest change of the lightness in OKLab by a harmony, of 32 x 32 x 32 colours at three
/// places in the depth map; the complement is as strong as it can be.
fn lightness_error(mode: HarmonyMode) -> f64 {
    let s = ColorHarmony {
        mode,
        complement: 1.5,
        shade: 1.0,
        pull: 1.0,
        ..ColorHarmony::default()
    };
    let mut largest = 0.0;
    for i in 0..32 * 32 * 32u32 {
        let light = [i % 32, i / 32 % 32, i / 1024].map(|x| f64::from(x) / 31.0);
        for d in [0.0, 0.5, 1.0] {
            let [before, after] = [light, harmonize(&s, light, d, 1.0 - d)]
                .map(|light| color::linear_to_oklab(light)[0]);
            largest = f64::max(largest, (before - after).abs());
        }
    }
    largest
}

pub fn measure(run: &Run) -> Result<(), String> {
    let mut table = Table::new(&["what", "period", "tone", "jump", "moire"]);
    let periods = if run.quick { &PERIODS[2..3] } else { &PERIODS };
    for shape in SHAPES {
        for &period in periods {
            let (tone, ..) = tone_error(shape, period);
            let (jump, _) = largest_jump(shape, period);
            let angles = [0.0, 15.0, 45.0];
            let slow = angles.map(|degrees| {
                let [gradient, rings] =
                    [false, true].map(|zones| moire(shape, period, degrees, zones));
                gradient.max(rings)
            });
            let slow = slow.into_iter().fold(0.0, f64::max);
            table.push(&[
                &format!("{shape:?}"),
                &period,
                &format!("{tone:.5}"),
                &format!("{jump:.5}"),
                &format!("{slow:.6}"),
            ]);
        }
        run.say(&format!("{shape:?}: printed"));
    }
    run.save("page_screens", &table)?;
    let mut colors = Table::new(&["black", "error"]);
    for black in [0.0, 0.5, 1.0] {
        colors.push(&[&black, &format!("{:.5}", color_error(black))]);
    }
    run.save("page_colors", &colors)?;
    let mut harmonies = Table::new(&["mode", "lightness"]);
    for mode in [
        HarmonyMode::TwoHues,
        HarmonyMode::Distance,
        HarmonyMode::Rotation,
        HarmonyMode::Shade,
    ] {
        let error = lightness_error(mode);
        harmonies.push(&[&format!("{mode:?}"), &format!("{error:.5}")]);
    }
    run.save("page_harmonies", &harmonies)
}
