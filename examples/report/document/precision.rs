//! Error against run time: the range, its encoding, lines.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, bare_costs, cost_table, costs, line_score, size},
    load,
    table::largest,
};

pub fn ranges(out: &mut String, folder: &Path) -> Result<(), String> {
    let errors = load(folder, "range_errors")?;
    let times = load(folder, "range_times")?;
    let bare = load(folder, "range_bare_times")?;
    out.push_str(
        "### The range\n\nThe largest error over all frames of a moving camera, and the mean \
         share of the pixels in a wrong one of eight bands. `near` and `far` are relative \
         errors of a distance, `map` the largest error of the depth map over all pixels, FLIP \
         the largest mean difference of the picture (desaturation and colorization at full \
         strength). `wires` are a fraction of a pixel wide, `specks` a few pixels each. \"Rotating 4\" looks at a \
         sixteenth of the pixels in every frame and takes the extremes of sixteen frames. \
         Percentiles are not an approximation: they leave outliers out, and the error is what \
         that changes.\n\n| scene | method | near | far | map | wrong band | FLIP |\n|---|---|---|---|---|---|---|\n",
    );
    let all: Vec<&Vec<String>> = errors.rows.iter().collect();
    for scene in errors.distinct(&all, "scene") {
        for method in errors.distinct(&all, "method") {
            let rows = errors.matching(&[("scene", &scene), ("method", &method)]);
            let of = |name| errors.numbers(&rows, name);
            let band = of("band");
            let _ = writeln!(
                out,
                "| {scene} | {method} | {:.1e} | {:.1e} | {:.1e} | {:.2} % | {:.4} |",
                largest(&of("near")),
                largest(&of("far")),
                largest(&of("map")),
                100.0 * band.iter().sum::<f64>() / band.len() as f64,
                largest(&of("flip")),
            );
        }
    }
    let _ = writeln!(
        out,
        "\nTime of the shipped reductions at {}, in the app, over the unstyled frame (the \
         range's passes alone; every exact method gives the same bits):\n",
        size(&times)
    );
    cost_table(out, &costs(&times, "ranges", "teapot", &["range"]));
    let _ = writeln!(
        out,
        "Time of the strided ones at {}, on a bare device (stride 1 is their own full scan, \
         without the shipped one's gathers):\n\n| | ms | blits |\n|---|---|---|",
        size(&bare)
    );
    for (name, ms, ratio) in bare_costs(&bare, "method") {
        let _ = writeln!(out, "| {name} | {ms:.3} | {ratio:.3} |");
    }
    let whole = costs(&times, "ranges", "teapot", &["range"]);
    let exact = whole.iter().find(|c| c.name == "BarrierFree");
    if let Some(exact) = exact {
        let _ = writeln!(
            out,
            "\nThe exact range is {:.2} of a blit (barrier-free). That is all a cheaper one \
             could save, and each of them is wrong without bound for what is thinner than its \
             stride: none is offered. Percentiles are, as part of `DepthMap::smoothing`.\n\n\
             ![Error of the map against time](range.svg)\n",
            exact.ratio[1]
        );
    }
    Ok(())
}

pub fn encodings(out: &mut String, folder: &Path) -> Result<(), String> {
    let errors = load(folder, "encoding_errors")?;
    let times = load(folder, "encoding_times")?;
    let _ = writeln!(
        out,
        "### What depth is kept in\n\nLargest error of the depth map over the first frame of \
         every scene, against the exact map of the stored depths, and the time of writing the \
         copy and mapping it at {}. The crate keeps no copy: it reads the depth texture.\n\n\
         | | map, worst scene | wrong band, worst | FLIP, worst | ms | blits |\n\
         |---|---|---|---|---|---|",
        size(&times)
    );
    for (name, ms, ratio) in bare_costs(&times, "encoding") {
        if name.starts_with("blit") {
            continue;
        }
        // The depth texture holds the same single floats as a copy of them.
        let stored = if name.starts_with("none") {
            "f32 depth"
        } else {
            &name
        };
        let rows = errors.matching(&[("encoding", stored)]);
        let _ = writeln!(
            out,
            "| {name} | {:.1e} | {:.2} % | {:.4} | {ms:.2} | {ratio:.2} |",
            largest(&errors.numbers(&rows, "map")),
            100.0 * largest(&errors.numbers(&rows, "band")),
            largest(&errors.numbers(&rows, "flip")),
        );
    }
    out.push_str("\n![Error of the encodings against time](encoding.svg)\n\n");
    Ok(())
}

