//! The text of the report. It is made from the CSV files alone, so that it can be made
//! again without measuring.

mod figures;
mod index;
mod ink;
mod objects;
mod others;
mod page;
mod parts;
mod precision;
mod scenes;
mod soak;
mod target;
mod targets;
mod toon;

use std::{fmt::Write, path::Path};

use crate::{
    costs::costs,
    load,
    table::{median, quantile},
};

/// The whole report.
pub fn render(folder: &Path) -> Result<String, String> {
    let machine = load(folder, "machine")?;
    let stamps = index::stamps(folder)?;
    let body = body(folder)?;
    let mut out = String::from(
        "# Error against run time\n\n\
         Written by `cargo run --example report`. All measured numbers come from the CSV files in this folder: a test \
         makes this text from them again, and checks some with other code.\n\n",
    );
    let measured = index::measured(&machine, stamps.as_ref());
    if !measured.is_empty() {
        let _ = writeln!(out, "{measured}\n");
    }
    index::index(&mut out, folder, stamps.as_ref(), &body)?;
    out.push_str("## Machine and method\n\n| | |\n|---|---|\n");
    for row in &machine.rows {
        let _ = writeln!(out, "| {} | {} |", row[0], row[1]);
    }
    out.push_str(
        "\n`peers` is a program of its own, whose dependencies are built without optimization (`opt-level` 0): it compares \
         crates with each other, and its times do not compare with those of other sections. The profile of these is in \
         docs/benchmarks.md; until 26 November 2026, all of them were built with `opt-level` 1.\n\n\
         Variants are timed in turn (A B C A B C): the median of all rounds, less the frame without a style. Blits are \
         ratios to a pass that copies the picture in the same round: the median, and the 10th and 90th percentile. The \
         difference of \"blit again\" from 1 is noise. Ratios are different on other kinds of adapter.\n\n",
    );
    noise(&mut out, folder)?;
    out.push_str(&body);
    Ok(out)
}

/// How much the time of a copy varies from round to round in the ladder.
fn noise(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "ladder_times")?;
    let of = |variant| {
        let rows = times.matching(&[("section", "ladder"), ("variant", variant)]);
        times.numbers(&rows, "post")
    };
    let copies: Vec<f64> = of("blit")
        .iter()
        .zip(of("nothing"))
        .map(|(copy, nothing)| copy - nothing)
        .collect();
    let again = costs(&times, "ladder", "teapot", &["post"]);
    let again = again.iter().find(|cost| cost.name == "blit again");
    let again = again.map_or(f64::NAN, |cost| cost.ratio[1]);
    let _ = writeln!(
        out,
        "How quiet the machine was: in the rounds of section 3, a copy took {:.1} ms (10 % to 90 % of the rounds: {:.1} to \
         {:.1} ms), and \"blit again\" {again:.2} blits.\n",
        median(&copies),
        quantile(&copies, 0.1),
        quantile(&copies, 0.9)
    );
    Ok(())
}

/// The report without its head.
fn body(folder: &Path) -> Result<String, String> {
    let mut out = String::new();
    targets::targets(&mut out, folder)?;
    out.push_str("## 1. Error against run time\n\n");
    precision::ranges(&mut out, folder)?;
    precision::lines(&mut out, folder)?;
    page::page(&mut out, folder)?;
    scenes::stability(&mut out, folder)?;
    scenes::ladder(&mut out, folder)?;
    parts::parts(&mut out, folder)?;
    toon::toon(&mut out, folder)?;
    scenes::growth(&mut out, folder)?;
    objects::many_objects(&mut out, folder)?;
    others::peers(&mut out, folder)?;
    others::flicker(&mut out, folder)?;
    soak::soak(&mut out, folder)?;
    Ok(out)
}
