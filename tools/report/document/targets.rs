//! What the crate aims at, and whether it is reached: computed from the CSV files.

use std::{fmt::Write, path::Path};

use super::target::Target;
use crate::{
    costs::{GROWING, OWN, costs, growth_exponent, line_score},
    load,
    table::Table,
};

/// How far apart ratios of outlines are in rounds of one run, in blits.
pub const NOISE: f64 = 2.0;

/// What the second limit of fragments and of the time of outlines is for.
const LINKED: &str = "linked and smooth";

/// A time of a style of the ladder, in blits.
fn blits(what: &str, limit: f64, value: Option<f64>) -> Target {
    Target::at_most("ladder", format!("{what}, blits"), limit, value).with_noise(NOISE)
}

/// The times of lines, in blits.
fn times(folder: &Path) -> Result<Vec<Target>, String> {
    let ladder = costs(&load(folder, "ladder_times")?, "ladder", "teapot", &OWN);
    let cost = |name: &str| {
        let cost = ladder.iter().find(|c| c.name == name);
        cost.map(|c| c.ratio[1])
    };
    let peers = costs(&load(folder, "peer_times")?, "peers", "teapot", &OWN);
    let milliseconds = |name: &str| {
        let cost = peers.iter().find(|c| c.name.contains(name));
        cost.map(|c| c.milliseconds)
    };
    let ratio = milliseconds("Sobel")
        .zip(milliseconds("silhouettes + creases"))
        .map(|(other, own)| other / own);
    let (exponent, _) = growth_exponent(&load(folder, "growth_times")?, "pixels", GROWING);
    let rival =
        "time of bevy_edge_detection_outline (Sobel, depth + normals) / silhouettes + creases";
    Ok(vec![
        blits("contours", 3.0, cost("contours")),
        blits("default comic", 4.0, cost("default comic")),
        blits("all outlines, default, 2 px", 6.0, cost("outlines")).and_at_most(LINKED, 9.0),
        blits(
            "all outlines, default, 16 px",
            7.5,
            cost("outlines; 16 pixels wide"),
        ),
        blits(
            "all outlines along cracks, 2 px",
            6.0,
            cost("outlines; along cracks"),
        ),
        blits(
            "all outlines along cracks, 16 px",
            7.5,
            cost("outlines; along cracks; 16 pixels wide"),
        ),
        blits("sketch", 12.0, cost("sketch")),
        Target::at_least("peers", rival, 4.0, ratio),
        Target::within(
            "growth",
            "growth with pixels, exponent",
            [0.95, 1.05],
            Some(exponent),
        ),
    ])
}

/// Fragments per 100 pixels of line, in rows of a table of scores.
fn fragments(table: &Table, rows: &[&Vec<String>]) -> f64 {
    let sum = |name| table.sum(rows, name);
    100.0 * sum("fragments") / sum("line").max(1.0)
}

/// At most 0.3 of lines that are only found, and 0.1 after they are linked.
fn fragments_target(section: &'static str, subject: &str, found: f64) -> Target {
    let what = format!("{subject}: fragments per 100 px of line");
    let target = Target::at_most(section, what, 0.3, Some(found)).and_at_most(LINKED, 0.1);
    target.with_digits(3)
}

/// How well all outlines follow the edges of scenes.
fn scores(folder: &Path) -> Result<Vec<Target>, String> {
    let scores = load(folder, "line_scores")?;
    let [_, _, f1] = line_score(&scores, "all outlines", "every line");
    let of_scene = |scene| {
        scores.matching(&[
            ("scene", scene),
            ("detector", "all outlines"),
            ("truth", "every line"),
        ])
    };
    let wrong = of_scene("village").first().map(|row| {
        let drawn = scores.number(row, "drawn") - scores.number(row, "right");
        100.0 * drawn / scores.number(row, "pixels").max(1.0)
    });
    let found = of_scene("teapot")
        .first()
        .map(|row| 100.0 * scores.number(row, "found") / scores.number(row, "true").max(1.0));
    let teapot = "teapot: true pixels that have a line at most a pixel away, %";
    let f1_target = Target::at_least("lines", "F1 of all outlines, all scenes", 0.99, Some(f1));
    let village = Target::at_most("lines", "village: false pixels, %", 0.03, wrong);
    Ok(vec![
        Target::at_least("lines", teapot, 100.0, found),
        f1_target.with_digits(3),
        village.with_digits(3),
    ])
}

