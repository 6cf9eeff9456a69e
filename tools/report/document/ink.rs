//! The report's text: how whole and how steady lines are.

use std::{fmt::Write, path::Path};

use bevy_comics_testkit::straight_edges::accepted;

use super::target::Target;
use crate::{load, table::Table};

/// Half of a number of ends per 100 pixels of true line: dashes, if they are all ends. `ends`:
/// the column that counts them.
fn dashes(table: &Table, [method, model, ends]: [&str; 3]) -> f64 {
    let rows = table.matching(&[("method", method), ("model", model)]);
    let sum = |name| table.sum(&rows, name);
    50.0 * sum(ends) / sum("true").max(1.0)
}

/// The percentage of pixels that change.
fn changed(table: &Table, row: &[String]) -> f64 {
    100.0 * table.number(row, "changed") / table.number(row, "pixels").max(1.0)
}

pub fn ink(out: &mut String, folder: &Path) -> Result<(), String> {
    if !folder.join("ink_dashes.csv").exists() || !folder.join("ink_history.csv").exists() {
        out.push_str("### Whole and steady lines\n\nNot measured yet: `report --only dashes` and `report --only history`.\n\n");
        return Ok(());
    }
    let table = load(folder, "ink_dashes")?;
    out.push_str(
        "### Whole and steady lines\n\n\
         Dashes for each 100 pixels of true line, on the models above and two shapes while they turn: half of the ends of \
         lines. `cut` lines do not continue along weak edges (`hysteresis` 0, `min_length` 1); a line that continues along \
         one that ends inside a surface has one end more. At true ends: within 2 pixels of the end of a true line, at four \
         times the resolution. By chance: the same after true ends are moved by 11 and 9 pixels.\n\n\
         | | cut | continued | of these at true ends | by chance |\n|---|---|---|---|---|\n",
    );
    for model in table.values("model") {
        let cells = [
            ("cut", "ends"),
            ("continued", "ends"),
            ("continued", "true_ends"),
            ("continued", "by_chance"),
        ]
        .map(|(method, ends)| {
            // Tables of older runs have only the first of these columns.
            if table.header.iter().any(|column| column == ends) {
                format!("{:.2}", dashes(&table, [method, &model, ends]))
            } else {
                "-".to_owned()
            }
        });
        let _ = writeln!(out, "| {model} | {} |", cells.join(" | "));
    }
    let table = load(folder, "ink_history")?;
    out.push_str(
        "\nA still, white scene with lines under the engine's temporal anti-aliasing: pixels that change by more than two \
         codes from frame to frame, and the time of a frame.\n\n\
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

/// The largest absolute number of a column.
fn most(table: &Table, rows: &[&Vec<String>], column: &str) -> f64 {
    let numbers = table.numbers(rows, column).into_iter();
    numbers.map(f64::abs).fold(0.0, f64::max)
}

/// Distances of drawn lines from edges, over what is accepted: the largest of some rows.
fn over_accepted(table: &Table, rows: &[&Vec<String>]) -> f64 {
    let ratio =
        |row: &&Vec<String>| table.number(row, "away") / accepted(table.number(row, "slope"));
    rows.iter().map(ratio).fold(0.0, f64::max)
}

/// The widths of lines that the section draws; the second is the default, and of an even number of
/// pixels: the middles of such lines are at their edges.
fn straight_widths(table: &Table) -> Vec<String> {
    table.values("width")
}

/// The text on straight lines.
pub fn straight(out: &mut String, folder: &Path) -> Result<(), String> {
    out.push_str("### Straight lines\n\n");
    if !folder.join("ink_straight.csv").exists() {
        out.push_str("Not measured yet: `report --only straight`.\n\n");
        return Ok(());
    }
    let table = load(folder, "ink_straight")?;
    out.push_str(
        "Lines along straight edges of 64 slopes, 1/64 to 1 row per column, at 16 offsets each, over 200 columns. Width: \
         the ink of a column times the cosine of the edge. Difference: the largest of the mean width of a line from the \
         width that was asked for. Area: the same of all lines of a slope, in percent. Unevenness: the standard deviation \
         of the width from column to column.\n\n\
         | px wide | difference, px | area, % | unevenness, px: mean | largest |\n|---|---|---|---|---|\n",
    );
    for width in straight_widths(&table) {
        let rows = table.matching(&[("width", &width)]);
        let uneven = table.numbers(&rows, "uneven");
        let _ = writeln!(
            out,
            "| {width} | {:.4} | {:.2} | {:.3} | {:.3} |",
            most(&table, &rows, "most"),
            area(&table, &rows, &width),
            uneven.iter().sum::<f64>() / uneven.len().max(1) as f64,
            most(&table, &rows, "uneven"),
        );
    }
    out.push_str(
        "\nHow far the middle of the ink of a line of 2 pixels is from its edge: the root mean square over all columns and \
         offsets, the largest of the slopes of a row. Part: of what is accepted, a tenth more than what is aimed at, or \
         than one run of steps can tell (`crates/testkit/src/straight_edges.rs`).\n\n\
         | slopes | px | part |\n|---|---|---|\n",
    );
    let rows = table.matching(&[("width", "2")]);
    let mut low = 0.0;
    for high in [0.125, 0.25, 0.5, 0.75, 0.94, 1.0] {
        let within = |row: &&&Vec<String>| {
            let slope = table.number(row, "slope");
            slope > low && slope <= high
        };
        let rows: Vec<&Vec<String>> = rows.iter().filter(within).copied().collect();
        if !rows.is_empty() {
            let _ = writeln!(
                out,
                "| {low} to {high} | {:.3} | {:.2} |",
                most(&table, &rows, "away"),
                over_accepted(&table, &rows),
            );
        }
        low = high;
    }
    out.push('\n');
    Ok(())
}

/// The largest difference of the area of a slope's lines, in percent of that of lines of `width`.
fn area(table: &Table, rows: &[&Vec<String>], width: &str) -> f64 {
    100.0 * most(table, rows, "mean") / width.parse().unwrap_or(f64::NAN)
}

fn straight_targets(folder: &Path) -> Result<Vec<Target>, String> {
    if !folder.join("ink_straight.csv").exists() {
        return Ok(vec![]);
    }
    let table = load(folder, "ink_straight")?;
    let mut all = vec![];
    for width in straight_widths(&table) {
        let rows = table.matching(&[("width", &width)]);
        let what =
            format!("straight lines of {width} px in 64 directions: difference of the width, px");
        let target = Target::at_most("straight", what, 0.02, Some(most(&table, &rows, "most")));
        all.push(target.with_digits(4));
    }
    for width in straight_widths(&table) {
        let rows = table.matching(&[("width", &width)]);
        let what = format!("straight lines of {width} px: area over 200 px, difference in %");
        let found = area(&table, &rows, &width);
        all.push(Target::at_most("straight", what, 0.5, Some(found)));
    }
    let rows = table.matching(&[("width", "2")]);
    all.push(
        Target::at_most(
            "straight",
            "straight lines of 2 px: unevenness of the width along a line, px",
            0.1,
            Some(most(&table, &rows, "uneven")),
        )
        .with_digits(3),
    );
    all.push(Target::at_most(
        "straight",
        "straight lines of 2 px: distance from the edge, as a part of what is accepted",
        1.0,
        Some(over_accepted(&table, &rows)),
    ));
    Ok(all)
}

pub fn targets(folder: &Path) -> Result<Vec<Target>, String> {
    if !folder.join("ink_dashes.csv").exists() || !folder.join("ink_history.csv").exists() {
        return straight_targets(folder);
    }
    let table = load(folder, "ink_dashes")?;
    let shapes = table.values("model");
    let mut all: Vec<Target> = shapes
        .into_iter()
        .map(|shape| {
            let what = format!("{shape}, turning: dashes per 100 px of line");
            let found = dashes(&table, ["continued", &shape, "ends"]);
            Target::at_most("dashes", what, 0.5, Some(found))
        })
        .collect();
    let table = load(folder, "ink_history")?;
    for row in table.matching(&[("method", "history")]) {
        let scene = table.cell(row, "scene");
        let what = format!("{scene}: pixels that change under temporal anti-aliasing, %");
        let target = Target::at_most("history", what, 0.01, Some(changed(&table, row)));
        all.push(target.with_digits(4));
    }
    all.extend(straight_targets(folder)?);
    Ok(all)
}
