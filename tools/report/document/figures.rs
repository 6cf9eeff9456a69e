//! The report's text: the main figure of each section that has no target, for the index.

use std::path::Path;

use super::{parts, soak};
use crate::{
    costs::costs,
    load,
    table::{Table, largest},
};

/// The main figure of a section, as text; `None` if it was not measured or has targets instead.
pub fn figure(section: &str, folder: &Path) -> Option<String> {
    match section {
        "ranges" => ranges(folder),
        "encodings" => encodings(folder),
        "steps" => steps(folder),
        "dash-steps" => dash_steps(folder),
        "meadow" => meadow(folder),
        "stability" => stability(folder),
        "scene-parts" => parts::figure(folder),
        "flicker" => flicker(folder),
        "soak" => soak::figure(folder),
        _ => None,
    }
}

/// The largest number of a column in the rows that have a cell.
fn worst(table: &Table, wanted: (&str, &str), column: &str) -> f64 {
    largest(&table.numbers(&table.matching(&[wanted]), column))
}

fn ranges(folder: &Path) -> Option<String> {
    let errors = load(folder, "range_errors").ok()?;
    let error = worst(&errors, ("method", "full"), "map");
    let times = load(folder, "range_times").ok()?;
    let costs = costs(&times, "ranges", "teapot", &["range"]);
    let blits = costs.iter().find(|cost| cost.name == "BarrierFree")?.ratio[1];
    let time = if blits.is_finite() {
        format!(", {blits:.2} blits")
    } else {
        String::new()
    };
    Some(format!("the exact range: error {error}{time}"))
}

fn encodings(folder: &Path) -> Option<String> {
    let errors = load(folder, "encoding_errors").ok()?;
    let of = |encoding| worst(&errors, ("encoding", encoding), "map");
    let [full, half, byte] = ["f32 depth", "f16 depth", "unorm8 depth"].map(of);
    Some(format!(
        "error of the depth map: {full:.1e} from 32 bits, {half:.1e} from 16, {byte:.1e} from 8"
    ))
}

/// The number of the default, and the least with the name of its setting.
fn default_and_best(numbers: &[(String, f64)]) -> Option<String> {
    let (_, default) = numbers.iter().find(|(name, _)| name == "the default")?;
    let (best, least) = numbers.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!(
        "for each 100 px of line, {default:.2} by default, {least:.2} with {best}"
    ))
}

fn steps(folder: &Path) -> Option<String> {
    let table = load(folder, "line_steps").ok()?;
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    let of = |step: String| {
        let rows = table.matching(&[("step", &step)]);
        let sum = |column| table.numbers(&rows, column).iter().sum::<f64>();
        let found = 100.0 * sum("fragments") / sum("line").max(1.0);
        (step, found)
    };
    let numbers: Vec<(String, f64)> = table.distinct(&all, "step").into_iter().map(of).collect();
    default_and_best(&numbers)
}

fn dash_steps(folder: &Path) -> Option<String> {
    let table = load(folder, "ink_dash_steps").ok()?;
    let of = |row: &Vec<String>| {
        let found = 50.0 * table.number(row, "ends") / table.number(row, "true").max(1.0);
        (table.cell(row, "method").to_owned(), found)
    };
    let numbers: Vec<(String, f64)> = table.rows.iter().map(of).collect();
    default_and_best(&numbers)
}

fn meadow(folder: &Path) -> Option<String> {
    let table = load(folder, "meadow_ink").ok()?;
    let has_budget = |row: &&Vec<String>| {
        table.cell(row, "form") != "faithful" && table.number(row, "budget") < 1.0
    };
    let rows: Vec<&Vec<String>> = table.rows.iter().filter(has_budget).collect();
    let [budget, free] = ["most", "most_free"].map(|column| largest(&table.numbers(&rows, column)));
    Some(format!(
        "at most {budget:.2} of any area with an ink budget, {free:.2} without"
    ))
}

fn stability(folder: &Path) -> Option<String> {
    let table = load(folder, "stability").ok()?;
    let ulp = worst(&table, ("kind", "depth map"), "ulp");
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    let wild: f64 = table.numbers(&all, "wild").iter().sum();
    Some(format!(
        "depth map: at most {ulp:.1} ulp off; {wild:.0} results are not finite"
    ))
}

fn flicker(folder: &Path) -> Option<String> {
    let table = load(folder, "flicker").ok()?;
    let [off, default] = ["off", "the default"].map(|variant| {
        let rows = table.matching(&[("variant", variant)]);
        table.numbers(&rows, "mean").iter().sum::<f64>() / rows.len().max(1) as f64
    });
    Some(format!(
        "mean change, in display codes: {off:.3} without smoothing, {default:.3} with it"
    ))
}
