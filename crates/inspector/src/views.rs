//! The page of debug views, the depth range and the histogram of depths.

use bevy::ecs::{component::Component, entity::Entity, query::With, world::World};
use bevy_egui::egui::{Color32, Grid, Pos2, Sense, Ui};
use egui_plot::{Bar, BarChart, Plot, PlotPoint, VLine};

use super::{Widgets, fields::section, layer_borders::PlaneCuts, note};
use bevy_comics::{
    ComicStyle,
    depth::{DepthBin, DepthHistogram, VisibleDepthRange},
    diagnostics::DebugView,
    effect::{EffectRegistry, EffectType},
};

/// A camera whose depth range the panel reads, and which of the components for it
/// the panel has inserted.
#[derive(Component)]
struct Probed {
    range: bool,
    histogram: bool,
}

/// The label of a view, and what it shows.
fn describe(view: DebugView, types: &[&EffectType]) -> (&'static str, &'static str) {
    match view {
        DebugView::DepthMap => ("Depth map", "Black is near, white is far."),
        DebugView::RawRange => (
            "Raw range",
            "The depth buffer, scaled to the range: white is near.",
        ),
        DebugView::Silhouettes => ("Silhouettes", "Black: a full line."),
        DebugView::Creases => ("Creases", "Black: a full line."),
        DebugView::ObjectIds => ("Object ids", "One color for each object. Black: no object."),
        DebugView::Saturation => ("Saturation mask", "White: full saturation. Black: none."),
        DebugView::Difference => (
            "Difference from the original",
            "Absolute difference of the display colors, four times as bright.",
        ),
        DebugView::Effect(name) => types
            .iter()
            .find(|effect| effect.name == name)
            .and_then(|effect| effect.view)
            .map_or((name, ""), |view| (view.label, view.explanation)),
        _ => ("Another view", ""),
    }
}

pub fn show(
    ui: &mut Ui,
    world: &mut World,
    camera: Entity,
    style: &mut ComicStyle,
    widgets: &mut Widgets,
) {
    probe(world, camera);
    let types = world.resource::<EffectRegistry>().types();
    let of_effects = types
        .iter()
        .filter(|effect| effect.view.is_some())
        .map(|effect| DebugView::Effect(effect.name));
    let choices: Vec<DebugView> = DebugView::SHARED
        .iter()
        .copied()
        .chain(of_effects)
        .collect();
    let mut entity = world.entity_mut(camera);
    let before = entity.get::<DebugView>().copied();
    let mut view = before;
    section(ui, "Debug view", |ui| {
        let none = ui.radio_value(&mut view, None, "None: the picture");
        note(widgets, "view.none", &none);
        for choice in choices {
            let (label, explanation) = describe(choice, &types);
            let enabled = cfg!(feature = "objects") || choice != DebugView::ObjectIds;
            ui.add_enabled_ui(enabled, |ui| {
                let radio = ui.radio_value(&mut view, Some(choice), label);
                let name = match choice {
                    DebugView::Effect(name) => name.to_owned(),
                    shared => format!("{shared:?}"),
                };
                note(widgets, format!("view.{name}"), &radio);
                radio.on_hover_text(explanation);
            });
        }
        if let Some(view) = view {
            ui.weak(describe(view, &types).1);
        }
    });
    if view != before {
        match view {
            Some(view) => entity.insert(view),
            None => entity.remove::<DebugView>(),
        };
    }
    let range = entity
        .get::<VisibleDepthRange>()
        .copied()
        .unwrap_or_default();
    let histogram = entity.get::<DepthHistogram>().cloned().unwrap_or_default();
    section(ui, "Depth range", |ui| numbers(ui, range, histogram.drawn));
    let cuts = PlaneCuts::of(world, camera, style, &histogram);
    section(ui, "Histogram of visible depths", |ui| {
        plot(ui, &histogram, (cuts, style), widgets);
    });
    ui.ctx().request_repaint();
}

