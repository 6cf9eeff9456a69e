//! The plots of the report, from its tables.

use std::path::Path;

use plotters::prelude::*;

use crate::{
    costs::{GROWING, OWN, costs, growth_exponent, line_score, size},
    load,
    table::Table,
};

struct Plot<'a> {
    file: &'a str,
    title: &'a str,
    x: &'a str,
    y: &'a str,
    logarithmic: [bool; 2],
    /// Whether the points are joined by a line. Then a gray one shows growth in proportion.
    joined: bool,
}

/// A point and its label.
type Point = (f64, f64, String);

fn bounds(values: impl Iterator<Item = f64>, logarithmic: bool) -> (f64, f64) {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    if logarithmic {
        (low / 2.0, high * 3.0)
    } else {
        let space = 0.12 * (high - low).max(1e-6);
        ((low - space).max(0.0), high + 2.0 * space)
    }
}

fn scatter(folder: &Path, plot: &Plot, points: &[Point]) -> Result<(), String> {
    let points: Vec<&Point> = points
        .iter()
        .filter(|(x, y, _)| x.is_finite() && y.is_finite())
        .filter(|(x, y, _)| !(plot.logarithmic[0] && *x <= 0.0 || plot.logarithmic[1] && *y <= 0.0))
        .collect();
    if points.is_empty() {
        return Ok(());
    }
    // A logarithmic axis is a linear axis of logarithms: one kind of chart is enough.
    let on_axis = |value: f64, axis: usize| {
        if plot.logarithmic[axis] {
            value.log10()
        } else {
            value
        }
    };
    let range = |axis: usize| {
        let values = points.iter().map(|p| if axis == 0 { p.0 } else { p.1 });
        let (low, high) = bounds(values, plot.logarithmic[axis]);
        on_axis(low, axis)..on_axis(high, axis)
    };
    let path = folder.join(plot.file);
    let area = SVGBackend::new(&path, (760, 460)).into_drawing_area();
    let problem = |error: DrawingAreaErrorKind<_>| format!("{}: {error}", plot.file);
    area.fill(&WHITE).map_err(problem)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(plot.title, ("sans-serif", 20))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(76)
        .build_cartesian_2d(range(0), range(1))
        .map_err(problem)?;
    let label = |axis: usize| {
        move |value: &f64| {
            let value = match *value {
                // Powers of ten only.
                power if plot.logarithmic[axis] && (power - power.round()).abs() > 0.01 => {
                    return String::new();
                }
                power if plot.logarithmic[axis] => 10f64.powf(power),
                value => value,
            };
            if value != 0.0 && !(0.01..10_000.0).contains(&value.abs()) {
                format!("{value:.0e}")
            } else if value.abs() < 1.0 {
                format!("{value:.2}")
            } else {
                format!("{value:.1}")
            }
        }
    };
    let (x_label, y_label) = (label(0), label(1));
    chart
        .configure_mesh()
        .x_desc(plot.x)
        .y_desc(plot.y)
        .x_labels(8)
        .y_labels(8)
        .x_label_formatter(&x_label)
        .y_label_formatter(&y_label)
        .bold_line_style(RGBColor(225, 225, 225))
        .light_line_style(WHITE)
        .draw()
        .map_err(problem)?;
    let at = |p: &Point| (on_axis(p.0, 0), on_axis(p.1, 1));
    if plot.joined {
        let (x, y, _) = points[0];
        let proportional = points
            .iter()
            .map(|p| (on_axis(p.0, 0), on_axis(y * p.0 / x, 1)));
        let gray = RGBColor(150, 150, 150);
        chart
            .draw_series(LineSeries::new(proportional, &gray))
            .map_err(problem)?;
        chart
            .draw_series(LineSeries::new(points.iter().map(|p| at(p)), &BLUE))
            .map_err(problem)?;
    }
    chart
        .draw_series(points.iter().map(|p| Circle::new(at(p), 4, BLUE.filled())))
        .map_err(problem)?;
    // Labels move up or down until they cover no point and no earlier label.
    let circle = |point: &&Point| {
        let (x, y) = chart.backend_coord(&at(point));
        (x - 5, y - 6, 10)
    };
    let mut taken: Vec<(i32, i32, i32)> = points.iter().map(circle).collect();
    for point in &points {
        let (px, py) = chart.backend_coord(&at(point));
        let width = 6 * point.2.chars().count() as i32;
        let left = if px + 8 + width > 750 {
            px - 8 - width
        } else {
            px + 8
        };
        let is_free = |top: i32| {
            !taken
                .iter()
                .any(|(x, y, w)| (top - y).abs() < 13 && left < x + w && *x < left + width)
        };
        let top = [0, -13, 13, -26, 26, -39, 39, -52, 52]
            .into_iter()
            .map(|by| py - 6 + by)
            .find(|top| is_free(*top))
            .unwrap_or(py - 6);
        taken.push((left, top, width));
        area.draw(&Text::new(
            point.2.clone(),
            (left, top),
            ("sans-serif", 12).into_font(),
        ))
        .map_err(problem)?;
    }
    area.present().map_err(problem)
}

/// A label for times, with the adapter and the size of the pictures.
fn blits(machine: &Table, what: &str, times: &Table) -> String {
    let rows = machine.matching(&[("what", "adapter")]);
    let adapter = rows.first().map_or("", |row| machine.cell(row, "value"));
    let adapter = adapter.split(" (").next().unwrap_or_default();
    format!("{what}, blits ({adapter}, {})", size(times))
}

pub fn draw(folder: &Path) -> Result<(), String> {
    let machine = load(folder, "machine")?;
    let scores = load(folder, "line_scores")?;
    let times = load(folder, "line_times")?;
    let costs_of = costs(&times, "lines", "teapot", &OWN);
    let points: Vec<Point> = scores
        .values("detector")
        .into_iter()
        .filter_map(|name| {
            let cost = costs_of.iter().find(|c| c.name == name)?;
            let [_, _, f1] = line_score(&scores, &name, "every line");
            Some((cost.ratio[1], 1.0 - f1, name))
        })
        .collect();
    scatter(
        folder,
        &Plot {
            file: "lines.svg",
            title: "Lines: error against time",
            x: &blits(&machine, "time", &times),
            y: "1 - F1, every line of all scenes",
            logarithmic: [false, true],
            joined: false,
        },
        &points,
    )?;

    let (exponent, points) = growth_exponent(&load(folder, "growth_times")?, "pixels", GROWING);
    let points: Vec<Point> = points
        .into_iter()
        .map(|(x, y)| (x, y, format!("{y:.1} ms")))
        .collect();
    scatter(
        folder,
        &Plot {
            file: "growth.svg",
            title: &format!("Time of the default comic's passes: exponent {exponent:.2} (gray: 1)"),
            x: "pixels of the picture",
            y: "time, milliseconds",
            logarithmic: [true, true],
            joined: true,
        },
        &points,
    )?;

    let flicker = load(folder, "flicker")?;
    let points: Vec<Point> = flicker
        .values("variant")
        .into_iter()
        .map(|variant| {
            let rows = flicker.matching(&[("variant", &variant)]);
            let mean = |name| flicker.numbers(&rows, name).iter().sum::<f64>() / rows.len() as f64;
            (mean("lag"), mean("mean"), variant)
        })
        .collect();
    scatter(
        folder,
        &Plot {
            file: "flicker.svg",
            title: "Flicker against lag, mean over all sequences",
            x: "lag, octaves of distance",
            y: "flicker, display codes",
            logarithmic: [false, false],
            joined: false,
        },
        &points,
    )
}
