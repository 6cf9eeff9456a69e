//! The report's text: what single parts cost.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{Cost, OWN, cost_table, costs, size},
    load,
    table::Table,
};

/// The laps in which parts of the scene cost time.
const LAPS_OF_PARTS: [&str; 4] = ["prepass", "range", "lines", "post"];

pub fn parts(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "part_times")?;
    let _ = writeln!(
        out,
        "### Single parts\n\nTimes of this crate's passes on the teapot at {}. Outlines of which one thing \
         differs from the default:\n",
        size(&times)
    );
    // The layer of marked objects is drawn after the engine's prepass.
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
            &LAPS_OF_PARTS,
        ),
    ] {
        out.push_str(before);
        cost_table(out, &costs(&times, section, "teapot", laps));
    }
    scene_parts(out, &load(folder, "scene_part_times")?);
    Ok(())
}

/// The costs of what parts of the scene ask for, each from a scene of its own.
fn scene_parts(out: &mut String, times: &Table) {
    let all: Vec<&Vec<String>> = times.rows.iter().collect();
    let sections = times.distinct(&all, "section");
    let parts = sections.iter().filter(|name| name.starts_with("part: "));
    let mut found: Vec<Cost> = Vec::new();
    for section in parts {
        let rows = times.matching(&[("section", section)]);
        for scene in times.distinct(&rows, "scene") {
            let mut of_scene = costs(times, section, &scene, &LAPS_OF_PARTS);
            for cost in of_scene.iter_mut().filter(|_| scene != "teapot") {
                cost.name = format!("{}, on the {scene}", cost.name);
            }
            found.extend(of_scene);
        }
    }
    out.push_str(
        "What parts of the scene ask for, each on a scene of its own, which is the teapot if no \
         other is named. The times include the prepass, which a camera without a style does not \
         have; that of temporal anti-aliasing, and its own pass, are left out, since a camera \
         without a style has them. The glass is the mesh with most vertices:\n\n",
    );
    cost_table(out, &found);
}
