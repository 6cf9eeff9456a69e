//! The text of the report, from its tables alone: whoever has the CSV files can
//! make it again.

use std::{fmt::Write, path::Path};

use crate::{
    load,
    table::{Table, exponent, largest, median, quantile},
};

/// Columns of the laps, in a table of times.
const LAPS: [&str; 5] = ["prepass", "range", "lines", "main", "post"];
/// The laps that hold this crate's own passes.
pub const OWN: [&str; 3] = ["range", "lines", "post"];

/// What one variant takes: milliseconds over nothing, and its ratio to a blit
/// in the same round; each with its 10th and 90th percentile.
pub struct Cost {
    pub name: String,
    pub milliseconds: f64,
    pub ratio: [f64; 3],
}

/// The costs of every variant of a section and scene.
pub fn costs(times: &Table, section: &str, scene: &str, laps: &[&str]) -> Vec<Cost> {
    let rows = times.matching(&[("section", section), ("scene", scene)]);
    let of = |variant: &str, laps: &[&str]| -> Vec<f64> {
        rows.iter()
            .filter(|row| times.cell(row, "variant") == variant)
            .map(|row| laps.iter().map(|lap| times.number(row, lap)).sum())
            .collect()
    };
    let (nothing, nothing_post) = (of("nothing", laps), of("nothing", &["post"]));
    let blit = of("blit", &["post"]);
    times
        .distinct(&rows, "variant")
        .into_iter()
        .filter(|name| name != "nothing")
        .map(|name| {
            let own = of(&name, laps);
            let over: Vec<f64> = own.iter().zip(&nothing).map(|(v, n)| v - n).collect();
            let ratios: Vec<f64> = over
                .iter()
                .zip(blit.iter().zip(&nothing_post))
                .map(|(v, (b, n))| v / (b - n))
                .collect();
            Cost {
                name,
                milliseconds: median(&over),
                ratio: [0.1, 0.5, 0.9].map(|q| quantile(&ratios, q)),
            }
        })
        .collect()
}

/// Without a sign where it rounds to zero.
fn unsigned_zero(x: f64, digits: i32) -> f64 {
    if x.abs() < 0.5 * 10f64.powi(-digits) {
        0.0
    } else {
        x
    }
}

/// The passes of a lap that a blit has nothing of.
fn cost_table(out: &mut String, costs: &[Cost]) {
    let _ = writeln!(out, "| | ms | blits | 10 % to 90 % |\n|---|---|---|---|");
    for cost in costs.iter().filter(|c| !c.name.starts_with("blit")) {
        let [low, middle, high] = cost.ratio;
        let _ = writeln!(
            out,
            "| {} | {:.2} | {middle:.2} | {low:.2} to {high:.2} |",
            cost.name, cost.milliseconds
        );
    }
    out.push('\n');
}

/// (name, median milliseconds, median ratio to the blit of the round).
pub fn bare_costs(times: &Table, column: &str) -> Vec<(String, f64, f64)> {
    let all: Vec<&Vec<String>> = times.rows.iter().collect();
    let of = |name: &str| times.numbers(&times.matching(&[(column, name)]), "milliseconds");
    let blit = of("blit");
    times
        .distinct(&all, column)
        .into_iter()
        .map(|name| {
            let own = of(&name);
            let ratios: Vec<f64> = own.iter().zip(&blit).map(|(a, b)| a / b).collect();
            (name, median(&own), median(&ratios))
        })
        .collect()
}

fn size(times: &Table) -> String {
    times.rows.first().map_or_else(String::new, |row| {
        format!("{}x{}", times.cell(row, "width"), times.cell(row, "height"))
    })
}

