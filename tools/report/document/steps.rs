//! The report's text: lines when one step of finding and linking them is changed.

use std::{fmt::Write, path::Path};

use crate::{load, table::Table};

/// A table of one quotient, in percent: a row for each subject, a column for each step.
fn quotients(out: &mut String, table: &Table, [part, whole]: [&str; 2], digits: usize) {
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    let steps = table.distinct(&all, "step");
    let _ = writeln!(
        out,
        "| | {} |\n|---|{}",
        steps.join(" | "),
        "---|".repeat(steps.len())
    );
    for subject in table.distinct(&all, "subject") {
        for distance in ["", "close", "distant"] {
            let of = |step: &String| {
                let wanted = [
                    ("subject", subject.as_str()),
                    ("distance", distance),
                    ("step", step.as_str()),
                ];
                let row = *table.matching(&wanted).first()?;
                let whole = table.number(row, whole);
                (whole > 0.0).then(|| 100.0 * table.number(row, part) / whole)
            };
            let Some(found) = steps.iter().map(of).collect::<Option<Vec<f64>>>() else {
                continue;
            };
            let cells: Vec<String> = found.iter().map(|x| format!("{x:.digits$}")).collect();
            let name = [subject.as_str(), distance].join(" ");
            let _ = writeln!(out, "| {} | {} |", name.trim(), cells.join(" | "));
        }
    }
    out.push('\n');
}

pub fn steps(out: &mut String, folder: &Path) -> Result<(), String> {
    out.push_str("### One step changed at a time\n\n");
    if !folder.join("line_steps.csv").exists() {
        out.push_str("Not measured yet: `report --only steps`.\n\n");
        return Ok(());
    }
    let table = load(folder, "line_steps")?;
    out.push_str(
        "Parts of at most six pixels for each 100 pixels of thin lines, on models at six angles (960x544) and \
         in the mountains (960x540), all without the ink budget. A column differs from the default \
         in what it names: `steps` is the threshold of silhouettes, `folds` the angle of creases.\n\n",
    );
    quotients(out, &table, ["fragments", "line"], 3);
    out.push_str(
        "True pixels that have a line at most one pixel away, in percent (240x136). That many \
         lines a change would cost or gain:\n\n",
    );
    quotients(out, &table, ["found", "true"], 1);
    Ok(())
}
