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
    Ok(())
}
