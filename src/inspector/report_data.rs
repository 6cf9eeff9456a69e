//! Errors and times from the crate's report, `docs/report`.

use std::{collections::HashMap, sync::LazyLock};

use crate::{DepthMap, depth::RangeSmoothing};

const SCORES: &str = include_str!("../../docs/report/line_scores.csv");
const TIMES: &str = include_str!("../../docs/report/line_times.csv");
const FLICKER: &str = include_str!("../../docs/report/flicker.csv");
const MACHINE: &str = include_str!("../../docs/report/machine.csv");

/// The line detectors, by their names in the report.
pub const DETECTORS: &[&str] = &[
    "Roberts",
    "Prewitt",
    "Sobel",
    "Laplace",
    "silhouettes",
    "silhouettes + creases",
    "all outlines",
];

/// The quality and the time of a line detector, over the pixels of all scenes of
/// the report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// Fraction of the lines' pixels that are missed.
    pub missed: f64,
    /// Fraction of the inked pixels that are not on a line.
    pub stray: f64,
    /// Time of all the crate's passes at 1280x720 in milliseconds, less that of the frame
    /// without them: median.
    pub time: f64,
}

impl Lines {
    /// Both errors as one number: 1 − F₁. 0 if every line and nothing else is
    /// drawn.
    pub fn error(&self) -> f64 {
        let (recall, precision) = (1.0 - self.missed, 1.0 - self.stray);
        1.0 - 2.0 * recall * precision / (recall + precision).max(f64::MIN_POSITIVE)
    }
}

/// The adapter on which the report's times were measured.
pub fn adapter() -> &'static str {
    MACHINE
        .lines()
        .find_map(|line| line.strip_prefix("adapter,"))
        .unwrap_or("an unknown adapter")
}

/// The median; 0 if there are no values.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// The report's figures of a line detector.
pub fn lines(detector: &str) -> Option<Lines> {
    static READ: LazyLock<HashMap<&str, Lines>> = LazyLock::new(|| {
        DETECTORS
            .iter()
            .filter_map(|detector| Some((*detector, read_lines(detector)?)))
            .collect()
    });
    READ.get(detector).copied()
}

fn numbers(cells: &[&str]) -> Option<Vec<f64>> {
    cells.iter().map(|cell| cell.parse().ok()).collect()
}

fn read_lines(detector: &str) -> Option<Lines> {
    // Pixels: of the lines found, of all lines, of the ink on lines, of all ink.
    let mut sums = [0.0; 4];
    for row in SCORES.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        if let [_, name, "every line", rest @ ..] = cells.as_slice()
            && *name == detector
        {
            let pixels = numbers(rest)?;
            for (sum, pixels) in sums.iter_mut().zip(pixels) {
                *sum += pixels;
            }
        }
    }
    let [found, all, right, drawn] = sums;
    let (frames, empty) = (times_of(detector)?, times_of("nothing")?);
    let times: Vec<f64> = frames.iter().zip(empty).map(|(f, e)| f - e).collect();
    (all > 0.0 && drawn > 0.0 && !times.is_empty()).then(|| Lines {
        missed: 1.0 - found / all,
        stray: 1.0 - right / drawn,
        time: median(times),
    })
}

/// Times of the crate's passes in every round of a variant.
fn times_of(variant: &str) -> Option<Vec<f64>> {
    let mut times = Vec::new();
    for row in TIMES.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        if let ["lines", _, name, _, _, _, rest @ ..] = cells.as_slice()
            && *name == variant
        {
            // The times of the prepass and the main pass are the engine's.
            let [_, range, lines, _, post] = *numbers(rest)?.as_slice() else {
                return None;
            };
            times.push(range + lines + post);
        }
    }
    Some(times)
}

