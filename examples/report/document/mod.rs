//! The text of the report. It is made from the CSV files alone, so that it can be made
//! again without measuring.

mod others;
mod precision;
mod scenes;

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, costs, growth_exponent},
    load,
};

fn targets(out: &mut String, folder: &Path) -> Result<(), String> {
    let machine = load(folder, "machine")?;
    let is_cpu = machine
        .rows
        .iter()
        .any(|row| row[0] == "kind" && row[1] == "Cpu");
    let lines = costs(&load(folder, "line_times")?, "lines", "teapot", &OWN);
    let comic = lines.iter().find(|c| c.name == "default comic");
    let (p, _) = growth_exponent(&load(folder, "growth_times")?, "pixels", &OWN);
    let peers = load(folder, "peer_times")?;
    out.push_str("## Targets\n\n| | target | here | |\n|---|---|---|---|\n");
    let mut row = |what: &str, target: String, got: Option<f64>, met: &dyn Fn(f64) -> bool| {
        let (got, verdict) = match got.filter(|g| g.is_finite()) {
            Some(got) => (
                format!("{got:.2}"),
                if met(got) { "met" } else { "**missed**" },
            ),
            None => ("not measured".to_owned(), ""),
        };
        let _ = writeln!(out, "| {what} | {target} | {got} | {verdict} |");
    };
    let limit = if is_cpu { 2.5 } else { 1.6 };
    row(
        "default comic, in blits",
        format!("at most {limit}"),
        comic.map(|c| c.ratio[1]),
        &|x| x <= limit,
    );
    row(
        "growth with pixels, exponent",
        "0.95 to 1.05".into(),
        Some(p),
        &|p| (0.95..=1.05).contains(&p),
    );
    let post = costs(&peers, "peers", "teapot", &OWN);
    let of = |name: &str| {
        post.iter()
            .find(|c| c.name.contains(name))
            .map(|c| c.milliseconds)
    };
    row(
        "time of bevy_edge_detection_outline (Sobel, depth + normals) / silhouettes + creases",
        "at least 2".into(),
        of("Sobel")
            .zip(of("silhouettes + creases"))
            .map(|(a, b)| a / b),
        &|x| x >= 2.0,
    );
    out.push_str(
        "\nWhy targets are missed on a CPU adapter: a blit is little more than a copy of memory \
         there, while every effect is computed in software for every pixel, with both sides of \
         every branch. The outlines read 5x5 depths and 5x5 normals (Eq. 2 needs the extremes \
         of nine gradients); the crate that they are compared with reads 3x3. ARCHITECTURE.md \
         says what was tried and what it gained, under \"Presence and modes are compiled\".\n\n",
    );
    Ok(())
}

/// The whole report.
pub fn render(folder: &Path) -> Result<String, String> {
    let machine = load(folder, "machine")?;
    let mut out = String::from(
        "# Error against run time\n\nWritten by `cargo run --release --example report`. Every \
         number is computed from the CSV files in this folder, and a test computes it again.\n\n\
         | | |\n|---|---|\n",
    );
    for row in &machine.rows {
        let _ = writeln!(out, "| {} | {} |", row[0], row[1]);
    }
    out.push_str(
        "\nVariants are timed in turn (A B C A B C). The time of a variant is that of the frame \
         with it, less that of the frame without it; the tables give the median of all rounds. \
         Ratios are to a copying pass of the same size in the same round (\"blits\"): the median, \
         and in some tables the 10th and 90th percentile of the rounds. \"blit again\" is the \
         same copying pass a second time: its difference from 1 is noise. Ratios are different \
         on other kinds of adapter; nothing here was measured on a GPU unless the table above \
         says so.\n\n",
    );
    targets(&mut out, folder)?;
    out.push_str("## 1. Error against run time\n\n");
    precision::ranges(&mut out, folder)?;
    precision::encodings(&mut out, folder)?;
    precision::lines(&mut out, folder)?;
    scenes::stability(&mut out, folder)?;
    scenes::ladder(&mut out, folder)?;
    scenes::growth(&mut out, folder)?;
    others::peers(&mut out, folder)?;
    others::flicker(&mut out, folder)?;
    Ok(out)
}
