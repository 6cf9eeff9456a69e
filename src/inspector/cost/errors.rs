//! The known errors of the chosen methods, beside their times.

use bevy_egui::egui::{Color32, Label, Ui};
use egui_plot::{GridInput, GridMark, Plot, PlotPoint, PlotUi, Points, Text, VLine};

use super::{
    super::{Widgets, note, report_data},
    COLORS, Medians,
};
use crate::{ComicStyle, timing::Pass};

/// A chosen method with its error and time, as text.
struct Known {
    what: String,
    error: String,
    time: String,
}

fn line_error(detector: &str) -> String {
    match report_data::lines(detector) {
        Some(lines) => format!(
            "misses {:.0} % of the lines; {:.0} % of its ink is not on a line",
            100.0 * lines.missed,
            100.0 * lines.stray
        ),
        None => "not measured in docs/report".into(),
    }
}

fn time_of(pass: Pass, medians: &Medians) -> String {
    format!("{:.3} ms", medians[pass as usize])
}

/// The rows of the depth range and its smoothing, if the style uses the visible
/// range.
fn depth_range_rows(style: &ComicStyle, medians: &Medians) -> Vec<Known> {
    let map = style.depth_map.unwrap_or_default();
    if !map.mapping.follows_visible_range() {
        return Vec::new();
    }
    let known =
        report_data::smoothing(&map).map(|variant| (variant, report_data::flicker(variant)));
    let error = match known {
        Some((_, Some((codes, lag)))) => {
            format!("mean change {codes:.3} 8-bit codes per frame; lags by up to {lag:.1} octaves")
        }
        _ => "not measured in docs/report with these settings".into(),
    };
    let name = known.map_or("range smoothing", |(variant, _)| variant);
    vec![
        Known {
            what: format!("depth range ({:?})", map.reduction),
            error: "exact".into(),
            time: time_of(Pass::DepthRange, medians),
        },
        Known {
            what: format!("smoothing: {name}"),
            error,
            time: "(included above)".into(),
        },
    ]
}

/// The rows of the effects that find lines, and their names in the report.
fn detector_rows(style: &ComicStyle, medians: &Medians) -> (Vec<Known>, Vec<String>) {
    let mut rows = Vec::new();
    let mut detectors = Vec::new();
    for effect in style.effects() {
        let Some(detector) = effect.any_report_name() else {
            continue;
        };
        let pass = if effect.any_lines().is_some() {
            Pass::Outlines
        } else {
            Pass::Stylize
        };
        let name = effect.effect_type().name.replace('_', " ");
        rows.push(Known {
            what: format!("{name}: {detector}"),
            error: line_error(&detector),
            time: time_of(pass, medians),
        });
        detectors.push(detector);
    }
    (rows, detectors)
}

/// A row for each method that has a known error, and the chart of the line
/// detectors.
pub(super) fn show(ui: &mut Ui, style: &ComicStyle, medians: &Medians, widgets: &mut Widgets) {
    let mut rows = depth_range_rows(style, medians);
    let (found, detectors) = detector_rows(style, medians);
    rows.extend(found);
    if rows.is_empty() {
        ui.label("No part of this style has a measured error.");
        return;
    }
    for row in rows {
        ui.horizontal_wrapped(|ui| {
            ui.strong(row.what);
            ui.monospace(row.time);
        });
        ui.add(Label::new(row.error).wrap());
        ui.separator();
    }
    ui.weak("Errors: with default settings, over all scenes of docs/report. Times: now.");
    if !detectors.is_empty() {
        let now = [Pass::DepthRange, Pass::Outlines, Pass::Stylize]
            .map(|pass| medians[pass as usize])
            .iter()
            .sum();
        error_against_time(ui, &detectors, now, widgets);
    }
}

/// The position of a time in milliseconds on the chart's logarithmic axis, which
/// has room for fast and slow adapters.
fn place(time: f64) -> f64 {
    time.max(1e-3).log10()
}

/// The grid of times: 1, 2 and 5 of every visible decade.
fn decades(input: GridInput) -> Vec<GridMark> {
    let (from, to) = input.bounds;
    let first = (from.floor().clamp(-4.0, 6.0)) as i32;
    let last = (to.ceil().clamp(-4.0, 6.0)) as i32;
    (first..=last)
        .flat_map(|decade| {
            [1.0f64, 2.0, 5.0].map(|step| GridMark {
                value: f64::from(decade) + step.log10(),
                // Every grid line has a label.
                step_size: 1.0,
            })
        })
        .filter(|mark| (from..=to).contains(&mark.value))
        .collect()
}

/// The grid of errors, in percent.
fn quarters(_: GridInput) -> Vec<GridMark> {
    (0..=4)
        .map(|i| GridMark {
            value: 25.0 * f64::from(i),
            step_size: 25.0,
        })
        .collect()
}

/// The label of a position on the axis of times.
fn time_label(place: f64) -> String {
    let time = 10f64.powf(place);
    let digits = (-place.floor()).clamp(0.0, 4.0) as usize;
    format!("{time:.digits$} ms")
}

/// The dot of a detector; with its name if it is chosen.
fn dot(plot: &mut PlotUi<'_>, detector: &str, lines: report_data::Lines, is_chosen: bool) {
    let color = if is_chosen {
        COLORS[Pass::Outlines as usize]
    } else {
        Color32::GRAY
    };
    let at = [place(lines.time), 100.0 * lines.error()];
    plot.points(
        Points::new(detector, vec![at])
            .radius(if is_chosen { 6.0 } else { 4.0 })
            .filled(is_chosen)
            .color(color),
    );
    if is_chosen {
        let above = PlotPoint::new(at[0], at[1] + 8.0);
        plot.text(Text::new(detector, above, detector).color(color));
    }
}

/// The chart of all line detectors by error and time. The chosen ones are filled;
/// a line shows the current time.
fn error_against_time(ui: &mut Ui, chosen: &[String], now: f64, widgets: &mut Widgets) {
    ui.add_space(4.0);
    ui.strong("Line errors and times");
    let shown = Plot::new("error against time")
        .height(170.0)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .include_y(0.0)
        .include_y(100.0)
        .include_x(place(now) - 0.1)
        .include_x(place(now) + 0.1)
        .x_grid_spacer(decades)
        .y_grid_spacer(quarters)
        .x_axis_formatter(|mark, _| time_label(mark.value))
        .y_axis_formatter(|mark, _| format!("{:.0} %", mark.value))
        .label_formatter(|name, value| {
            format!("{name}\n{:.3} ms\n{:.1} %", 10f64.powf(value.x), value.y)
        })
        .show(ui, |plot| {
            for detector in report_data::DETECTORS {
                if let Some(lines) = report_data::lines(detector) {
                    let is_chosen = chosen.iter().any(|name| name == detector);
                    dot(plot, detector, lines, is_chosen);
                }
            }
            plot.vline(
                VLine::new("now", place(now))
                    .color(Color32::from_rgb(230, 90, 70))
                    .width(2.0),
            );
        });
    note(widgets, "errors", &shown.response);
    ui.weak(format!(
        "Error: 1 − F₁; 0 % means that every line and nothing else is drawn. Dots: all passes \
         of bevy_comics at 1280x720 on {}; chosen detectors are filled. Red line: the \
         current time of these passes.",
        report_data::adapter()
    ));
}