fn ranges(out: &mut String, folder: &Path) -> Result<(), String> {
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

fn encodings(out: &mut String, folder: &Path) -> Result<(), String> {
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

/// (recall, precision, F1) of a detector over all scenes.
pub fn line_score(scores: &Table, detector: &str, truth: &str) -> [f64; 3] {
    let rows = scores.matching(&[("detector", detector), ("truth", truth)]);
    let sum = |name| scores.numbers(&rows, name).iter().sum::<f64>();
    let recall = sum("found") / sum("true").max(1.0);
    let precision = sum("right") / sum("drawn").max(1.0);
    let f1 = 2.0 * recall * precision / (recall + precision).max(1e-9);
    [recall, precision, f1]
}

fn lines(out: &mut String, folder: &Path) -> Result<(), String> {
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

fn stability(out: &mut String, folder: &Path) -> Result<(), String> {
    let table = load(folder, "stability")?;
    out.push_str(
        "## 2. Stability on stiff and extreme cases\n\nThe depth map (Eq. 4) on the adapter \
         against the exact quotient of the stored depths. The textbook's form turns depth into \
         distance first and then takes `(z - min) / (max - min)`; ours is the quotient of \
         differences of raw depth. The condition is the factor by which a relative error of a \
         depth grows in the map. `wild` counts results that are not finite. The floor that \
         hides noise (`DepthMap::floor`) is off here. One depth alone has no quotient: it is 0 \
         by definition. Subnormal depths count as sky.\n\n\
         | case | condition | textbook, ulp | codes | wild | ours, ulp | codes | wild |\n\
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
        "\nPictures with every style at once, then sketched, on an HDR camera: how many pixels \
         were not finite before this crate's pass, and after it.\n\n\
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
    let moved = load(folder, "moved")?;
    out.push_str(
        "\nThe same scene, scaled with its near plane or moved with its camera, against the \
         scene as it is (FLIP; the engine's own positions are single floats, which at 1e6 have \
         steps of 6 cm):\n\n| | FLIP |\n|---|---|\n",
    );
    for row in &moved.rows {
        let _ = writeln!(
            out,
            "| {} | {:.4} |",
            moved.cell(row, "case"),
            moved.number(row, "flip")
        );
    }
    out.push('\n');
    Ok(())
}

fn ladder(out: &mut String, folder: &Path) -> Result<(), String> {
    let work = load(folder, "work")?;
    let times = load(folder, "ladder_times")?;
    let costs = costs(&times, "ladder", "teapot", &OWN);
    let _ = writeln!(
        out,
        "## 3. What is left out\n\nFrom no style to everything: the passes that ran (the \
         engine's prepasses among them), of eight; the bindings of the fused pass; the texels \
         and bytes that it fetches for a pixel, counted by the shader itself on the teapot at \
         160x90; the time of this crate's passes at {}.\n\n\
         | style | passes | bindings | texels, mean (most) | bytes | ms | blits | of everything |\n\
         |---|---|---|---|---|---|---|---|",
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
            "| {} | {} | {} | {} ({}) | {} | {:.2} | {:.2} | {:.0} % |",
            cell("style"),
            cell("passes"),
            cell("bindings"),
            cell("fetches"),
            cell("most"),
            cell("bytes"),
            unsigned_zero(ms, 2),
            unsigned_zero(ratio, 2),
            unsigned_zero(100.0 * ms / whole, 0),
        );
    }
    out.push_str("\nWhich passes those are:\n\n");
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
        "\n### An idle plugin\n\nWhole frames of three apps, in turn: one without the plugin, \
         one with it and no style on any camera, and the first once more as the noise bar.\n\n\
         | | ms, median | 10 % to 90 % |\n|---|---|---|\n",
    );
    let all: Vec<&Vec<String>> = idle.rows.iter().collect();
    for app in idle.distinct(&all, "app") {
        let ms = idle.numbers(&idle.matching(&[("app", &app)]), "milliseconds");
        let _ = writeln!(
            out,
            "| {app} | {:.3} | {:.3} to {:.3} |",
            median(&ms),
            quantile(&ms, 0.1),
            quantile(&ms, 0.9)
        );
    }
    let prepass = load(folder, "prepass_times")?;
    out.push_str(
        "\n### Depth from a prepass, or from the main pass?\n\nThe engine's prepass and main \
         pass together, with a depth prepass and without. A style that reads depth alone could \
         read the main pass's instead.\n\n\
         | scene | without, ms | with, ms | with / without |\n|---|---|---|---|\n",
    );
    let all: Vec<&Vec<String>> = prepass.rows.iter().collect();
    let (mut won, mut lost) = (0, 0);
    for scene in prepass.distinct(&all, "scene") {
        let of = |with| {
            let rows = prepass.matching(&[("scene", &scene), ("prepass", with)]);
            prepass.numbers(&rows, "milliseconds")
        };
        let (without, with) = (of("no"), of("yes"));
        let ratios: Vec<f64> = with.iter().zip(&without).map(|(a, b)| a / b).collect();
        if median(&ratios) < 1.0 {
            won += 1;
        } else {
            lost += 1;
        }
        let _ = writeln!(
            out,
            "| {scene} | {:.1} | {:.1} | {:.2} |",
            median(&without),
            median(&with),
            median(&ratios)
        );
    }
    let _ = writeln!(
        out,
        "\nThe prepass pays for itself in {won} of {} scenes here, because the main pass then \
         shades no pixel that is hidden later.\n",
        won + lost
    );
    Ok(())
}

/// (exponent of the cost of this crate's passes, points) over pixels, vertices
/// or cameras.
pub fn growth_exponent(times: &Table, section: &str, laps: &[&str]) -> (f64, Vec<(f64, f64)>) {
    let rows = times.matching(&[("section", section)]);
    let points: Vec<(f64, f64)> = times
        .distinct(&rows, "scene")
        .into_iter()
        .filter_map(|scene| {
            let x = match scene.split_once('x') {
                Some((w, h)) => w.parse::<f64>().ok()? * h.parse::<f64>().ok()?,
                None => scene.parse().ok()?,
            };
            let cost = costs(times, section, &scene, laps)
                .into_iter()
                .find(|c| c.name == "default comic")?;
            Some((x, cost.milliseconds))
        })
        .collect();
    (exponent(&points), points)
}

fn growth(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "growth_times")?;
    out.push_str(
        "## 4. Cost and its growth\n\nThe default comic (desaturation, colorization, \
         contours), this crate's passes alone: range, lines and fused pass.\n\n",
    );
    for (section, title) in [("pixels", "pixels"), ("vertices", "vertices, at 512x512")] {
        let (p, points) = growth_exponent(&times, section, &OWN);
        let _ = writeln!(out, "| {title} | ms | blits |\n|---|---|---|");
        let rows = times.matching(&[("section", section)]);
        for (scene, (_, ms)) in times.distinct(&rows, "scene").iter().zip(&points) {
            let ratio = costs(&times, section, scene, &OWN)
                .into_iter()
                .find(|c| c.name == "default comic")
                .map_or(f64::NAN, |c| c.ratio[1]);
            let _ = writeln!(out, "| {scene} | {ms:.2} | {ratio:.2} |");
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
        }
    }
    out.push_str(
        "The engine's prepass, which the style asks for, grows with the vertices as the main \
         pass does:\n\n| vertices | prepass, ms | main pass with it, ms | main pass without a style, ms |\n|---|---|---|---|\n",
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
            of("default comic", "prepass"),
            of("default comic", "main"),
            of("nothing", "main"),
        );
    }
    out.push_str(
        "\nWith several cameras that wear the style, 256x256 each:\n\n| cameras | own passes of \
         all, ms | whole frame of all, ms |\n|---|---|---|\n",
    );
    let rows = times.matching(&[("section", "cameras")]);
    for scene in times.distinct(&rows, "scene") {
        let cost = costs(&times, "cameras", &scene, &OWN)
            .into_iter()
            .find(|c| c.name == "default comic")
            .map_or(f64::NAN, |c| c.milliseconds);
        let rows = times.matching(&[
            ("section", "cameras"),
            ("scene", &scene),
            ("variant", "default comic"),
        ]);
        let whole: Vec<f64> = rows
            .iter()
            .map(|row| LAPS.iter().map(|lap| times.number(row, lap)).sum())
            .collect();
        let _ = writeln!(out, "| {scene} | {cost:.2} | {:.2} |", median(&whole));
    }
    let paper = load(folder, "paper_times")?;
    let fps = |app: &str| {
        let rows = paper.matching(&[("app", app)]);
        1000.0 / median(&paper.numbers(&rows, "milliseconds"))
    };
    let (without, with) = (fps("without the model"), fps("with the model"));
    let _ = writeln!(
        out,
        "\n### The paper's experiment\n\nOne million vertices, 512x512, whole frames, without \
         the model and with it (the default comic), prepass included.\n\n\
         | | without, frames/s | with, frames/s | with / without |\n|---|---|---|---|\n\
         | [CS], GPU unnamed, 2010 | 512 | 260 | {:.2} |\n\
         | here | {without:.2} | {with:.2} | {:.2} |\n",
        260.0 / 512.0,
        with / without
    );
    out.push_str("![Cost against pixels](growth.svg)\n\n");
    Ok(())
}

