//! What the crate aims at, and whether it is reached: computed from the CSV files.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{GROWING, OWN, costs, growth_exponent, line_score},
    load,
    table::Table,
};

/// A target: what is measured, its limits, and the value, if it was measured.
pub struct Target {
    what: String,
    limits: [f64; 2],
    /// A second limit, below the first.
    then: Option<f64>,
    value: Option<f64>,
    digits: usize,
    /// How far apart rounds of the same measurement are.
    noise: f64,
}

/// How far apart ratios of outlines are in rounds of one run, in blits.
const NOISE: f64 = 2.0;

impl Target {
    pub fn at_most(what: impl Into<String>, limit: f64, value: Option<f64>) -> Self {
        Self {
            what: what.into(),
            limits: [f64::NEG_INFINITY, limit],
            then: None,
            value,
            digits: 2,
            noise: 0.0,
        }
    }

    /// A time in blits.
    fn blits(what: &str, limit: f64, value: Option<f64>) -> Self {
        Self {
            noise: NOISE,
            ..Self::at_most(format!("{what}, blits"), limit, value)
        }
    }

    fn at_least(what: impl Into<String>, limit: f64, value: Option<f64>) -> Self {
        Self {
            limits: [limit, f64::INFINITY],
            ..Self::at_most(what, limit, value)
        }
    }

    pub fn with_digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// A second, lower limit for later.
    fn then_at_most(self, limit: f64) -> Self {
        Self {
            then: Some(limit),
            ..self
        }
    }

    fn write(&self, out: &mut String) {
        let [low, high] = self.limits;
        let mut limits = if low == f64::NEG_INFINITY {
            format!("at most {high}")
        } else if high == f64::INFINITY {
            format!("at least {low}")
        } else {
            format!("{low} to {high}")
        };
        let is_met = |met: bool| if met { "met" } else { "**missed**" };
        let (value, verdict) = match self.value.filter(|value| value.is_finite()) {
            Some(value) => {
                let mut verdict = is_met((low..=high).contains(&value)).to_owned();
                if (value - low).abs().min((value - high).abs()) < self.noise {
                    verdict.push_str(", within the noise");
                }
                if let Some(then) = self.then {
                    let _ = write!(limits, "; then {then}");
                    let _ = write!(verdict, "; {}", is_met(value <= then));
                }
                (format!("{value:.*}", self.digits), verdict)
            }
            None => ("not measured".to_owned(), String::new()),
        };
        let _ = writeln!(out, "| {} | {limits} | {value} | {verdict} |", self.what);
    }
}

/// The times of lines, in blits.
fn times(folder: &Path) -> Result<Vec<Target>, String> {
    let ladder = costs(&load(folder, "ladder_times")?, "ladder", "teapot", &OWN);
    let blits = |name: &str| {
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
        Target::blits("contours", 3.0, blits("contours")),
        Target::blits("default comic", 4.0, blits("default comic")),
        Target::blits("all outlines, default, 2 px", 6.0, blits("outlines")),
        Target::blits(
            "the same; target with every factor of linked and smooth lines (without temporal anti-aliasing, whose memory costs more: see scene parts)",
            9.0,
            blits("outlines"),
        ),
        Target::blits(
            "all outlines, default, 16 px",
            7.5,
            blits("outlines; 16 pixels wide"),
        ),
        Target::blits(
            "all outlines along cracks, 2 px",
            6.0,
            blits("outlines; along cracks"),
        ),
        Target::blits(
            "all outlines along cracks, 16 px",
            7.5,
            blits("outlines; along cracks; 16 pixels wide"),
        ),
        Target::blits("sketch", 12.0, blits("sketch")),
        Target::at_least(rival, 4.0, ratio),
        Target {
            limits: [0.95, 1.05],
            ..Target::at_most("growth with pixels, exponent", 0.0, Some(exponent))
        },
    ])
}

/// Fragments per 100 pixels of line, in rows of a table of scores.
fn fragments(table: &Table, rows: &[&Vec<String>]) -> f64 {
    let sum = |name| table.numbers(rows, name).iter().sum::<f64>();
    100.0 * sum("fragments") / sum("line").max(1.0)
}

