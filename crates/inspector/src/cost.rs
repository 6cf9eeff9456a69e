//! The page of costs: the time of every pass, which stages ran and which were
//! left out.

use bevy::ecs::{entity::Entity, world::World};
use bevy_egui::egui::{Color32, Grid, RichText, Sense, Ui, Vec2};
use egui_plot::{Line, Plot, PlotPoints};

use super::{Widgets, fields::section, note};
use crate::timing::{Pass, PassTimes};
use bevy_comics::{ComicsDiagnostics, diagnostics::StageOutcome};

/// The lines of the passes in the chart.
const COLORS: [Color32; Pass::ALL.len()] = [
    Color32::from_rgb(130, 130, 140),
    Color32::from_rgb(90, 170, 250),
    Color32::from_rgb(250, 160, 60),
    Color32::from_rgb(170, 170, 180),
    Color32::from_rgb(110, 110, 120),
    Color32::from_rgb(240, 80, 90),
    Color32::from_rgb(90, 90, 100),
];

/// The median time of every pass in milliseconds.
type Medians = [f64; Pass::ALL.len()];

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
        let medians: Medians =
            std::array::from_fn(|i| median(frames.iter().map(|frame| frame[i]).collect()));
        section(ui, "Time of the passes, all cameras together", |ui| {
            self.chart(ui, &frames, widgets);
            ui.weak(times.method().unwrap_or("Waiting for the first frame."));
            Grid::new("passes")
                .striped(true)
                .num_columns(3)
                .show(ui, |ui| {
                    for &pass in Pass::ALL {
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
            ui.weak("Medians of the frames in the chart. Bold: passes of bevy_comics.");
        });
        section(ui, "Stages that ran or were left out", |ui| {
            stages(ui, world, camera);
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
                for &pass in Pass::ALL {
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

/// The median; 0 if there are no values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// A dot in the color of a pass's line in the chart.
fn dot(ui: &mut Ui, color: Color32) {
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(12.0), Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, color);
}

fn stages(ui: &mut Ui, world: &World, camera: Entity) {
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let Some(stages) = diagnostics.cameras.get(&camera) else {
        ui.label("This camera has no effects.");
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
                    StageOutcome::RanWith(form) => {
                        ui.strong(stage.name());
                        ui.label(format!("ran ({form})"));
                    }
                    StageOutcome::Skipped(reason) => {
                        ui.weak(stage.name());
                        ui.weak(format!("left out: {reason}"));
                    }
                    _ => {
                        ui.weak(stage.name());
                    }
                }
                ui.end_row();
            }
        });
}