pub fn lines(out: &mut String, folder: &Path) -> Result<(), String> {
    let scores = load(folder, "line_scores")?;
    let smooth = load(folder, "smoothing_errors")?;
    let times = load(folder, "line_times")?;
    let costs_of = costs(&times, "lines", "teapot", &OWN);
    let _ = writeln!(
        out,
        "### Lines\n\nTruth is the scene at four times the resolution. Scores are over the \
         pixels of all scenes; time is at {}. The contours' thresholds are shares of the \
         visible range, so in deep scenes they leave out what the outlines, which measure \
         steps by their distance, keep. Every contour operator reads 3x3 texels, outlines 5x5.\n\n\
         | | silhouettes found | F1, silhouettes | every line found | precision | F1, every line | ms | blits |\n\
         |---|---|---|---|---|---|---|---|",
        size(&times)
    );
    let all: Vec<&Vec<String>> = scores.rows.iter().collect();
    for detector in scores.distinct(&all, "detector") {
        let [found, _, f1] = line_score(&scores, &detector, "silhouettes");
        let [all, precision, every] = line_score(&scores, &detector, "every line");
        let cost = costs_of.iter().find(|c| c.name == detector);
        let (ms, ratio) = cost.map_or((f64::NAN, f64::NAN), |c| (c.milliseconds, c.ratio[1]));
        let _ = writeln!(
            out,
            "| {detector} | {:.1} % | {f1:.3} | {:.1} % | {:.1} % | {every:.3} | {ms:.2} | {ratio:.2} |",
            100.0 * found,
            100.0 * all,
            100.0 * precision,
        );
    }
    out.push_str("\n![F1 against time](lines.svg)\n\n");
    out.push_str(
        "### Anti-aliasing of bands and lines\n\nAgainst the same look at eight times the \
         resolution. \"2x2\" draws four times the pixels and takes their mean; its time is that \
         of this crate's passes at twice the width and height, without the rest of the frame, \
         which would be drawn four times as well.\n\n\
         | | | FLIP | RMS, codes | ms | blits |\n|---|---|---|---|---|---|\n",
    );
    let fine = costs(&times, "2x2", "teapot", &OWN);
    let blit = costs_of.iter().find(|c| c.name == "blit");
    for row in &smooth.rows {
        let (what, method) = (smooth.cell(row, "what"), smooth.cell(row, "method"));
        let name = match method {
            "2x2 samples" if what == "silhouettes" => "silhouettes".to_owned(),
            "2x2 samples" => format!("{what} hard"),
            _ if what == "silhouettes" => "silhouettes".to_owned(),
            _ => format!("{what} {method}"),
        };
        let from = if method == "2x2 samples" {
            &fine
        } else {
            &costs_of
        };
        let ms = from
            .iter()
            .find(|c| c.name == name)
            .map_or(f64::NAN, |c| c.milliseconds);
        let ratio = ms / blit.map_or(f64::NAN, |b| b.milliseconds);
        let _ = writeln!(
            out,
            "| {what} | {method} | {:.4} | {:.2} | {ms:.2} | {ratio:.2} |",
            smooth.number(row, "flip"),
            smooth.number(row, "codes"),
        );
    }
    out.push('\n');
    Ok(())
}