/// At most 0.3 where lines are found, and 0.1 after they are linked.
fn fragments_target(what: String, found: f64) -> Target {
    let target = Target::at_most(what, 0.3, Some(found)).then_at_most(0.1);
    target.with_digits(3)
}

/// The quality of lines.
fn quality(folder: &Path) -> Result<Vec<Target>, String> {
    let scores = load(folder, "line_scores")?;
    let [_, _, f1] = line_score(&scores, "all outlines", "every line");
    let village = scores.matching(&[
        ("scene", "village"),
        ("detector", "all outlines"),
        ("truth", "every line"),
    ]);
    let wrong = village.first().map(|row| {
        let drawn = scores.number(row, "drawn") - scores.number(row, "right");
        100.0 * drawn / scores.number(row, "pixels").max(1.0)
    });
    let teapot = scores.matching(&[
        ("scene", "teapot"),
        ("detector", "all outlines"),
        ("truth", "every line"),
    ]);
    let found = teapot
        .first()
        .map(|row| 100.0 * scores.number(row, "found") / scores.number(row, "true").max(1.0));
    let mut all = vec![
        Target::at_least(
            "teapot: true pixels that have a line at most a pixel away, %",
            100.0,
            found,
        ),
        Target::at_least("F1 of all outlines, all scenes", 0.99, Some(f1)).with_digits(3),
        Target::at_most("village: false pixels, %", 0.03, wrong).with_digits(3),
    ];
    let whole = load(folder, "line_fragments")?;
    for row in &whole.rows {
        let name = whole.cell(row, "scene");
        let what = format!("{name}: fragments per 100 px of line");
        let found = fragments(&whole, &[row]);
        all.push(fragments_target(what, found));
    }
    let models = load(folder, "model_scores")?;
    let rows: Vec<&Vec<String>> = models.rows.iter().collect();
    for model in models.distinct(&rows, "model") {
        for distance in ["close", "distant"] {
            let rows = models.matching(&[("model", &model), ("distance", distance)]);
            if !rows.is_empty() {
                let what = format!("{model}, {distance}: fragments per 100 px of line");
                all.push(fragments_target(what, fragments(&models, &rows)));
            }
        }
    }
    Ok(all)
}

/// The table of targets.
pub fn targets(out: &mut String, folder: &Path) -> Result<(), String> {
    out.push_str(
        "## Targets\n\nTimes are those of the crate's own passes on the teapot, without the \
         engine's prepasses. The limits of times are meant for a CPU adapter. Outlines are \
         timed with their default ink budget, and scored without it. Ratios of outlines scatter by \
         half between rounds, and are larger where a copy is faster: \"within the noise\" is what \
         is met or missed by less than 2 blits. docs/benchmarks.md has times of a machine whose \
         copy took 3 ms. Fragments have two limits: one for finding lines, and a lower one for lines that are also linked and smooth, \
         which these are.\n\n\
         | | target | here | |\n|---|---|---|---|\n",
    );
    for target in times(folder)?
        .into_iter()
        .chain(quality(folder)?)
        .chain(super::ink::targets(folder)?)
        .chain(super::page::targets(folder)?)
    {
        target.write(out);
    }
    out.push_str(
        "\nWhy targets are missed: on a CPU adapter a blit is little more than a copy of memory, \
         while every effect is computed in software for every pixel, with both sides of every \
         branch. The largest part of the time of outlines is the look at the depth, normal and id \
         of every pixel (`walk.wgsl`). False pixels of outlines are mostly faint steps and folds, \
         which the truth does not count: see \"wrong pixels\" below. Fragments and dashes are \
         left where a fold is about as sharp as the threshold, and where a wire is narrower than a \
         pixel. docs/benchmarks.md has what was tried and what it gained, under \"Targets of the \
         line engine\", and which sections of this report are of older builds.\n\n",
    );
    super::page::effects(out, folder)
}
