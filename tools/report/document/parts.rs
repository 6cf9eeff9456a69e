//! The report's text: what single parts cost.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, cost_table, costs, size},
    load,
    table::{Table, quantile},
};

/// Lines under temporal anti-aliasing: their section, and what is compared in it.
const TEMPORAL: &str = "part: temporal anti-aliasing";
const WITH_HISTORY: &str = "outlines; temporal anti-aliasing; history";
const WITHOUT_HISTORY: &str = "outlines; temporal anti-aliasing; no history";

/// Styles whose base is another one of their section.
const PAIRS: [[&str; 2]; 2] = [
    [WITH_HISTORY, WITHOUT_HISTORY],
    ["outlines; ink budget", "outlines; no ink budget"],
];

/// The laps in which parts of the scene cost time.
const LAPS_OF_PARTS: [&str; 4] = ["prepass", "range", "lines", "post"];

pub fn parts(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "part_times")?;
    let _ = writeln!(
        out,
        "### Single parts\n\n\
         Times of this crate's passes on the teapot at {}. Outlines of which one thing differs from the default:\n",
        size(&times)
    );
    // The layer of highlighted objects is drawn after the engine's prepass.
    for (section, before, laps) in [
        ("lines", "", &OWN[..]),
        (
            "page",
            "Effects of the page, each alone, and three together:\n\n",
            &OWN,
        ),
        (
            "marks",
            "All meshes marked with `SelectionOutline` or `XRayOutline`, on a camera without a style. The times include \
             the prepass of the marked meshes:\n\n",
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
    let sections = times.values("section");
    out.push_str(
        "What parts of the scene ask for, on the teapot if no other is named. The times include the prepass, but not \
         temporal anti-aliasing, since a camera without a style has it. Over the base: over the same style on the scene \
         without the part, or without the history of lines or the ink budget, timed in turn; the median, the least and the \
         most of the rounds. Under temporal anti-aliasing, a copy is lost in the noise (-). Differences below 10 ms may be \
         noise. The glass is the mesh with most vertices:\n\n\
         | | ms | blits | over the base, ms | least to most |\n|---|---|---|---|---|\n",
    );
    for section in sections.iter().filter(|name| name.starts_with("part: ")) {
        let rows = times.matching(&[("section", section)]);
        let base = section.replace("part: ", "base of: ");
        for scene in times.distinct(&rows, "scene") {
            for cost in costs(times, section, &scene, &LAPS_OF_PARTS) {
                if cost.name.starts_with("blit") {
                    continue;
                }
                let on = if scene == "teapot" {
                    String::new()
                } else {
                    format!(", on the {scene}")
                };
                let blits = match cost.ratio[1] {
                    ratio if ratio.is_finite() && section.as_str() != TEMPORAL => {
                        format!("{ratio:.2}")
                    }
                    _ => "-".to_owned(),
                };
                let over = over_base(times, [section, &base], &scene, &cost.name);
                let over = over.map_or_else(
                    || " | ".to_owned(),
                    |[least, middle, most]| format!("{middle:.2} | {least:.2} to {most:.2}"),
                );
                let _ = writeln!(
                    out,
                    "| {}{on} | {:.2} | {blits} | {over} |",
                    cost.name, cost.milliseconds
                );
            }
        }
    }
    out.push('\n');
}

/// Milliseconds of a variant over those of no style, in every round.
fn over_nothing(times: &Table, [section, scene, variant]: [&str; 3]) -> Vec<f64> {
    let own = |variant| {
        let rows = times.matching(&[("section", section), ("scene", scene), ("variant", variant)]);
        let sum = |row: &&Vec<String>| -> f64 {
            LAPS_OF_PARTS.iter().map(|lap| times.number(row, lap)).sum()
        };
        rows.iter().map(sum).collect::<Vec<f64>>()
    };
    let (own, nothing) = (own(variant), own("nothing"));
    own.iter().zip(&nothing).map(|(v, n)| v - n).collect()
}

/// By how many milliseconds a style costs more with a part than without: the least, the median and
/// the most of the rounds.
fn over_base(times: &Table, sections: [&str; 2], scene: &str, style: &str) -> Option<[f64; 3]> {
    let [part, base] = sections;
    let with = over_nothing(times, [part, scene, style]);
    let pair = PAIRS.iter().find(|[with, _]| *with == style);
    let without = match pair {
        Some([_, without]) => over_nothing(times, [part, scene, without]),
        None => over_nothing(times, [base, scene, style]),
    };
    if without.is_empty() {
        return None;
    }
    let over: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a - b).collect();
    Some([0.0, 0.5, 1.0].map(|q| quantile(&over, q)))
}

/// The part of a scene that adds most to the cost of a style.
pub fn figure(folder: &Path) -> Option<String> {
    let times = load(folder, "scene_part_times").ok()?;
    let mut most: Option<(String, f64)> = None;
    for section in times.values("section") {
        let Some(name) = section.strip_prefix("part: ") else {
            continue;
        };
        let base = format!("base of: {name}");
        let rows = times.matching(&[("section", &section)]);
        let style = if section == TEMPORAL {
            WITH_HISTORY
        } else {
            name
        };
        for scene in times.distinct(&rows, "scene") {
            let over = over_base(&times, [&section, &base], &scene, style);
            let middle = over.map_or(f64::NAN, |[_, middle, _]| middle);
            if middle.is_finite() && most.as_ref().is_none_or(|(_, known)| middle > *known) {
                most = Some((format!("{style}, on the {scene}"), middle));
            }
        }
    }
    let (name, middle) = most?;
    Some(format!("largest extra cost: {name}, {middle:.1} ms"))
}
