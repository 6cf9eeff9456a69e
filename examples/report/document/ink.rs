//! The report's text: how whole and how steady lines are.

use std::{fmt::Write, path::Path};

use super::targets::Target;
use crate::{load, table::Table};

/// Dashes per 100 pixels of true line. A dash has two ends.
fn dashes(table: &Table, method: &str, model: &str) -> f64 {
    let rows = table.matching(&[("method", method), ("model", model)]);
    let sum = |name| table.numbers(&rows, name).iter().sum::<f64>();
    50.0 * sum("ends") / sum("true").max(1.0)
}

/// The percentage of pixels that change.
fn changed(table: &Table, row: &[String]) -> f64 {
    100.0 * table.number(row, "changed") / table.number(row, "pixels").max(1.0)
}

pub fn ink(out: &mut String, folder: &Path) -> Result<(), String> {
    if !folder.join("ink_dashes.csv").exists() || !folder.join("ink_memory.csv").exists() {
        out.push_str("### Whole and steady lines\n\nNot measured yet: `report --only dashes` and `report --only memory`.\n\n");
        return Ok(());
    }
    let table = load(folder, "ink_dashes")?;
    out.push_str(
        "### Whole and steady lines\n\nDashes for each 100 pixels of true line, on the models \
         above and on two shapes while they turn: half of the ends of lines, where no other line begins. Those of \
         models are partly true: folds that fade out, rims that end on a surface. `cut` lines do not continue along weak edges (`continuity` 0, `specks` 1); where a line continues along a weak edge that ends inside a surface, it has one more end than without.\n\n\
         | | cut | continued |\n|---|---|---|\n",
    );
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    for model in table.distinct(&all, "model") {
        let of = |method| dashes(&table, method, &model);
        let _ = writeln!(
            out,
            "| {model} | {:.2} | {:.2} |",
            of("cut"),
            of("continued")
        );
    }
    let table = load(folder, "ink_memory")?;
    out.push_str(
        "\nA still view under the engine's temporal anti-aliasing, of a scene that is white except for its lines: pixels that change by more than two codes \
         from frame to frame, and the time of a whole frame.\n\n\
         | | | changed pixels | ms |\n|---|---|---|---|\n",
    );
    for row in &table.rows {
        let _ = writeln!(
            out,
            "| {} | {} | {:.4} % | {:.2} |",
            table.cell(row, "scene"),
            table.cell(row, "method"),
            changed(&table, row),
            table.number(row, "ms"),
        );
    }
    out.push('\n');
    Ok(())
}

pub fn targets(folder: &Path) -> Result<Vec<Target>, String> {
    if !folder.join("ink_dashes.csv").exists() || !folder.join("ink_memory.csv").exists() {
        return Ok(vec![]);
    }
    let table = load(folder, "ink_dashes")?;
    let rows: Vec<&Vec<String>> = table.rows.iter().collect();
    let shapes = table.distinct(&rows, "model");
    let mut all: Vec<Target> = shapes
        .into_iter()
        .map(|shape| {
            let what = format!("{shape}, turning: dashes per 100 px of line");
            Target::at_most(what, 0.5, Some(dashes(&table, "continued", &shape)))
        })
        .collect();
    let table = load(folder, "ink_memory")?;
    for row in table.matching(&[("method", "memory")]) {
        let scene = table.cell(row, "scene");
        let what = format!("{scene}: pixels that change under temporal anti-aliasing, %");
        all.push(Target::at_most(what, 0.01, Some(changed(&table, row))).with_digits(4));
    }
    Ok(all)
}
