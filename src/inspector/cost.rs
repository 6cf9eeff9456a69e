//! What a frame costs, pass by pass, what was left out and why, and the known
//! error of what was chosen, beside its time.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{Color32, Grid, Label, RichText, Sense, Ui, Vec2};
use egui_plot::{GridInput, GridMark, Line, Plot, PlotPoint, PlotPoints, Points, Text, VLine};

use super::{Widgets, fields::section, known, note};
use crate::{
    ComicStyle, ComicsDiagnostics, ContourForm, StageOutcome,
    timing::{Pass, PassTimes},
};

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

impl Costs {
    pub fn show(&mut self, ui: &mut Ui, world: &mut World, camera: Entity, widgets: &mut Widgets) {
        let times = world.resource::<PassTimes>();
        times.run(true);
        self.running = true;
        let frames = times.frames();
        let medians: [f64; Pass::ALL.len()] =
            std::array::from_fn(|i| known::median(frames.iter().map(|frame| frame[i]).collect()));
        section(ui, "Time of the passes, all cameras together", |ui| {
            self.chart(ui, &frames, widgets);
            ui.weak(times.method().unwrap_or("Waiting for the first frame."));
            Grid::new("passes")
                .striped(true)
                .num_columns(3)
                .show(ui, |ui| {
                    for pass in Pass::ALL {
                        dot(ui, COLORS[pass as usize]);
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
            errors(ui, &ComicStyle::of(world.entity(camera)), &medians, widgets);
        });
        ui.ctx().request_repaint();
    }

    fn chart(&self, ui: &mut Ui, frames: &[[f64; Pass::ALL.len()]], widgets: &mut Widgets) {
        let shown = Plot::new("times")
            .height(160.0)
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

/// What ties a row of the table to its line in the chart.
fn dot(ui: &mut Ui, color: Color32) {
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, color);
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

/// A row: what was chosen, its error, its time.
struct Known {
    what: String,
    error: String,
    time: String,
}

fn line_error(detector: &str) -> String {
    match known::lines(detector) {
        Some(lines) => format!(
            "misses {:.0} % of the lines, {:.0} % of its ink is on none",
            100.0 * lines.missed,
            100.0 * lines.stray
        ),
        None => "not in the report".into(),
    }
}

fn errors(
    ui: &mut Ui,
    style: &ComicStyle,
    medians: &[f64; Pass::ALL.len()],
    widgets: &mut Widgets,
) {
    let time = |pass: Pass| format!("{:.3} ms", medians[pass as usize]);
    let map = style.depth_map.unwrap_or_default();
    let mut rows: Vec<Known> = Vec::new();
    let mut detectors: Vec<String> = Vec::new();
    if map.mapping.follows_visible_range() {
        rows.push(Known {
            what: format!("depth range ({:?})", map.reduction),
            error: "exact, to the bit".into(),
            time: time(Pass::DepthRange),
        });
        let known = known::smoothing(&map).map(|variant| (variant, known::flicker(variant)));
        let error = match known {
            Some((_, Some((codes, lag)))) => {
                format!("flickers {codes:.3} codes a frame, lags up to {lag:.1} octaves")
            }
            _ => "settings that the report has not measured".into(),
        };
        let name = known.map_or("range smoothing", |(variant, _)| variant);
        rows.push(Known {
            what: format!("smoothing: {name}"),
            error,
            time: "in the above".into(),
        });
    }
    if let Some(contours) = &style.contours {
        let detector = known::contours(contours.operator);
        let error = if contours.form == ContourForm::PlaneAware {
            line_error(&detector)
        } else {
            "the faithful form is not in the report".into()
        };
        rows.push(Known {
            what: format!("contours: {detector}"),
            error,
            time: time(Pass::Stylize),
        });
        if contours.form == ContourForm::PlaneAware {
            detectors.push(detector);
        }
    }
    if let Some(outlines) = &style.outlines {
        let detector = known::outlines(outlines);
        rows.push(Known {
            what: format!("outlines: {detector}"),
            error: line_error(detector),
            time: time(Pass::Outlines),
        });
        detectors.push(detector.to_owned());
    }
    if rows.is_empty() {
        ui.label("Nothing of this style has an error to speak of: it is computed as documented.");
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
    ui.weak("Errors with default settings, over all pixels of the scenes of docs/report; times are of now.");
    if !detectors.is_empty() {
        let now = [Pass::DepthRange, Pass::Outlines, Pass::Stylize]
            .map(|pass| medians[pass as usize])
            .iter()
            .sum();
        error_against_time(ui, &detectors, now, widgets);
    }
}

/// Every way of finding lines by its error and its time, the chosen ones filled,
/// and what the styles take now.
fn error_against_time(ui: &mut Ui, chosen: &[String], now: f64, widgets: &mut Widgets) {
    ui.add_space(4.0);
    ui.strong("Error of lines against run time");
    // Decades: a fast adapter and a slow one are on one chart.
    let place = |time: f64| time.max(1e-3).log10();
    let decades = |input: GridInput| {
        let (from, to) = input.bounds;
        let first = (from.floor().clamp(-4.0, 6.0)) as i32;
        let last = (to.ceil().clamp(-4.0, 6.0)) as i32;
        (first..=last)
            .flat_map(|decade| {
                [1.0f64, 2.0, 5.0].map(|step| GridMark {
                    value: f64::from(decade) + step.log10(),
                    // Every one has its label.
                    step_size: 1.0,
                })
            })
            .filter(|mark| (from..=to).contains(&mark.value))
            .collect::<Vec<_>>()
    };
    let quarters = |_: GridInput| {
        (0..=4)
            .map(|i| GridMark {
                value: 25.0 * f64::from(i),
                step_size: 25.0,
            })
            .collect::<Vec<_>>()
    };
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
        .x_axis_formatter(|mark, _| {
            let time = 10f64.powf(mark.value);
            let digits = (-mark.value.floor()).clamp(0.0, 4.0) as usize;
            format!("{time:.digits$} ms")
        })
        .y_axis_formatter(|mark, _| format!("{:.0} %", mark.value))
        .label_formatter(|name, value| {
            format!("{name}\n{:.3} ms\n{:.1} %", 10f64.powf(value.x), value.y)
        })
        .show(ui, |plot| {
            for detector in known::DETECTORS {
                let Some(lines) = known::lines(detector) else {
                    continue;
                };
                let is_chosen = chosen.iter().any(|name| name == detector);
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
                    plot.text(
                        Text::new(detector, PlotPoint::new(at[0], at[1] + 8.0), detector)
                            .color(color),
                    );
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
        "0 % draws every line and nothing else (1 − F₁). Dots: all of this crate's passes at \
         1280x720 on {}, filled where chosen; the red line: what they take now, here.",
        known::adapter()
    ));
}
