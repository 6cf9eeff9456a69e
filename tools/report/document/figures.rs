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
    let times = load(folder, "range_times").ok()?;
    let costs = costs(&times, "ranges", "teapot", &["range"]);
    let blits = costs.iter().find(|cost| cost.name == "BarrierFree")?.ratio[1];
    (blits.is_finite()).then(|| format!("the exact range: {blits:.2} blits"))
}

fn stability(folder: &Path) -> Option<String> {
    let table = load(folder, "stability").ok()?;
    let ulp = worst(&table, ("kind", "depth map"), "ulp");
    let wild = table.sum(&table.matching(&[]), "wild");
    Some(format!(
        "depth map: at most {ulp:.1} ulp off; {wild:.0} results are not finite"
    ))
}

fn flicker(folder: &Path) -> Option<String> {
    let table = load(folder, "flicker").ok()?;
    let [off, default] = ["off", "the default"].map(|variant| {
        let rows = table.matching(&[("variant", variant)]);
        table.sum(&rows, "mean") / rows.len().max(1) as f64
    });
    Some(format!(
        "mean change, in display codes: {off:.3} without smoothing, {default:.3} with it"
    ))
}
