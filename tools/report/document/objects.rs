//! The report's text: many objects.

use std::{fmt::Write, path::Path};

use crate::{
    load,
    table::{Table, exponent, median},
};

/// The variant that the others are compared with.
const PREPASSES: &str = "depth and normal prepass";
/// The least that a frame with object ids can take.
const FLOOR: &str = "depth and normal prepass; drawn twice";

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
    let points: Vec<_> = points.collect();
    if points.iter().any(|(_, ms)| *ms <= 0.0) {
        // Noise.
        return f64::NAN;
    }
    exponent(&points)
}

pub fn many_objects(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "many_objects_times")?;
    let counts = times.values("objects");
    out.push_str(
        "### Many objects\n\n\
         Frames of 64x64 pixels, in milliseconds, with cubes that share a mesh and a material. Exponent: of growth, less \
         the time of a frame with one object.\n\n| frame |",
    );
    for count in &counts {
        let _ = write!(out, " {count} |");
    }
    let _ = writeln!(out, " exponent |\n|---|{}---|", "---|".repeat(counts.len()));
    for variant in &times.values("variant") {
        let _ = write!(out, "| {variant} |");
        for count in &counts {
            let whole = of(&times, count, variant, "whole");
            let _ = match whole.is_finite() {
                true => write!(out, " {whole:.1} |"),
                false => write!(out, " - |"),
            };
        }
        let growth = growth(&times, &counts, variant);
        let _ = match growth.is_finite() {
            true => writeln!(out, " {growth:.2} |"),
            false => writeln!(out, " - |"),
        };
    }
    out.push_str(
        "\nFrames with outlines as multiples of those with the engine's depth and normal prepass, and of those that draw \
         it twice, as object ids have to at least; and microseconds of the CPU in which ids are queued, batched and bound: \
         where nothing changes, one object in a hundred moves, and the camera turns.\n\n\
         | objects | frame, outlines / prepasses | outlines / prepasses drawn twice | ids, still, us | ids, 1 % move, us | \
         ids, the camera turns, us |\n|---|---|---|---|---|---|\n",
    );
    for count in &counts {
        let whole = |variant| of(&times, count, variant, "whole");
        let ids = |variant| 1e3 * of(&times, count, variant, "ids");
        let floor = whole("outlines") / whole(FLOOR);
        let floor = match floor.is_finite() {
            true => format!("{floor:.2}"),
            false => "-".to_owned(),
        };
        let _ = writeln!(
            out,
            "| {count} | {:.2} | {floor} | {:.0} | {:.0} | {:.0} |",
            whole("outlines") / whole(PREPASSES),
            ids("outlines"),
            ids("outlines; 1 % move"),
            ids("outlines; the camera turns"),
        );
    }
    let materials = times.matching(&[("variant", "idle; 1000 toon scenes")]);
    let materials = times.numbers(&materials, "toon_materials");
    let most = materials.into_iter().fold(0.0, f64::max);
    let _ = writeln!(
        out,
        "\nToon materials of 1000 equal toon scenes: {most:.0}.\n"
    );
    let peers = load(folder, "peer_object_times")?;
    if peers.rows.is_empty() {
        out.push_str("Other crates were not measured on these scenes.\n\n");
        return Ok(());
    }
    out.push_str(
        "Other crates on the same scenes, in apps of their own, in turns: frames in milliseconds, and as multiples of \
         those with the engine's prepasses.\n\n| frame |",
    );
    let counts = peers.values("objects");
    for count in &counts {
        let _ = write!(out, " {count} |");
    }
    let _ = writeln!(out, "\n|---|{}", "---|".repeat(counts.len()));
    for variant in peers.values("variant") {
        let _ = write!(out, "| {variant} |");
        for count in &counts {
            let [whole, least] =
                [&*variant, PREPASSES].map(|variant| of(&peers, count, variant, "whole"));
            let _ = write!(out, " {whole:.1}, {:.2} |", whole / least);
        }
        out.push('\n');
    }
    out.push('\n');
    Ok(())
}
