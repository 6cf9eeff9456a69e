//! The report's text: what single parts cost.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, cost_table, costs, size},
    load,
};

pub fn parts(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "part_times")?;
    let _ = writeln!(
        out,
        "### Single parts\n\nTimes of this crate's passes on the teapot at {}. Outlines of which one thing \
         differs from the default:\n",
        size(&times)
    );
    for (section, before) in [
        ("lines", ""),
        (
            "page",
            "Effects of the page, each alone, and three together:\n\n",
        ),
        (
            "marks",
            "All meshes marked with `SelectionOutline` or `XRayOutline`, on a camera without a \
             style. The layer of marked objects, which is drawn with the engine's meshes, is \
             part of the time:\n\n",
        ),
    ] {
        out.push_str(before);
        cost_table(out, &costs(&times, section, "teapot", &OWN));
    }
    Ok(())
}