/// The table of the range, measured and `drawn` with.
fn numbers(ui: &mut Ui, range: VisibleDepthRange, drawn: Option<(f32, f32)>) {
    let text = |pair: Option<(f32, f32)>| match pair {
        Some((near, far)) => [format!("{near:.3}"), format!("{far:.3}")],
        None => ["-".to_owned(), "-".to_owned()],
    };
    let raw = match range {
        VisibleDepthRange::Visible {
            raw_nearest,
            raw_farthest,
            ..
        } => [format!("{raw_nearest:.6}"), format!("{raw_farthest:.6}")],
        _ => text(None),
    };
    Grid::new("range").striped(true).show(ui, |ui| {
        ui.label("");
        ui.strong("nearest");
        ui.strong("farthest");
        ui.end_row();
        for (name, [near, far]) in [
            ("visible, world units", text(range.distances())),
            ("used for drawing, world units", text(drawn)),
            ("visible, raw depth", raw),
        ] {
            ui.label(name);
            ui.monospace(near);
            ui.monospace(far);
            ui.end_row();
        }
    });
    match range {
        VisibleDepthRange::Pending => ui.weak("Not measured yet."),
        VisibleDepthRange::Empty => ui.weak("No opaque geometry is visible."),
        VisibleDepthRange::Visible { .. } => ui.weak("Distances along the camera's forward axis."),
        _ => ui.weak("Not known."),
    };
}

/// Whether the bins can be drawn on a logarithmic axis.
fn is_logarithmic(bins: &[DepthBin]) -> bool {
    bins.iter().all(|bin| bin.near > 0.0 && bin.far.is_finite())
}

/// Columns of a chart.
const COLUMNS: usize = 64;

/// Equally wide columns of the chart: left and right end on the axis, percentage of the
/// samples. Bins differ in width, and a bin's height would say nothing of how many
/// samples lie at a distance. `place` is the position of a distance on the axis.
fn columns(bins: &[DepthBin], place: impl Fn(f32) -> f64) -> Vec<[f64; 3]> {
    let (Some(first), Some(last)) = (bins.first(), bins.last()) else {
        return Vec::new();
    };
    let (start, end) = (place(first.near), place(last.far));
    let width = ((end - start) / COLUMNS as f64).max(1e-9);
    let total: f64 = bins.iter().map(|bin| f64::from(bin.count)).sum();
    let mut columns: Vec<[f64; 3]> = (0..COLUMNS)
        .map(|i| [i, i + 1].map(|i| start + width * i as f64))
        .map(|[left, right]| [left, right, 0.0])
        .collect();
    for bin in bins {
        let percent = 100.0 * f64::from(bin.count) / total.max(1.0);
        let (near, far) = (place(bin.near), place(bin.far));
        let column = |at: f64| (((at - start) / width) as usize).min(COLUMNS - 1);
        let (from, to) = (column(near), column(far));
        for column in &mut columns[from..=to] {
            let inside = far.min(column[1]) - near.max(column[0]);
            let part = inside / (far - near);
            column[2] += if from == to {
                percent
            } else {
                percent * part.clamp(0.0, 1.0)
            };
        }
    }
    columns
}

/// The bars of these columns.
fn bar_chart(columns: &[[f64; 3]]) -> BarChart {
    let bar = |[left, right, percent]: &[f64; 3]| {
        Bar::new(0.5 * (left + right), *percent).width((right - left).max(1e-9))
    };
    let bars = columns.iter().map(bar).collect();
    BarChart::new("fraction of the pixels, in 64 columns", bars).color(Color32::LIGHT_BLUE)
}

