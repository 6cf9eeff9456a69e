//! The report's text: stability, what is left out, growth.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{GROWING, LAPS, OWN, costs, growth_exponent, size, unsigned_zero},
    load,
    table::{Table, exponent, median, quantile},
};

pub fn stability(out: &mut String, folder: &Path) -> Result<(), String> {
    let table = load(folder, "stability")?;
    out.push_str(
        "## 2. Stability on stiff and extreme cases\n\n\
         The depth map (Eq. 4) on the adapter beside the exact quotient. The textbook's form computes distances, then `(z \
         - min) / (max - min)`; this crate's is a quotient of differences of raw depth. Condition: the factor by which the \
         map multiplies a relative error of a depth. The largest errors in units in the last place and in 8-bit codes, and \
         the number of results that are not finite. `DepthMap::floor`, which hides noise, is off. A single depth has no \
         quotient: its map is 0. Subnormal depths count as sky.\n\n\
         | case | condition | textbook, ulp | codes | not finite | this crate, ulp | codes | not finite |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for row in table.matching(&[("kind", "depth map")]) {
        let cell = |name| table.cell(row, name);
        let number = |name| {
            let x = table.number(row, name);
            if (0.01..1e4).contains(&x) || x == 0.0 {
                format!("{x:.2}")
            } else {
                format!("{x:.1e}")
            }
        };
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            cell("case"),
            cell("condition"),
            number("textbook_ulp"),
            number("textbook_codes"),
            cell("textbook_wild"),
            number("ulp"),
            number("codes"),
            cell("wild"),
        );
    }
    out.push_str(
        "\nPixels that are not finite before and after this crate's pass, on an HDR camera with the preset \
         `graphic-novel`, the default comic, outlines and tone bands, and once more with a sketch.\n\n\
         | case | before | after |\n|---|---|---|\n",
    );
    for row in table.matching(&[("kind", "picture")]) {
        let _ = writeln!(
            out,
            "| {} | {} | {} |",
            table.cell(row, "case"),
            table.cell(row, "textbook_wild"),
            table.cell(row, "wild")
        );
    }
    out.push('\n');
    Ok(())
}

pub fn ladder(out: &mut String, folder: &Path) -> Result<(), String> {
    let work = load(folder, "work")?;
    let times = load(folder, "ladder_times")?;
    let costs = costs(&times, "ladder", "teapot", &OWN);
    let _ = writeln!(
        out,
        "## 3. What is left out\n\n\
         Styles from none to everything: the passes that ran, of nine, the engine's prepasses included; the bindings of \
         the fused pass, and the texels and bytes that it fetches per pixel, counted on the teapot at 160x90; the texels \
         that the passes of lines fetch to search blocks, find cracks, search columns and draw ink, and their bytes; the \
         time of this crate's passes at {}, also in percent of `everything`. In larger pictures, finding and drawing fetch \
         less.\n\n\
         | style | passes | bindings | texels, mean (most) | bytes | texels of lines | bytes | ms | blits | of everything \
         |\n|---|---|---|---|---|---|---|---|---|---|",
        size(&times)
    );
    let whole = costs
        .iter()
        .find(|c| c.name == "everything")
        .map_or(f64::NAN, |c| c.milliseconds);
    for row in &work.rows {
        let cell = |name| work.cell(row, name);
        let cost = costs.iter().find(|c| c.name == cell("style"));
        let (ms, ratio) = cost.map_or((f64::NAN, f64::NAN), |c| (c.milliseconds, c.ratio[1]));
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} ({}) | {} | {} | {} | {:.2} | {:.2} | {:.0} % |",
            cell("style"),
            cell("passes"),
            cell("bindings"),
            cell("fetches"),
            cell("most"),
            cell("bytes"),
            ["walk", "find", "columns", "draw"].map(cell).join(" + "),
            cell("line_bytes"),
            unsigned_zero(ms, 2),
            unsigned_zero(ratio, 2),
            unsigned_zero(100.0 * ms / whole, 0),
        );
    }
    out.push_str("\nThe passes that ran:\n\n");
    for row in &work.rows {
        let ran = work.cell(row, "ran");
        let _ = writeln!(
            out,
            "* {}: {}",
            work.cell(row, "style"),
            if ran.is_empty() { "none" } else { ran }
        );
    }
    let idle = load(folder, "idle_times")?;
    out.push_str(
        "\n### An idle plugin\n\n\
         Frames of three apps, in turn: without the plugin, with it and no style, and without it again, which shows the \
         noise.\n\n\
         | | ms, median | 10 % to 90 % |\n|---|---|---|\n",
    );
    for app in idle.values("app") {
        let ms = idle.numbers(&idle.matching(&[("app", &app)]), "milliseconds");
        let _ = writeln!(
            out,
            "| {app} | {:.3} | {:.3} to {:.3} |",
            median(&ms),
            quantile(&ms, 0.1),
            quantile(&ms, 0.9)
        );
    }
    out.push('\n');
    Ok(())
}

