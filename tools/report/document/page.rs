//! The report's text: how exactly the page is printed and painted, and which targets of its
//! effects are met.

use std::{fmt::Write, path::Path};

use super::target::Target;
use crate::{
    costs::{Cost, OWN, costs},
    load,
    table::Table,
};

/// The largest number of a column of the screens of a shape, of periods of 4 pixels and more or of
/// the finer ones.
fn largest(screens: &Table, shape: &str, fine: bool, column: &str) -> f64 {
    let rows = screens.matching(&[("what", shape)]);
    let rows = rows
        .iter()
        .filter(|row| (screens.number(row, "period") < 4.0) == fine);
    rows.map(|row| screens.number(row, column).abs())
        .fold(f64::NAN, f64::max)
}

pub fn page(out: &mut String, folder: &Path) -> Result<(), String> {
    let table = load(folder, "page_screens")?;
    out.push_str(
        "### The printed page\n\n\
         Errors of single plates in double precision, which the shader equals within rounding (`tests/gpu/halftone.rs`), \
         the largest of periods of 4 pixels and more. Tone: of the mean of a flat area, of 11 tones at four angles. Jump: \
         the change of a pixel when the tone changes by 1/1024. Moire: the part of the power of a print less its picture \
         that is below half of the screen's frequency, of a gradient and of rings that become finer:\n\n\
         | screen | tone | jump | moire | tone at 3 px |\n|---|---|---|---|---|\n",
    );
    for shape in table.values("what") {
        let of = |column| largest(&table, &shape, false, column);
        let _ = writeln!(
            out,
            "| {} | {:.4} | {:.3} | {:.2} % | {:.4} |",
            shape.to_lowercase(),
            of("tone"),
            of("jump"),
            100.0 * of("moire"),
            largest(&table, &shape, true, "tone"),
        );
    }
    let colors = load(folder, "page_colors")?;
    out.push_str(
        "\nThe largest difference of the mean light of a print with four inks from that of independent screens, of 20 \
         colors, three grays and three lights each, by the fraction of gray that is printed in black. Gray inks: cyan and \
         magenta take some of all light, so that it counts whether screens are independent. In phase: the same, with \
         black's screen not shifted. Beats: the slow part of the light of a gray gradient or of gray rings, with the \
         default inks and all plates.\n\n\
         | black | ideal inks | gray inks | in phase | beats |\n|---|---|---|---|---|\n",
    );
    for row in &colors.rows {
        let of = |column| colors.number(row, column);
        let _ = writeln!(
            out,
            "| {} | {:.4} | {:.4} | {:.4} | {:.2} % |",
            colors.cell(row, "black"),
            of("ideal"),
            of("gray"),
            of("in_phase"),
            100.0 * of("beats"),
        );
    }
    let harmonies = load(folder, "page_harmonies")?;
    out.push_str(
        "\nThe largest change of the lightness in OKLab (0 to 1) by a `ColorHarmony`, of 32 x 32 x 32 colors at three \
         places in the depth map, with the strongest change of hue:\n\n\
         | mode | change |\n|---|---|\n",
    );
    for row in &harmonies.rows {
        let _ = writeln!(
            out,
            "| {} | {:.4} |",
            harmonies.cell(row, "mode"),
            harmonies.number(row, "lightness")
        );
    }
    work(out, &load(folder, "page_work")?);
    out.push_str("Their times are under \"Effects of the page\" and \"Single parts\".\n\n");
    Ok(())
}

/// What the effects fetch.
fn work(out: &mut String, table: &Table) {
    out.push_str(
        "\nTexels and bytes that all passes of an effect fetch per pixel, counted in the shaders on the teapot at 160x90. \
         A place between texels counts as four, and a repeated load each time, though compilers merge those of grains.\n\n\
         | | texels, mean (most) | bytes |\n|---|---|---|\n",
    );
    for row in &table.rows {
        let cell = |name| table.cell(row, name);
        let _ = writeln!(
            out,
            "| {} | {} ({}) | {} |",
            cell("effect"),
            cell("texels"),
            cell("most"),
            cell("bytes")
        );
    }
    out.push('\n');
}

/// The limit of the time of an effect over that of one pass, in blits.
const MOST_BLITS: f64 = 2.5;
/// An effect of one pass that computes little.
const ONE_PASS: &str = "two tones";

/// The effects whose errors are those of the screens of a shape.
const PRINTS: [(&str, &str); 5] = [
    ("halftone of one ink", "Round"),
    ("halftone of four inks", "Euclidean"),
    ("halftone of four inks in grains", "Stochastic"),
    ("halftone of four inks; whole dots", "Euclidean"),
    ("focus; dots", "Euclidean"),
];
/// Several effects.
const SEVERAL: [&str; 1] = ["halftone; misregistration and paper"];

/// An effect of the page: its cost, its errors, and its time over that of one pass.
struct Effect {
    cost: Cost,
    errors: Vec<Target>,
    over: Target,
}

/// The tables that errors of effects are in.
struct Errors {
    screens: Table,
    colors: Table,
    errors: Table,
    harmonies: Table,
}