/// The chart of the histogram.
fn plot(
    ui: &mut Ui,
    histogram: &DepthHistogram,
    (cuts, style): (Option<PlaneCuts>, &mut ComicStyle),
    widgets: &mut Widgets,
) {
    if histogram.bins.is_empty() {
        ui.weak("No depths: nothing is visible, or the adapter has no compute shaders.");
        return;
    }
    let logarithmic = is_logarithmic(&histogram.bins);
    let place = move |distance: f64| match logarithmic {
        true => distance.log10(),
        false => distance.clamp(-1e9, 1e9),
    };
    let bars = columns(&histogram.bins, |distance| place(f64::from(distance)));
    let distance = move |x: f64| if logarithmic { 10f64.powf(x) } else { x };
    let pair = |(near, far): (f32, f32)| [near, far].map(f64::from);
    let drawn_cuts = match &cuts {
        Some(cuts) => Some(cuts.distances),
        None => histogram.borders.map(pair),
    };
    let shown = Plot::new("depths")
        .height(140.0)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .sense(Sense::hover())
        .include_y(0.0)
        .x_axis_formatter(move |mark, _| format!("{:.3}", distance(mark.value)))
        .y_axis_formatter(|mark, _| format!("{:.0} %", mark.value))
        .show(ui, |plot| {
            plot.bar_chart(bar_chart(&bars));
            let range = Color32::from_rgb(230, 90, 70);
            let borders = Color32::from_rgb(240, 200, 90);
            for (ends, names, color) in [
                (histogram.drawn.map(pair), ["nearest", "farthest"], range),
                (drawn_cuts, ["end of near", "start of far"], borders),
            ] {
                for (name, at) in names.into_iter().zip(ends.into_iter().flatten()) {
                    plot.vline(VLine::new(name, place(at)).color(color).width(2.0));
                }
            }
        });
    note(widgets, "histogram", &shown.response);
    if let Some(cuts) = cuts {
        let transform = shown.transform;
        let x_of = |z| {
            transform
                .position_from_point(&PlotPoint::new(place(z), 0.0))
                .x
        };
        let distance_of = |x| distance(transform.value_from_position(Pos2::new(x, 0.0)).x);
        cuts.drag(ui, (*transform.frame(), x_of, distance_of), style, widgets);
    }
    ui.weak(
        "Distance in world units. Red: the range that is used for drawing. Yellow: where near, \
         middle and far meet; drag a line, or move it with the arrow keys, to fix both.",
    );
}

/// Reads the depth range of this camera, and of no other.
fn probe(world: &mut World, camera: Entity) {
    let others: Vec<Entity> = world
        .query_filtered::<Entity, With<Probed>>()
        .iter(world)
        .filter(|entity| *entity != camera)
        .collect();
    for other in others {
        unprobe(world, other);
    }
    let mut entity = world.entity_mut(camera);
    if entity.contains::<Probed>() {
        return;
    }
    let probed = Probed {
        range: !entity.contains::<VisibleDepthRange>(),
        histogram: !entity.contains::<DepthHistogram>(),
    };
    if probed.range {
        entity.insert(VisibleDepthRange::default());
    }
    if probed.histogram {
        entity.insert(DepthHistogram::default());
    }
    entity.insert(probed);
}

fn unprobe(world: &mut World, camera: Entity) {
    let mut entity = world.entity_mut(camera);
    let Some(probed) = entity.take::<Probed>() else {
        return;
    };
    if probed.range {
        entity.remove::<VisibleDepthRange>();
    }
    if probed.histogram {
        entity.remove::<DepthHistogram>();
    }
}

/// Stops reading depth ranges.
pub fn leave(world: &mut World) {
    let cameras: Vec<Entity> = world
        .query_filtered::<Entity, With<Probed>>()
        .iter(world)
        .collect();
    for camera in cameras {
        unprobe(world, camera);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_equally_wide_and_lose_no_sample() {
        // A narrow bin with half of the samples, then wide ones.
        let bins = [(0.0, 0.001, 50), (0.001, 30.0, 30), (30.0, 64.0, 20)]
            .map(|(near, far, count)| DepthBin { near, far, count });
        let columns = columns(&bins, f64::from);
        let percent = |range: std::ops::Range<usize>| {
            columns[range].iter().map(|column| column[2]).sum::<f64>()
        };
        assert!((percent(0..64) - 100.0).abs() < 1e-3, "{}", percent(0..64));
        assert!((percent(0..1) - 51.0).abs() < 0.01, "{:?}", columns[0]);
        assert!((percent(1..30) - 29.0).abs() < 0.01, "{}", percent(1..30));
        assert!(columns.iter().all(|[a, b, _]| (b - a - 1.0).abs() < 1e-9));
        // All geometry at one distance.
        let wall = [DepthBin {
            near: 7.0,
            far: 7.0,
            count: 3,
        }];
        let columns = super::columns(&wall, f64::from);
        assert!((columns.iter().map(|c| c[2]).sum::<f64>() - 100.0).abs() < 1e-9);
    }
}
