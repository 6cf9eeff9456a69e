//! The report's text: the long run.

use std::{fmt::Write, path::Path};

use bevy_comics_testkit::soak::{CYCLE, WARM_UP};

use crate::{load, table::Table};

/// The part of the numbers after the warm-up that the mean of an end is taken of.
const END: usize = 10;

/// The mean of the first and of the last cycles after the warm-up.
fn ends(numbers: &[f64]) -> Option<[f64; 2]> {
    let count = END.min(numbers.len() / 2);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    (count > 0).then(|| {
        [
            mean(&numbers[..count]),
            mean(&numbers[numbers.len() - count..]),
        ]
    })
}

/// How much of a column there was in the first four cycles after the warm-up, and in the last four: the
/// four kinds of views.
fn counts(table: &Table, name: &str) -> [f64; 2] {
    let numbers: Vec<f64> = table
        .rows
        .iter()
        .map(|row| table.number(row, name))
        .collect();
    let settled = &numbers[(WARM_UP as usize).min(numbers.len() - 1)..];
    let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
    let kinds = (WARM_UP as usize).min(settled.len());
    [
        most(&settled[..kinds]),
        most(&settled[settled.len() - kinds..]),
    ]
}

/// The memory of the process in MiB after the warm-up and at the end.
fn memory(table: &Table) -> Option<[f64; 2]> {
    let resident: Vec<f64> = (table.rows.iter().skip(WARM_UP as usize))
        .filter(|row| !table.cell(row, "resident KiB").is_empty())
        .map(|row| table.number(row, "resident KiB") / 1024.0)
        .collect();
    ends(&resident)
}

/// How much the memory grows, and how often the renderer fails.
pub fn figure(folder: &Path) -> Option<String> {
    let table = load(folder, "soak").ok()?;
    let last = table.rows.last()?;
    let growth = memory(&table).map_or_else(String::new, |[first, last]| {
        format!("memory {:+.2} %, ", 100.0 * (last / first - 1.0))
    });
    Some(format!(
        "{} frames: {growth}{} errors of the renderer",
        table.cell(last, "frame"),
        table.cell(last, "errors")
    ))
}

pub fn soak(out: &mut String, folder: &Path) -> Result<(), String> {
    let Ok(table) = load(folder, "soak") else {
        out.push_str(
            "## 7. A long run\n\nNot measured yet: `report --only soak`, a command of its own.\n\n",
        );
        return Ok(());
    };
    let last = table.rows.last().ok_or("soak.csv is empty")?;
    let _ = writeln!(
        out,
        "## 7. A long run\n\n{} frames of 1 to 128 pixels a side. In every {CYCLE} of them a camera changes \
         its size 60 times, 20 objects come and go, and a style file breaks and is mended. Looks are not \
         changed: lavapipe compiles shaders again for each, and keeps the memory. Errors of the renderer: \
         {}.\n\n| | after {} frames | at the end |\n|---|---|---|",
        table.cell(last, "frame"),
        table.cell(last, "errors"),
        WARM_UP * CYCLE,
    );
    if let Some([first, last]) = memory(&table) {
        let _ = writeln!(
            out,
            "| memory of the process, MiB (means of {END} cycles) | {first:.1} | {last:.1} ({:+.2} %) |",
            100.0 * (last / first - 1.0)
        );
    }
    for name in table.header.iter().skip(3) {
        let [first, last] = counts(&table, name);
        let _ = writeln!(out, "| {name} | {first:.0} | {last:.0} |");
    }
    out.push('\n');
    Ok(())
}