/// The exponents of styles of fewer passes: what is left of growth below 1 is the cost of a pass
/// that does not depend on its pixels.
fn fewer_passes(out: &mut String, times: &Table) {
    let all: Vec<&Vec<String>> = times.matching(&[("section", "pixels")]);
    out.push_str("Of the styles and passes of the same run:\n\n| | fitted exponent |\n|---|---|\n");
    for variant in times.distinct(&all, "variant") {
        let (p, points) = growth_exponent(times, "pixels", &variant);
        if points.len() > 2 && variant != "nothing" && variant != "blit again" {
            let _ = writeln!(out, "| {variant} | {p:.3} |");
        }
    }
    out.push('\n');
}

pub fn growth(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "growth_times")?;
    out.push_str(
        "## 4. Cost and its growth\n\n\
         The time of this crate's passes (range, lines, fused pass) for the default comic (desaturation, colorization, \
         contours).\n\n",
    );
    for (section, title) in [("pixels", "pixels"), ("vertices", "vertices, at 512x512")] {
        let (p, points) = growth_exponent(&times, section, GROWING);
        let _ = writeln!(out, "| {title} | ms | blits |\n|---|---|---|");
        let rows = times.matching(&[("section", section)]);
        for (scene, (_, ms)) in times.distinct(&rows, "scene").iter().zip(&points) {
            let ratio = costs(&times, section, scene, &OWN)
                .into_iter()
                .find(|c| c.name == GROWING)
                .map(|c| c.ratio[1])
                .filter(|ratio| ratio.is_finite())
                .map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}"));
            let _ = writeln!(out, "| {scene} | {ms:.2} | {ratio} |");
        }
        let _ = writeln!(out, "\nFitted exponent: {p:.3}.\n");
        if section == "pixels" {
            let pixels: Vec<f64> = points.iter().map(|(x, _)| *x).collect();
            let large: Vec<(f64, f64)> = points
                .iter()
                .copied()
                .filter(|(x, _)| *x >= 512.0 * 512.0)
                .collect();
            if large.len() > 2 && large.len() < pixels.len() {
                let _ = writeln!(out, "From 512x512 on: {:.3}.\n", exponent(&large));
            }
            fewer_passes(out, &times);
        }
    }
    out.push_str(
        "The engine's prepass, which the style needs, grows with the vertices, as the main pass does:\n\n\
         | vertices | prepass, ms | main pass with it, ms | main pass without a style, ms |\n|---|---|---|---|\n",
    );
    let rows = times.matching(&[("section", "vertices")]);
    for scene in times.distinct(&rows, "scene") {
        let of = |variant, lap| {
            let rows = times.matching(&[
                ("section", "vertices"),
                ("scene", &scene),
                ("variant", variant),
            ]);
            median(&times.numbers(&rows, lap))
        };
        let _ = writeln!(
            out,
            "| {scene} | {:.2} | {:.2} | {:.2} |",
            of(GROWING, "prepass"),
            of(GROWING, "main"),
            of("nothing", "main"),
        );
    }
    out.push_str(
        "\nSeveral cameras with the style, 256x256 each:\n\n\
         | cameras | this crate's passes of all, ms | all passes of all, ms |\n|---|---|---|\n",
    );
    let rows = times.matching(&[("section", "cameras")]);
    for scene in times.distinct(&rows, "scene") {
        let cost = costs(&times, "cameras", &scene, &OWN)
            .into_iter()
            .find(|c| c.name == GROWING)
            .map_or(f64::NAN, |c| c.milliseconds);
        let rows = times.matching(&[
            ("section", "cameras"),
            ("scene", &scene),
            ("variant", GROWING),
        ]);
        let whole: Vec<f64> = rows
            .iter()
            .map(|row| LAPS.iter().map(|lap| times.number(row, lap)).sum())
            .collect();
        let _ = writeln!(out, "| {scene} | {cost:.2} | {:.2} |", median(&whole));
    }
    out.push_str("\n![Cost against pixels](growth.svg)\n\n");
    Ok(())
}
