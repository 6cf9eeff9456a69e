//! The report's text: many objects.

use std::{fmt::Write, path::Path};

use crate::{
    load,
    table::{Table, exponent, median},
};

/// The variant that the others are compared with.
const PREPASSES: &str = "depth and normal prepass";

/// The median of a column, in milliseconds.
fn of(times: &Table, objects: &str, variant: &str, column: &str) -> f64 {
    let rows = times.matching(&[("objects", objects), ("variant", variant)]);
    median(&times.numbers(&rows, column))
}

/// How the time of a frame grows with the objects, less that of a frame with one object.
fn growth(times: &Table, counts: &[String], variant: &str) -> f64 {
    let whole = |objects: &str| of(times, objects, variant, "whole");
    let Some((empty, counts)) = counts.split_first() else {
        return f64::NAN;
    };
    let empty = whole(empty);
    let points = counts.iter().filter_map(|objects| {
        let count: f64 = objects.parse().ok()?;
        Some((count, whole(objects) - empty)).filter(|(_, ms)| ms.is_finite())
    });
    exponent(&points.collect::<Vec<_>>())
}

pub fn many_objects(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "many_objects_times")?;
    let all: Vec<&Vec<String>> = times.rows.iter().collect();
    let counts = times.distinct(&all, "objects");
    let variants = times.distinct(&all, "variant");
    out.push_str(
        "### Many objects\n\nWhole frames of 64x64 pixels, in milliseconds, with cubes that share \
         a mesh and a material. The last column is the exponent with which a frame grows, less a \
         frame with one object.\n\n| frame |",
    );
    for count in &counts {
        let _ = write!(out, " {count} |");
    }
    let _ = writeln!(out, " exponent |\n|---|{}---|", "---|".repeat(counts.len()));
    for variant in &variants {
        let _ = write!(out, "| {variant} |");
        for count in &counts {
            let whole = of(&times, count, variant, "whole");
            let _ = match whole.is_finite() {
                true => write!(out, " {whole:.1} |"),
                false => write!(out, " - |"),
            };
        }
        let _ = writeln!(out, " {:.2} |", growth(&times, &counts, variant));
    }
    out.push_str(
        "\nOutlines beside the engine's depth and normal prepass, and the time that queueing and \
         batching take on the CPU, of the engine and of object ids together:\n\n\
         | objects | outlines / prepasses | queue, prepasses, ms | queue, outlines, ms | batch, \
         prepasses, ms | batch, outlines, ms |\n|---|---|---|---|---|---|\n",
    );
    for count in &counts {
        let whole = |variant| of(&times, count, variant, "whole");
        let [before, with] = [PREPASSES, "outlines"]
            .map(|variant| ["queue", "batch"].map(|stage| of(&times, count, variant, stage)));
        let _ = writeln!(
            out,
            "| {count} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
            whole("outlines") / whole(PREPASSES),
            before[0],
            with[0],
            before[1],
            with[1],
        );
    }
    let materials = times.matching(&[("variant", "idle; 1000 toon scenes")]);
    let materials = times.numbers(&materials, "toon_materials");
    let most = materials.into_iter().fold(0.0, f64::max);
    let _ = writeln!(
        out,
        "\nToon materials of 1000 equal toon scenes: {most:.0}.\n"
    );
    Ok(())
}
