//! Evaluates the tables of times and of scores.

use std::fmt::Write;

use crate::table::{Table, exponent, median, quantile};

/// Columns of the laps in a table of times.
pub const LAPS: [&str; 5] = ["prepass", "range", "lines", "main", "post"];

/// The laps that hold this crate's own passes.
pub const OWN: [&str; 3] = ["range", "lines", "post"];

/// The cost of a variant.
pub struct Cost {
    pub name: String,
    /// Milliseconds more than the frame without it, median of all rounds.
    pub milliseconds: f64,
    /// Ratio to a blit of the same round: 10th, 50th and 90th percentile. Rounds in which the blit
    /// is lost in the noise (no longer than nothing) are left out; not a number if they are more
    /// than a quarter.
    pub ratio: [f64; 3],
}

/// The costs of all variants of a section and scene, in the sum of some laps.
pub fn costs(times: &Table, section: &str, scene: &str, laps: &[&str]) -> Vec<Cost> {
    let rows = times.matching(&[("section", section), ("scene", scene)]);
    let of = |variant: &str, laps: &[&str]| -> Vec<f64> {
        rows.iter()
            .filter(|row| times.cell(row, "variant") == variant)
            .map(|row| laps.iter().map(|lap| times.number(row, lap)).sum())
            .collect()
    };
    let (nothing, nothing_post) = (of("nothing", laps), of("nothing", &["post"]));
    let blit: Vec<f64> = of("blit", &["post"])
        .iter()
        .zip(&nothing_post)
        .map(|(b, n)| b - n)
        .collect();
    let lost = |b: &f64| *b <= 0.0;
    let is_noise = 4 * blit.iter().filter(|b| lost(b)).count() > blit.len();
    times
        .distinct(&rows, "variant")
        .into_iter()
        .filter(|name| name != "nothing")
        .map(|name| {
            let own = of(&name, laps);
            let over: Vec<f64> = own.iter().zip(&nothing).map(|(v, n)| v - n).collect();
            let ratios: Vec<f64> = over
                .iter()
                .zip(&blit)
                .filter(|(_, b)| !lost(b))
                .map(|(v, b)| v / b)
                .collect();
            Cost {
                name,
                milliseconds: median(&over),
                ratio: [0.1, 0.5, 0.9].map(|q| {
                    if is_noise {
                        f64::NAN
                    } else {
                        quantile(&ratios, q)
                    }
                }),
            }
        })
        .collect()
}

/// The number, or 0 if it rounds to 0: a negative zero would be printed as `-0.00`.
pub fn unsigned_zero(x: f64, digits: i32) -> f64 {
    if x.abs() < 0.5 * 10f64.powi(-digits) {
        0.0
    } else {
        x
    }
}

/// Writes a table of costs, without the blits.
pub fn cost_table(out: &mut String, costs: &[Cost]) {
    let _ = writeln!(out, "| | ms | blits | 10 % to 90 % |\n|---|---|---|---|");
    for cost in costs.iter().filter(|c| !c.name.starts_with("blit")) {
        let _ = write!(out, "| {} | {:.2} |", cost.name, cost.milliseconds);
        let [low, middle, high] = cost.ratio;
        let _ = if middle.is_nan() {
            writeln!(out, " - | - |")
        } else {
            writeln!(out, " {middle:.2} | {low:.2} to {high:.2} |")
        };
    }
    out.push('\n');
}

/// Size of the pictures of a table, as text.
pub fn size(times: &Table) -> String {
    times.rows.first().map_or_else(String::new, |row| {
        format!("{}x{}", times.cell(row, "width"), times.cell(row, "height"))
    })
}

/// (recall, precision, F1) of a detector over all scenes.
pub fn line_score(scores: &Table, detector: &str, truth: &str) -> [f64; 3] {
    let rows = scores.matching(&[("detector", detector), ("truth", truth)]);
    let sum = |name| scores.sum(&rows, name);
    let recall = sum("found") / sum("true").max(1.0);
    let precision = sum("right") / sum("drawn").max(1.0);
    let f1 = 2.0 * recall * precision / (recall + precision).max(1e-9);
    [recall, precision, f1]
}

/// The style whose growth is measured.
pub const GROWING: &str = "default comic";

/// How the cost of a variant grows with the pixels, vertices or cameras of a section: (fitted
/// exponent, points of (size, milliseconds)).
pub fn growth_exponent(times: &Table, section: &str, variant: &str) -> (f64, Vec<(f64, f64)>) {
    let rows = times.matching(&[("section", section)]);
    let points: Vec<(f64, f64)> = times
        .distinct(&rows, "scene")
        .into_iter()
        .filter_map(|scene| {
            let x = match scene.split_once('x') {
                Some((w, h)) => w.parse::<f64>().ok()? * h.parse::<f64>().ok()?,
                None => scene.parse().ok()?,
            };
            let cost = costs(times, section, &scene, &OWN)
                .into_iter()
                .find(|c| c.name == variant)?;
            Some((x, cost.milliseconds))
        })
        .collect();
    (exponent(&points), points)
}
