//! How exactly the page is printed and painted, how many texels its effects fetch, and how exactly
//! a harmony of colors keeps the lightness.

use bevy_comics::{
    ColorHarmony, Halftone,
    effects::{FocusStyle, HarmonyMode, HatchingKind, PaintKernel},
};
use bevy_comics_testkit::{
    page_work::{self, PageCounter},
    painting::{RADII, SLOPES, bled, edge_moved, kuwahara_error},
    reference::{color, color_harmony::harmonize, halftone::Plate},
    screens::{
        CELL_SIZES, SHAPES, color_error, gray_inks, ideal, in_phase, largest_jump, moire,
        moire_of_inks, tone_error,
    },
    strokes::{largest_tone_step, mean_tone_error},
};

use crate::{Run, table::Table};

pub fn measure(run: &Run) -> Result<(), String> {
    run.save("page_screens", &screens(run))?;
    run.save("page_colors", &colors(run))?;
    run.say("colors printed");
    run.save("page_errors", &errors(run))?;
    run.save("page_harmonies", &harmonies(run))?;
    run.say("painted");
    let mut table = Table::new("effect,texels,most,bytes");
    let mut counter = PageCounter::default();
    for (name, style) in run.some(4, page_work::effects()) {
        let work = counter.count(name, &style);
        table.push(&[
            &name.replace(',', ";"),
            &format!("{:.2}", work.texels[0]),
            &format!("{:.0}", work.texels[1]),
            &format!("{:.2}", work.bytes),
        ]);
    }
    run.say("texels of the page counted");
    run.save("page_work", &table)
}

/// The largest change of the lightness in `OKLab` by a harmony, of 32 x 32 x 32 colors at three
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

/// Tones, jumps and moire of all screens.
fn screens(run: &Run) -> Table {
    let mut table = Table::new("what,period,tone,jump,moire");
    let periods = run.pick(&CELL_SIZES[2..3], &CELL_SIZES[..]).to_vec();
    for shape in run.some(1, SHAPES) {
        for &period in &periods {
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
    table
}

/// Colors of four inks: ideal ones, ones that all take some of all light, and these without the
/// phase of black.
fn colors(run: &Run) -> Table {
    let mut table = Table::new("black,ideal,gray,in_phase,beats");
    for black in run.some(1, [0.0, 0.5, 1.0]) {
        let s = Halftone {
            black_generation: black,
            ..ideal()
        };
        let real = gray_inks(s);
        let cell = |error: f64| format!("{error:.5}");
        table.push(&[
            &black,
            &cell(color_error(&s, Plate::all(&s, 1.0))),
            &cell(color_error(&real, Plate::all(&real, 1.0))),
            &cell(color_error(&real, in_phase(&real))),
            &cell(beats(black)),
        ]);
    }
    table
}

/// The slow part of a gray print with the default inks.
fn beats(black_generation: f32) -> f64 {
    let s = Halftone {
        black_generation,
        ..Halftone::default()
    };
    f64::max(moire_of_inks(&s, false), moire_of_inks(&s, true))
}

/// Errors of single effects with their limits. The names are those of the times.
fn errors(run: &Run) -> Table {
    let samples = if run.quick { 64 } else { 16384 };
    let radii = run.some(1, RADII);
    let largest =
        |errors: &mut dyn Iterator<Item = f64>| errors.fold(0.0, |a, b| f64::max(a, b.abs()));
    let kuwahara = largest(&mut run.some(1, [2, 4, 6]).into_iter().map(kuwahara_error));
    let edges = |form| {
        let slopes = run.some(1, SLOPES).into_iter();
        let cases = slopes.flat_map(|slope| radii.iter().map(move |r| (slope, *r)));
        largest(&mut cases.map(|(slope, radius)| edge_moved(form, radius, slope)))
    };
    let classic = "difference from Kuwahara's quadrants; linear light";
    let position = "movement of edges; px";
    let colors = "colors of a sharp figure outside it; linear light";
    let mut table = Table::new("effect,what,error,limit");
    let mut push = |effect: &str, what: &str, error: f64, limit: f64| {
        table.push(&[&effect, &what, &format!("{error:.2e}"), &limit]);
    };
    push("paint", classic, kuwahara, 1e-3);
    push("paint", position, edges(PaintKernel::Box), 0.1);
    let along = "paint; strokes along edges";
    push(along, position, edges(PaintKernel::Anisotropic), 0.1);
    let tones = "mean tone; 20 tones; 9 angles; 32 zooms";
    let random = "the same with breaks";
    let mean = |kind, random| {
        // A window of 160 pixels, or random places.
        let samples = if random > 0.0 {
            samples / 2
        } else {
            samples * 25 / 16
        };
        mean_tone_error(kind, random, samples)
    };
    push("hatching", tones, mean(HatchingKind::Strokes, 0.0), 0.01);
    push("hatching", random, mean(HatchingKind::Strokes, 0.6), 0.03);
    let random = "the same with dots that stray and vary";
    push("hatching; dots", tones, mean(HatchingKind::Dots, 0.0), 0.01);
    push(
        "hatching; dots",
        random,
        mean(HatchingKind::Dots, 0.6),
        0.03,
    );
    let steps = "change of a tone by a step of the dial of 1/200; bands";
    push("abstraction", steps, largest_tone_step(), 0.02);
    push("focus; blur", colors, bled(FocusStyle::Blur), 0.0);
    push("focus; offset", colors, bled(FocusStyle::Offset), 0.0);
    push("focus; paint", colors, bled(FocusStyle::Paint), 0.0);
    table
}

/// The largest changes of lightness by all harmonies.
fn harmonies(run: &Run) -> Table {
    let mut harmonies = Table::new("mode,lightness");
    let modes = [
        HarmonyMode::TwoHues,
        HarmonyMode::Distance,
        HarmonyMode::Rotation,
        HarmonyMode::Shade,
    ];
    for mode in run.some(1, modes) {
        let error = lightness_error(mode);
        harmonies.push(&[&format!("{mode:?}"), &format!("{error:.5}")]);
    }
    harmonies
}
