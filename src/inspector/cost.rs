//! What a frame costs, pass by pass, what was left out and why, and the known
//! error of what was chosen, beside its time.

use std::{collections::HashMap, sync::LazyLock};

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{Color32, Grid, Label, RichText, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};

use super::{Widgets, fields::section, note};
use crate::{
    ComicStyle, ComicsDiagnostics, ContourForm, DepthMap, RangeSmoothing, StageOutcome,
    timing::{Pass, PassTimes},
};

/// The report's own figures.
const LINES: &str = include_str!("../../docs/report/line_scores.csv");
const FLICKER: &str = include_str!("../../docs/report/flicker.csv");

const COLORS: [Color32; Pass::ALL.len()] = [
    Color32::from_rgb(130, 130, 140),
    Color32::from_rgb(90, 170, 250),
    Color32::from_rgb(250, 160, 60),
    Color32::from_rgb(170, 170, 180),
    Color32::from_rgb(110, 110, 120),
    Color32::from_rgb(240, 80, 90),
    Color32::from_rgb(90, 90, 100),
];

#[derive(Default)]
pub struct Costs {
    running: bool,
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

impl Costs {
    pub fn show(&mut self, ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
        let times = world.resource::<PassTimes>();
        times.run(true);
        self.running = true;
        let frames = times.frames();
        let medians: [f64; Pass::ALL.len()] =
            std::array::from_fn(|i| median(frames.iter().map(|frame| frame[i]).collect()));
        section(ui, "Time of the passes, all cameras together", |ui| {
            self.chart(ui, &frames, widgets);
            ui.weak(times.method().unwrap_or("Waiting for the first frame."));
            Grid::new("passes")
                .striped(true)
                .num_columns(2)
                .show(ui, |ui| {
                    for pass in Pass::ALL {
                        let name = RichText::new(pass.name());
                        ui.label(if pass.is_comics() {
                            name.strong()
                        } else {
                            name
                        });
                        ui.monospace(format!("{:8.3} ms", medians[pass as usize]));
                        ui.end_row();
                    }
                });
            ui.weak("Median of the frames in the chart; bold is this crate's.");
        });
        section(ui, "What ran, and what was left out", |ui| {
            stages(ui, world, camera);
        });
        section(ui, "Known error beside its time", |ui| {
            errors(ui, &ComicStyle::of(world.entity(camera)), &medians);
        });
        ui.ctx().request_repaint();
    }

    fn chart(&self, ui: &mut Ui, frames: &[[f64; Pass::ALL.len()]], widgets: &mut Widgets) {
        let shown = Plot::new("times")
            .height(160.0)
            .legend(Legend::default())
            .allow_zoom(false)
            .allow_drag(false)
            .allow_scroll(false)
            .include_y(0.0)
            .show_axes([false, true])
            .y_axis_formatter(|mark, _| format!("{} ms", mark.value))
            .show(ui, |plot| {
                for pass in Pass::ALL {
                    let points: PlotPoints = frames
                        .iter()
                        .enumerate()
                        .map(|(i, frame)| [i as f64, frame[pass as usize]])
                        .collect();
                    let width = if pass.is_comics() { 2.0 } else { 1.0 };
                    let line = Line::new(pass.name(), points);
                    plot.line(line.color(COLORS[pass as usize]).width(width));
                }
            });
        note(widgets, "times", &shown.response);
    }

    pub fn close(&mut self, world: &mut World) {
        if self.running {
            world.resource::<PassTimes>().run(false);
            self.running = false;
        }
    }
}

fn stages(ui: &mut Ui, world: &World, camera: Entity) {
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let Some(stages) = diagnostics.cameras.get(&camera) else {
        ui.label("Nothing is done for this camera.");
        return;
    };
    Grid::new("stages")
        .striped(true)
        .num_columns(2)
        .show(ui, |ui| {
            for (stage, outcome) in &stages.stages {
                match outcome {
                    StageOutcome::Ran => {
                        ui.strong(stage.name());
                        ui.label("ran");
                    }
                    StageOutcome::Reduced(method) => {
                        ui.strong(stage.name());
                        ui.label(format!("ran ({method:?})"));
                    }
                    StageOutcome::LeftOut(reason) => {
                        ui.weak(stage.name());
                        ui.weak(format!("left out: {reason}"));
                    }
                }
                ui.end_row();
            }
        });
}

/// (share of the lines that are missed, share of the ink that is on none), mean
/// over the report's scenes.
fn line_error(detector: &str) -> Option<(f64, f64)> {
    let mut sum = (0.0, 0.0);
    let mut scenes = 0.0;
    for row in LINES.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [_, name, "every line", numbers @ ..] = cells.as_slice() else {
            continue;
        };
        if *name != detector {
            continue;
        }
        let numbers: Vec<f64> = numbers.iter().filter_map(|n| n.parse().ok()).collect();
        let [found, all, right, drawn] = numbers.as_slice() else {
            continue;
        };
        if *all > 0.0 && *drawn > 0.0 {
            sum.0 += 1.0 - found / all;
            sum.1 += 1.0 - right / drawn;
            scenes += 1.0;
        }
    }
    (scenes > 0.0).then(|| (sum.0 / scenes, sum.1 / scenes))
}