/// The flicker of a way of smoothing, over the report's sequences: the mean change
/// of the picture from frame to frame in 8-bit codes, and the largest lag of the
/// range in octaves.
pub fn flicker(variant: &str) -> Option<(f64, f64)> {
    // The file has thousands of rows.
    static READ: LazyLock<HashMap<&str, Option<(f64, f64)>>> = LazyLock::new(|| {
        let variants = ["off", "the default", "the default and percentiles"];
        variants
            .map(|variant| (variant, read_flicker(variant)))
            .into()
    });
    READ.get(variant).copied().flatten()
}

fn read_flicker(variant: &str) -> Option<(f64, f64)> {
    let (mut sum, mut frames, mut lag) = (0.0, 0.0, 0.0f64);
    for row in FLICKER.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [_, name, _, mean, _, late] = cells.as_slice() else {
            continue;
        };
        if *name != variant {
            continue;
        }
        if let (Ok(mean), Ok(late)) = (mean.parse::<f64>(), late.parse::<f64>()) {
            sum += mean;
            frames += 1.0;
            lag = lag.max(late);
        }
    }
    (frames > 0.0).then(|| (sum / frames, lag))
}

/// The report's name of a map's smoothing, if it was measured.
pub fn smoothing(map: &DepthMap) -> Option<&'static str> {
    let default = RangeSmoothing::default();
    match map.smoothing {
        None => Some("off"),
        Some(s) if s == default => Some("the default"),
        Some(s) if (RangeSmoothing { outliers: 0.0, ..s }) == default => {
            Some("the default and percentiles")
        }
        Some(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reports_figures_are_found() {
        for &detector in DETECTORS {
            let lines = lines(detector).expect(detector);
            for fraction in [lines.missed, lines.stray, lines.error()] {
                assert!((0.0..=1.0).contains(&fraction), "{detector}: {lines:?}");
            }
            assert!(lines.time > 0.0);
        }
        assert_eq!(lines("nonsense"), None);
        for effect in crate::effect::EffectRegistry::built_in().types() {
            if let Some(name) = (effect.default)().any_report_name() {
                assert!(DETECTORS.contains(&name.as_str()), "{name}");
            }
        }
        let off = flicker("off").expect("off");
        let default = flicker("the default").expect("the default");
        assert!(flicker("the default and percentiles").is_some());
        assert!(
            default.0 < off.0,
            "smoothing flickers less: {default:?} against {off:?}"
        );
        assert_eq!(off.1, 0.0, "a range without smoothing does not lag");
        assert!(adapter().len() > 3);
    }

    /// The report's own table is made by other code from the same files.
    #[test]
    fn the_figures_are_those_of_the_reports_table() {
        let report = include_str!("../../docs/report/report.md");
        let (_, table) = report.split_once("### Lines").expect("the table");
        for &detector in DETECTORS {
            let row = table
                .lines()
                .find(|line| line.starts_with(&format!("| {detector} |")))
                .expect(detector);
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            let lines = lines(detector).expect(detector);
            let percent = |fraction: f64| format!("{:.1} %", 100.0 * fraction);
            assert_eq!(cells[4], percent(1.0 - lines.missed), "{row}");
            assert_eq!(cells[5], percent(1.0 - lines.stray), "{row}");
            assert_eq!(cells[7], format!("{:.3}", 1.0 - lines.error()), "{row}");
            let time: f64 = cells[8].parse().expect("a time");
            // The table has two digits.
            assert!((lines.time - time).abs() < 0.0051, "{row}: {lines:?}");
        }
    }

    #[test]
    fn one_number_for_both_errors() {
        let lines = |missed, stray| Lines {
            missed,
            stray,
            time: 1.0,
        };
        assert_eq!(lines(0.0, 0.0).error(), 0.0);
        assert_eq!(lines(1.0, 1.0).error(), 1.0);
        // Recall 1/2 and precision 1: F₁ = 2/3.
        assert!((lines(0.5, 0.0).error() - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(Vec::new()), 0.0);
    }
}
