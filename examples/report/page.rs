//! How exactly the page is printed and painted, and how many texels its effects fetch.

use bevy_comics::{FocusStyle, Halftone, PaintForm};
use bevy_comics_testkit::{
    page_work,
    painting::{RADII, SLOPES, bled, edge_moved, kuwahara_error},
    reference::halftone::Plate,
    screens::{
        PERIODS, SHAPES, color_error, grey_inks, ideal, in_phase, largest_jump, moire, tone_error,
    },
};

use crate::{Run, table::Table};

pub fn measure(run: &Run) -> Result<(), String> {
    run.save("page_screens", &screens(run))?;
    run.save("page_colors", &colors())?;
    run.save("page_errors", &errors())?;
    run.say("painted");
    let mut table = Table::new(&["effect", "texels", "most", "bytes"]);
    for (name, style) in page_work::effects() {
        let work = page_work::count(name, &style);
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

/// Tones, jumps and moire of all screens.
fn screens(run: &Run) -> Table {
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
    table
}

/// Colours of four inks: ideal ones, ones that all take some of all light, and these without the
/// phase of black.
fn colors() -> Table {
    let mut table = Table::new(&["black", "ideal", "grey", "in_phase"]);
    for black in [0.0, 0.5, 1.0] {
        let s = Halftone {
            black_generation: black,
            ..ideal()
        };
        let real = grey_inks(s);
        let cell = |error: f64| format!("{error:.5}");
        table.push(&[
            &black,
            &cell(color_error(&s, Plate::all(&s, 1.0))),
            &cell(color_error(&real, Plate::all(&real, 1.0))),
            &cell(color_error(&real, in_phase(&real))),
        ]);
    }
    table
}

/// Errors of single effects with their limits. The names are those of the times.
fn errors() -> Table {
    let largest =
        |errors: &mut dyn Iterator<Item = f64>| errors.fold(0.0, |a, b| f64::max(a, b.abs()));
    let kuwahara = largest(&mut [2, 4, 6].into_iter().map(kuwahara_error));
    let edges = |form| {
        let cases = SLOPES
            .into_iter()
            .flat_map(|slope| RADII.map(|r| (slope, r)));
        largest(&mut cases.map(|(slope, radius)| edge_moved(form, radius, slope)))
    };
    let classic = "difference from Kuwahara's quadrants; linear light";
    let position = "movement of edges; px";
    let colors = "colours of a sharp figure outside it; linear light";
    let mut table = Table::new(&["effect", "what", "error", "limit"]);
    let mut push = |effect: &str, what: &str, error: f64, limit: f64| {
        table.push(&[&effect, &what, &format!("{error:.2e}"), &limit]);
    };
    push("paint", classic, kuwahara, 1e-3);
    push("paint", position, edges(PaintForm::Box), 0.1);
    let along = "paint; strokes along edges";
    push(along, position, edges(PaintForm::Anisotropic), 0.1);
    push("focus; blur", colors, bled(FocusStyle::Blur), 0.0);
    push("focus; offset", colors, bled(FocusStyle::Offset), 0.0);
    push("focus; paint", colors, bled(FocusStyle::Paint), 0.0);
    table
}
