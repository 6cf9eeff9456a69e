//! The text of the report, from its tables alone: whoever has the CSV files can
//! make it again.

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
        "bevy_edge_detection_outline (Sobel, depth + normals) over silhouettes + creases",
        "at least 2".into(),
        of("Sobel")
            .zip(of("silhouettes + creases"))
            .map(|(a, b)| a / b),
        &|x| x >= 2.0,
    );
    out.push_str(
        "\nWhere a target is missed on a CPU adapter: a blit there is little more than a copy of \
         memory, while every style computes in software for every pixel, both sides of every \
         branch. The outlines look at 5x5 depths and 5x5 normals (Eq. 2 wants the extremes of \
         nine gradients), the crate that they are measured against at 3x3. What was tried and \
         what it brought is in ARCHITECTURE.md, under \"Presence and modes are compiled\".\n\n",
    );
    Ok(())
}

/// The whole report.
pub fn render(folder: &Path) -> Result<String, String> {
    let machine = load(folder, "machine")?;
    let mut out = String::from(
        "# Error against run time\n\nMade by `cargo run --release --example report`; every \
         number is computed from the CSV files beside this text, and a test does it again.\n\n\
         | | |\n|---|---|\n",
    );
    for row in &machine.rows {
        let _ = writeln!(out, "| {} | {} |", row[0], row[1]);
    }
    out.push_str(
        "\nVariants are timed in turn (A B C A B C). A time is the median over all rounds of \
         what a variant takes over the same frame without it; a ratio is to a copying pass of \
         the same size in the same round (\"blits\"), with the share of rounds between 10 % and \
         90 % beside it. \"blit again\" is the same pass a second time: what it differs from 1 \
         is noise. Times on another kind of adapter will have other ratios: nothing here was \
         measured on a GPU unless the table above says so.\n\n",
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