impl Errors {
    fn load(folder: &Path) -> Result<Self, String> {
        Ok(Self {
            screens: load(folder, "page_screens")?,
            colors: load(folder, "page_colors")?,
            errors: load(folder, "page_errors")?,
            harmonies: load(folder, "page_harmonies")?,
        })
    }

    /// The errors of an effect.
    fn of(&self, effect: &str) -> Vec<Target> {
        let target = |what: &str, value: f64, limit: f64| {
            Target::at_most("page", what, limit, Some(value.abs()))
                .with_small_values()
                .about(effect)
        };
        let mut all = Vec::new();
        if let Some((_, shape)) = PRINTS.iter().find(|(name, _)| *name == effect) {
            let of = |column| largest(&self.screens, shape, false, column);
            let exact = matches!(*shape, "Round" | "Line" | "Diamond");
            all.push(target("tone", of("tone"), if exact { 0.005 } else { 0.01 }));
            all.push(target("jump", of("jump"), 0.1));
            all.push(target("moire of a plate", of("moire"), 0.01));
            if effect == "halftone of four inks" {
                let rows: Vec<&Vec<String>> = self.colors.rows.iter().collect();
                let most = |column| {
                    let numbers = self.colors.numbers(&rows, column).into_iter();
                    numbers.fold(0.0, f64::max)
                };
                all.push(target("color", most("ideal"), 0.01));
                all.push(target("moire of all plates", most("beats"), 0.01));
            }
        }
        if effect == "color harmony" {
            let rows: Vec<&Vec<String>> = self.harmonies.rows.iter().collect();
            let most = crate::table::largest(&self.harmonies.numbers(&rows, "lightness"));
            all.push(target("lightness in OKLab", most, 0.01));
        }
        for row in self.errors.matching(&[("effect", effect)]) {
            let of = |column| self.errors.number(row, column);
            let what = self.errors.cell(row, "what");
            all.push(target(what, of("error"), of("limit")));
        }
        all
    }
}

/// All effects of the page, and the time of one pass in blits.
fn effects_of(folder: &Path) -> Result<(Vec<Effect>, f64), String> {
    let errors = Errors::load(folder)?;
    let costs = costs(&load(folder, "part_times")?, "page", "teapot", &OWN);
    let single = costs.iter().find(|cost| cost.name == ONE_PASS);
    let single = single.map_or(f64::NAN, |cost| cost.ratio[1]);
    let is_known =
        |cost: &Cost| !cost.name.starts_with("blit") && !SEVERAL.contains(&cost.name.as_str());
    let effect = |cost: Cost| {
        let [low, middle, high] = cost.ratio;
        let what = "blits over one pass";
        let over = Target::at_most("parts", what, MOST_BLITS, Some(middle - single))
            .with_noise(0.5 * (high - low))
            .about(&cost.name);
        Effect {
            errors: errors.of(&cost.name),
            over,
            cost,
        }
    };
    let all = costs.into_iter().filter(is_known).map(effect).collect();
    Ok((all, single))
}

/// The targets of the effects: errors and times.
pub fn effect_targets(folder: &Path) -> Result<Vec<Target>, String> {
    let (effects, _) = effects_of(folder)?;
    let targets = |effect: Effect| effect.errors.into_iter().chain([effect.over]);
    Ok(effects.into_iter().flat_map(targets).collect())
}

/// The table of these targets.
pub fn effects(out: &mut String, folder: &Path) -> Result<(), String> {
    let (effects, single) = effects_of(folder)?;
    let _ = writeln!(
        out,
        "### Effects of the page\n\n\
         Blits: all passes of the effect. Over one pass: less the time of `{ONE_PASS}`, an effect of one pass ({single:.2} \
         blits). Target: at most {MOST_BLITS}; the noise is half the distance between the 10th and the 90th percentile of \
         the rounds. \"Strokes along edges\" are for photographs, and are not meant to be fast.\n\n\
         | effect | error | blits | over one pass | target of the time |\n|---|---|---|---|---|"
    );
    for effect in &effects {
        let mut errors: Vec<String> = effect.errors.iter().map(Target::phrase).collect();
        if errors.is_empty() {
            errors.push("compared with its reference in tests".to_owned());
        }
        let blits = effect.cost.ratio[1];
        let _ = writeln!(
            out,
            "| {} | {} | {blits:.2} | {:.2} | {} |",
            effect.cost.name,
            errors.join("<br>"),
            blits - single,
            effect.over.verdict()
        );
    }
    out.push_str(
        "\ndocs/internals/measurements.md has what was tried for those that are missed, under \"Effects of the page\".\n\n\
         ",
    );
    Ok(())
}

/// The tones of fine screens.
pub fn targets(folder: &Path) -> Result<Vec<Target>, String> {
    let screens = load(folder, "page_screens")?;
    let shapes = screens.values("what");
    let target = |shape: String| {
        let exact = ["Round", "Line", "Diamond"].contains(&shape.as_str());
        let what = format!("mean tone of {} screens at 3 px", shape.to_lowercase());
        let error = largest(&screens, &shape, true, "tone");
        let limit = if exact { 0.005 } else { 0.01 };
        Target::at_most("page", what, limit, Some(error)).with_digits(4)
    };
    Ok(shapes.into_iter().map(target).collect())
}