/// The quality of lines.
fn quality(folder: &Path) -> Result<Vec<Target>, String> {
    let mut all = scores(folder)?;
    let whole = load(folder, "line_fragments")?;
    for row in &whole.rows {
        let scene = whole.cell(row, "scene");
        all.push(fragments_target("lines", scene, fragments(&whole, &[row])));
    }
    let models = load(folder, "model_scores")?;
    for model in models.values("model") {
        for distance in ["close", "distant"] {
            let rows = models.matching(&[("model", &model), ("distance", distance)]);
            if !rows.is_empty() {
                let subject = format!("{model}, {distance}");
                let found = fragments(&models, &rows);
                all.push(fragments_target("models", &subject, found));
            }
        }
    }
    Ok(all)
}

/// The targets of the table.
fn listed(folder: &Path) -> Result<Vec<Target>, String> {
    let mut all = times(folder)?;
    all.extend(quality(folder)?);
    all.extend(super::ink::targets(folder)?);
    all.extend(super::toon::targets(folder));
    all.extend(super::page::targets(folder)?);
    Ok(all)
}

/// All targets, with those of the effects of the page.
pub fn all(folder: &Path) -> Result<Vec<Target>, String> {
    let mut all = listed(folder)?;
    all.extend(super::page::effect_targets(folder)?);
    Ok(all)
}

/// The head of a table of targets.
const HEAD: &str = "| what | target | measured | verdict |\n|---|---|---|---|\n";

/// The tables of targets.
pub fn targets(out: &mut String, folder: &Path) -> Result<(), String> {
    let _ = writeln!(
        out,
        "## Targets\n\n\
         Times are those of the crate's own passes on the teapot; their limits are meant for a CPU adapter. Outlines are \
         timed with their default ink budget, and scored without it. Ratios of outlines scatter by half between rounds: \
         \"within the noise\" is what is met or missed by less than {NOISE} blits. Fragments and the time of outlines have \
         two limits: for finding lines, and for lines that are also linked and smooth, as these are.\n\n\
         ### Missed\n\n\
         Sorted by how many times over its limit a value is. Effects of the page have a table of their own, below.\n"
    );
    let is_missed = |target: &Target| target.count().missed > 0;
    let (mut missed, met): (Vec<Target>, Vec<Target>) =
        listed(folder)?.into_iter().partition(is_missed);
    missed.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
    out.push_str(HEAD);
    for target in &missed {
        target.write(out);
    }
    let (of_copy, _) = growth_exponent(&load(folder, "growth_times")?, "pixels", "blit");
    let _ = writeln!(
        out,
        "\nWhy targets are missed:\n\n\
         * Times: on a CPU adapter a blit is little more than a copy of memory, while effects are computed in software, \
         with both sides of every branch. Outlines spend most time on reading depth, normal and id of every pixel \
         (`walk.wgsl`); the other crate reads few texels, and looks for less.\n* Growth: an exponent below 0.95 means that \
         large pictures cost less than in proportion. A copy has {of_copy:.2}.\n* False pixels of outlines are mostly \
         faint steps and folds, which the truth does not count: see \"wrong pixels\" below.\n* Fragments and dashes are \
         left where a fold is about as sharp as the threshold, and where a wire is narrower than a pixel.\n* Straight \
         lines: docs/internals/measurements.md says under that name what differs, and how much.\n\n\
         docs/internals/measurements.md has what was tried and what it gained, under \"Targets of the line engine\".\n\n\
         ### Met\n"
    );
    out.push_str(HEAD);
    for target in &met {
        target.write(out);
    }
    out.push('\n');
    super::page::effects(out, folder)
}