fn peers(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "peer_times")?;
    out.push_str("## 5. Other crates, in the same app and run\n\n");
    if times.rows.is_empty() {
        out.push_str("Not measured: `--quick` does not build the other crates.\n\n");
        return Ok(());
    }
    let _ = writeln!(
        out,
        "The teapot at {}, every crate at its defaults, in one process and in turn. The \
         camera always has the depth and normal prepass, so nobody pays for them. All times are \
         over the frame without any of them. Full-screen effects are the passes after the main \
         pass and this crate's before it; the whole camera, with the noise of its main pass, is \
         what those take that draw lines or light with the meshes. What a crate draws differs: \
         extruded and scaled shells are lines around objects alone, and a material is no line \
         at all.\n\n\
         | | full-screen passes, ms | blits | 10 % to 90 % | whole camera, ms |\n\
         |---|---|---|---|---|",
        size(&times)
    );
    let all = costs(&times, "peers", "teapot", &LAPS);
    let post = costs(&times, "peers", "teapot", &OWN);
    for (whole, cost) in all.iter().zip(&post) {
        let [low, middle, high] = cost.ratio.map(|r| unsigned_zero(r, 2));
        let _ = writeln!(
            out,
            "| {} | {:.2} | {middle:.2} | {low:.2} to {high:.2} | {:.2} |",
            cost.name,
            unsigned_zero(cost.milliseconds, 2),
            whole.milliseconds
        );
    }
    out.push('\n');
    let of = |name: &str| post.iter().find(|c| c.name.contains(name));
    let mut claim = |ours: &str, theirs: &str| {
        if let (Some(a), Some(b)) = (of(ours), of(theirs)) {
            let _ = writeln!(
                out,
                "* {} takes {:.2} times as long as {} (full-screen passes alone: {:.2} and \
                 {:.2} ms).",
                b.name,
                b.milliseconds / a.milliseconds,
                a.name,
                b.milliseconds,
                a.milliseconds
            );
        }
    };
    claim("silhouettes + creases", "Sobel");
    claim("silhouettes + creases", "Roberts");
    claim("default comic", "Sobel");
    out.push('\n');
    Ok(())
}

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

