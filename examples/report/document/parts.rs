//! The report's text: what single parts cost.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{Cost, OWN, cost_table, costs, size},
    load,
    table::Table,
};

pub fn parts(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "part_times")?;
    let _ = writeln!(
        out,
        "### Single parts\n\nTimes of this crate's passes on the teapot at {}. Outlines of which one thing \
         differs from the default:\n",
        size(&times)
    );
    // The layer of marked objects is drawn after the engine's prepass.
    let with_prepass = ["prepass", "range", "lines", "post"];
    for (section, before, laps) in [
        ("lines", "", &OWN[..]),
        (
            "page",
            "Effects of the page, each alone, and three together:\n\n",
            &OWN,
        ),
        (
            "marks",
            "All meshes marked with `SelectionOutline` or `XRayOutline`, on a camera without a \
             style. The times include the prepass of the marked meshes:\n\n",
            &with_prepass,
        ),
    ] {
        out.push_str(before);
        cost_table(out, &costs(&times, section, "teapot", laps));
    }
    scene_parts(out, &times);
    Ok(())
}

/// The costs of what parts of the scene ask for, each from a scene of its own. Tables of older
/// runs do not have them.
fn scene_parts(out: &mut String, times: &Table) {
    let all: Vec<&Vec<String>> = times.rows.iter().collect();
    let sections = times.distinct(&all, "section");
    let parts = sections.iter().filter(|name| name.starts_with("part: "));
    let laps = ["prepass", "range", "lines", "post"];
    let found = parts.flat_map(|section| costs(times, section, "teapot", &laps));
    let found: Vec<Cost> = found.collect();
    if found.is_empty() {
        return;
    }
    out.push_str(
        "What parts of the scene ask for, each on a scene of its own. The times include the \
         prepass, which a camera without a style does not have. The glass is the mesh with most \
         vertices:\n\n",
    );
    cost_table(out, &found);
}