/// (mean change of the picture from frame to frame in display codes, largest
/// lag of the range in octaves) over the report's sequences.
fn flicker(variant: &str) -> Option<(f64, f64)> {
    // Thousands of rows: read once, not in every frame.
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

/// The report's name for a way of smoothing.
fn smoothing_variant(map: &DepthMap) -> Option<&'static str> {
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

fn errors(ui: &mut Ui, style: &ComicStyle, medians: &[f64; Pass::ALL.len()]) {
    let time = |pass: Pass| format!("{:.3} ms", medians[pass as usize]);
    let map = style.depth_map.unwrap_or_default();
    let mut rows: Vec<(String, String, String)> = Vec::new();
    if map.mapping.follows_visible_range() {
        let range = format!("depth range ({:?})", map.reduction);
        rows.push((range, "exact, to the bit".into(), time(Pass::DepthRange)));
        let known = smoothing_variant(&map).map(|variant| (variant, flicker(variant)));
        let error = match known {
            Some((_, Some((codes, lag)))) => {
                format!("flickers {codes:.3} codes a frame, lags up to {lag:.1} octaves")
            }
            _ => "settings that the report has not measured".into(),
        };
        let name = known.map_or("range smoothing", |(variant, _)| variant);
        rows.push((format!("smoothing: {name}"), error, "in the above".into()));
    }
    let lines = |detector: &str| match line_error(detector) {
        Some((missed, stray)) => format!(
            "misses {:.0} % of the lines, {:.0} % of its ink is on none",
            100.0 * missed,
            100.0 * stray
        ),
        None => "not in the report".into(),
    };
    if let Some(contours) = &style.contours {
        let detector = format!("{:?}", contours.operator);
        let error = if contours.form == ContourForm::PlaneAware {
            lines(&detector)
        } else {
            "the faithful form is not in the report".into()
        };
        rows.push((format!("contours: {detector}"), error, time(Pass::Stylize)));
    }
    if let Some(outlines) = &style.outlines {
        let detector = match (&outlines.silhouettes, &outlines.creases, &outlines.objects) {
            (Some(_), Some(_), Some(_)) => "all outlines",
            (Some(_), Some(_), None) => "silhouettes + creases",
            (Some(_), None, None) => "silhouettes",
            _ => "another choice of kinds",
        };
        rows.push((
            format!("outlines: {detector}"),
            lines(detector),
            time(Pass::Outlines),
        ));
    }
    if rows.is_empty() {
        ui.label("Nothing of this style has an error to speak of: it is computed as documented.");
        return;
    }
    for (what, error, time) in rows {
        ui.horizontal_wrapped(|ui| {
            ui.strong(what);
            ui.monospace(time);
        });
        ui.add(Label::new(error).wrap());
        ui.separator();
    }
    ui.weak("Errors with default settings, mean over the scenes of docs/report; times are of now.");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reports_figures_are_found() {
        for detector in [
            "Roberts",
            "Prewitt",
            "Sobel",
            "Laplace",
            "silhouettes",
            "silhouettes + creases",
            "all outlines",
        ] {
            let (missed, stray) = line_error(detector).expect(detector);
            assert!((0.0..=1.0).contains(&missed) && (0.0..=1.0).contains(&stray));
        }
        assert_eq!(line_error("nonsense"), None);
        let off = flicker("off").expect("off");
        let default = flicker("the default").expect("the default");
        assert!(flicker("the default and percentiles").is_some());
        assert!(
            default.0 < off.0,
            "smoothing flickers less: {default:?} against {off:?}"
        );
        assert_eq!(off.1, 0.0, "what is not smoothed does not lag");
    }

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(Vec::new()), 0.0);
    }
}
