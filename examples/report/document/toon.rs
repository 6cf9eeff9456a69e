//! The report's text: what the cartoon material costs.

use std::{fmt::Write, path::Path};

use crate::{costs::size, load};

pub fn toon(out: &mut String, folder: &Path) -> Result<(), String> {
    // Reports of older runs do not have this table.
    let Ok(times) = load(folder, "toon_times") else {
        return Ok(());
    };
    let _ = writeln!(
        out,
        "### Cartoon material\n\nThe main pass of a scene at {}, with all of its meshes in one \
         material after the other. The least time of all rounds, and its ratio to that of the \
         standard material. The theatre has a sun, a point light and a spot light, the teapot a \
         sun; all have shadow maps:\n",
        size(&times)
    );
    let all: Vec<&Vec<String>> = times.rows.iter().collect();
    let scenes = times.distinct(&all, "scene");
    let least = |scene: &str, variant: &str| {
        let rows = times.matching(&[("scene", scene), ("variant", variant)]);
        (times.numbers(&rows, "main").into_iter()).fold(f64::INFINITY, f64::min)
    };
    let mut head = String::from("| |");
    for scene in &scenes {
        let _ = write!(head, " {scene}, ms | ratio |");
    }
    let _ = writeln!(out, "{head}\n|---|{}", "---|---|".repeat(scenes.len()));
    for variant in times.distinct(&all, "variant") {
        let _ = write!(out, "| {variant} |");
        for scene in &scenes {
            let time = least(scene, &variant);
            let ratio = time / least(scene, "standard material");
            let _ = write!(out, " {time:.2} | {ratio:.2} |");
        }
        out.push('\n');
    }
    out.push('\n');
    Ok(())
}