fn flicker(out: &mut String, folder: &Path) -> Result<(), String> {
    let table = load(folder, "flicker")?;
    out.push_str(
        "## 6. A range that does not flicker\n\nSeventy-two frames at 60 a second. Flicker of a \
         frame is the difference, in display codes, between the frame and the same frame drawn \
         with the range of the frame before: what the scene's own change does not explain. \
         Given are the mean over all pixels and frames, the worst frame's mean, and the worst \
         frame's 99th percentile; the lag is the mean distance of the drawn range from the \
         exact one, in octaves of distance (outliers that percentiles leave out count as lag). \
         A cut is announced, and starts every variant anew. \
         The ranges are those of the shader's twin, which the tests hold to the shader.\n\n\
         | sequence | stage | flicker, mean | worst frame | its 99 % | lag, octaves |\n\
         |---|---|---|---|---|---|\n",
    );
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    for sequence in table.distinct(&all, "sequence") {
        for variant in table.distinct(&all, "variant") {
            let rows = table.matching(&[("sequence", &sequence), ("variant", &variant)]);
            let of = |name| table.numbers(&rows, name);
            let mean = |name| of(name).iter().sum::<f64>() / rows.len() as f64;
            let _ = writeln!(
                out,
                "| {sequence} | {variant} | {:.3} | {:.2} | {:.0} | {:.3} |",
                mean("mean"),
                largest(&of("mean")),
                largest(&of("p99")),
                mean("lag"),
            );
        }
    }
    if folder.join("flicker.png").exists() {
        out.push_str(
            "\nAn intruder crosses near the camera for half a second: without smoothing (above) \
             and with the default (below). Frames 18, 20, 24, 35, 51 and 66; it comes at 20 and \
             is gone at 50.\n\n![Six frames without and with smoothing](flicker.png)\n",
        );
    }
    out.push_str("\n![Flicker against lag](flicker.svg)\n\n");
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
    ranges(&mut out, folder)?;
    encodings(&mut out, folder)?;
    lines(&mut out, folder)?;
    stability(&mut out, folder)?;
    ladder(&mut out, folder)?;
    growth(&mut out, folder)?;
    peers(&mut out, folder)?;
    flicker(&mut out, folder)?;
    Ok(out)
}
