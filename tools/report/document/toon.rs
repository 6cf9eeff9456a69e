//! The report's text: what the toon material costs.

use std::{fmt::Write, path::Path};

use super::target::Target;
use crate::{costs::size, load, table::Table};

/// The variant that the others are compared with.
const STANDARD: &str = "standard material";

/// The least time of a variant's main pass on a scene.
fn least(times: &Table, scene: &str, variant: &str) -> f64 {
    let rows = times.matching(&[("scene", scene), ("variant", variant)]);
    (times.numbers(&rows, "main").into_iter()).fold(f64::INFINITY, f64::min)
}

/// The main pass with the default ramp, compared with that of the standard material.
pub fn targets(folder: &Path) -> Vec<Target> {
    let Ok(times) = load(folder, "toon_times") else {
        return Vec::new();
    };
    let target = |scene: String| {
        let ratio = least(&times, &scene, "default ramp") / least(&times, &scene, STANDARD);
        let what = format!("{scene}: main pass with the toon material / with the standard one");
        Target::at_most("toon", what, 1.1, Some(ratio))
    };
    times.values("scene").into_iter().map(target).collect()
}

pub fn toon(out: &mut String, folder: &Path) -> Result<(), String> {
    // Reports of older runs do not have this table.
    let Ok(times) = load(folder, "toon_times") else {
        return Ok(());
    };
    let _ = writeln!(
        out,
        "### Toon material\n\n\
         The main pass of a scene at {}, with all of its meshes in one material after the other: the least time of all \
         rounds, and its ratio to that of the standard material. The theatre has a sun, a point light and a spot light, \
         the teapot a sun, all with shadow maps:\n",
        size(&times)
    );
    let scenes = times.values("scene");
    let mut head = String::from("| |");
    for scene in &scenes {
        let _ = write!(head, " {scene}, ms | ratio |");
    }
    let _ = writeln!(out, "{head}\n|---|{}", "---|---|".repeat(scenes.len()));
    for variant in times.values("variant") {
        let _ = write!(out, "| {variant} |");
        for scene in &scenes {
            let time = least(&times, scene, &variant);
            let ratio = time / least(&times, scene, STANDARD);
            let _ = write!(out, " {time:.2} | {ratio:.2} |");
        }
        out.push('\n');
    }
    out.push('\n');
    Ok(())
}
