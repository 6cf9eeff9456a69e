//! The report's text: the long run.

use std::{fmt::Write, path::Path};

use bevy_comics_testkit::soak::{CYCLE, WARM_UP};

use crate::{
    load,
    soak::{END, FIRST_RESOURCE, MOST_GROWTH, counts, ends, growth, resident},
    table::Table,
};

/// What is left out of the run, and why.
const EXCEPTIONS: &str = "Two things that grow are not this crate's, and are left out:\n\n\
     - Bevy 0.19.1 keeps bind groups of cameras that are gone (`BinUnpackingBindGroups`): three for \
     each, six with a prepass, with this crate or without. The run removes them after each frame \
     (`forget_gone_views` in `crates/testkit/src/soak.rs`).\n- The first camera keeps one look, since \
     lavapipe compiles shaders again for each change of looks and keeps the memory. `SOAK=looks` \
     changes nothing else, and an empty `SOAK` everything; a short test changes looks and counts the \
     resources of the GPU.\n\n";

/// How much the memory grows, and how often the renderer fails.
pub fn figure(folder: &Path) -> Option<String> {
    let table = load(folder, "soak").ok()?;
    let last = table.rows.last()?;
    let growth = ends(&resident(&table)).map_or_else(String::new, |[first, last]| {
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
        "## 7. A long run\n\n\
         {} frames of 1 to 128 pixels a side. In every {CYCLE} of them a camera with a look changes its size 60 times, \
         another one comes and goes, 20 objects come and go, the scene takes the toon material and loses it, and a style \
         file breaks and is mended; samples and HDR change from one to the next. Errors of the renderer: {}.\n",
        table.cell(last, "frame"),
        table.cell(last, "errors"),
    );
    out.push_str(EXCEPTIONS);
    numbers(out, &table);
    Ok(())
}

/// Memory and resources, at either end.
fn numbers(out: &mut String, table: &Table) {
    let _ = writeln!(
        out,
        "| | after {} frames | at the end |\n|---|---|---|",
        WARM_UP * CYCLE
    );
    if let Some([first, last]) = ends(&resident(table)) {
        let _ = writeln!(
            out,
            "| memory of the process, MiB (means of {END} cycles) | {first:.1} | {last:.1} ({:+.2} %) |",
            100.0 * (last / first - 1.0)
        );
    }
    for name in table.header.iter().skip(FIRST_RESOURCE) {
        let [first, last] = counts(table, name);
        let _ = writeln!(out, "| {name} | {first:.0} | {last:.0} |");
    }
    out.push('\n');
    if let Some(growth) = growth(table) {
        let _ = writeln!(
            out,
            "Memory grew by {growth:.2} % over the second half. `report --only soak` fails from {MOST_GROWTH:.0} % on, if \
             there is more of any resource at the end, and after any error.\n"
        );
    }
}
