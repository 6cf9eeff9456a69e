//! The report's text: error against run time of the range, of stored depth and of lines.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, bare_costs, cost_table, costs, line_score, size},
    load,
    scores::SAME_RULE,
    table::{Table, largest},
};

pub fn ranges(out: &mut String, folder: &Path) -> Result<(), String> {
    let errors = load(folder, "range_errors")?;
    let times = load(folder, "range_times")?;
    let bare = load(folder, "range_bare_times")?;
    out.push_str(
        "### The range\n\nErrors of the range in frames of a moving camera. All but `wrong \
         band` are the largest of these frames. `near` and `far` are relative errors of a \
         distance, `map` is the error of the depth map at the worst pixel, and FLIP the mean \
         difference of the picture (desaturation and colorization at full strength). `wrong \
         band` is the mean fraction of the pixels that are in a wrong one of eight equal bands \
         of the map. Most of the `wires` are narrower than a pixel, most of the `specks` a few \
         pixels wide. `rotating 4` reads a sixteenth of the pixels in every frame and takes the \
         extremes of sixteen frames. Percentiles are not an approximation: they leave outliers \
         out, and the error is the effect of that.\n\n\
         | scene | method | near | far | map | wrong band | FLIP |\n|---|---|---|---|---|---|---|\n",
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
        "\nTime of the crate's reductions at {}, in the app (the passes of the range alone; \
         every exact method gives the same bits):\n",
        size(&times)
    );
    cost_table(out, &costs(&times, "ranges", "teapot", &["range"]));
    let _ = writeln!(
        out,
        "Time of the strided scans at {}, on a device without the engine (stride 1 is a full \
         scan, without the texture gathers of the crate's own):\n\n| | ms | blits |\n|---|---|---|",
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
            "\nThe exact range takes {:.2} blits (barrier-free). A cheaper method cannot save \
             more than that, and the error of each is unbounded for objects that are thinner \
             than its stride: the crate offers none of them. It does offer percentiles, in \
             `DepthMap::smoothing`.\n\n\
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
        "### Stored depth\n\nA depth map that is computed from a stored copy of the depth, in \
         several formats: the worst of the first frames of all scenes, compared with the exact \
         map of the rendered depths. The time is that of storing the copy and computing the map \
         at {}. The crate stores no copy: it reads the depth texture, as in the first row.\n\n\
         | | map, worst scene | wrong band, worst | FLIP, worst | ms | blits |\n\
         |---|---|---|---|---|---|",
        size(&times)
    );
    for (name, ms, ratio) in bare_costs(&times, "encoding") {
        if name.starts_with("blit") {
            continue;
        }
        // A copy in f32 has the same values as the depth texture.
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
        "### Lines\n\nThe true lines come from the scene at four times the resolution. Scores are \
         over the pixels of all scenes; times are at {}. Contours measure a jump as a fraction \
         of the visible range, outlines as a fraction of the distance: in deep scenes, contours \
         find fewer lines. Contours read 3x3 texels, outlines six in a row. \"F1, silhouettes\" counts \
         every line that is no silhouette as false.\n\n\
         A pixel is wrong if it has ink more than two pixels away from any depth step above 1 % \
         or fold above 20 degrees, at which the ink of outlines begins, and from any border of \
         two objects. `{SAME_RULE}` is the rule \
         of the true lines, applied to the picture's own depth, normals and ids: what it misses \
         is too small for these pixels.\n\n\
         | | silhouettes found | F1, silhouettes | every line found | precision | wrong, of drawn | F1, every line | ms | blits |\n\
         |---|---|---|---|---|---|---|---|---|",
        size(&times)
    );
    let all: Vec<&Vec<String>> = scores.rows.iter().collect();
    for detector in scores.distinct(&all, "detector") {
        let [found, _, f1] = line_score(&scores, &detector, "silhouettes");
        let [all, precision, every] = line_score(&scores, &detector, "every line");
        let rows = scores.matching(&[("detector", &detector), ("truth", "every line")]);
        let sum = |name| scores.numbers(&rows, name).iter().sum::<f64>();
        let wrong = sum("wrong") / sum("drawn").max(1.0);
        let cost = costs_of.iter().find(|c| c.name == detector);
        let cost = cost.map_or("- | -".into(), |c| {
            format!("{:.2} | {:.2}", c.milliseconds, c.ratio[1])
        });
        let _ = writeln!(
            out,
            "| {detector} | {:.1} % | {f1:.3} | {:.1} % | {:.1} % | {:.2} % | {every:.3} | {cost} |",
            100.0 * found,
            100.0 * all,
            100.0 * precision,
            100.0 * wrong,
        );
    }
    by_scene(out, folder, &scores)?;
    out.push_str("\n![F1 against time](lines.svg)\n\n");
    models(out, folder)?;
    super::ink::ink(out, folder)?;
    super::ink::straight(out, folder)?;
    out.push_str(
        "### Anti-aliasing of bands and lines\n\nErrors against the same style at eight times the \
         resolution. `hard` has no softness, `derivative` is the crate's own softness. `2x2 \
         samples` draws four times the pixels and takes their mean; its time is that of this \
         crate's passes at twice the width and height, without the rest of the frame, which \
         would have four times the pixels too.\n\n\
         | | | FLIP | RMS, codes | ms | blits |\n|---|---|---|---|---|---|\n",
    );
    let fine = costs(&times, "2x2", "teapot", &OWN);
    let blit = costs_of.iter().find(|c| c.name == "blit");
    let blit = blit.map_or(f64::NAN, |b| b.milliseconds);
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
        let ratio = ms / blit;
        let _ = writeln!(
            out,
            "| {what} | {method} | {:.4} | {:.2} | {ms:.2} | {ratio:.2} |",
            smooth.number(row, "flip"),
            smooth.number(row, "codes"),
        );
    }
    out.push('\n');
    softness(out, &smooth);
    Ok(())
}

/// In how many cases the crate's softness is nearer to the fine picture than none.
fn softness(out: &mut String, smooth: &Table) {
    let of = |row: &&Vec<String>, column| {
        let what = smooth.cell(row, "what");
        let hard = smooth.matching(&[("what", what), ("method", "hard")]);
        let hard = hard.first().map(|hard| smooth.number(hard, column));
        hard.is_some_and(|hard| smooth.number(row, column) < hard)
    };
    let soft = smooth.matching(&[("method", "derivative")]);
    let [by_flip, by_codes] =
        ["flip", "codes"].map(|column| soft.iter().filter(|row| of(row, column)).count());
    let _ = writeln!(
        out,
        "Of {} cases, the softness is nearer to the fine picture than `hard` in {by_codes} by RMS, and in \
         {by_flip} by FLIP. Blits are the ratio of the medians here.\n",
        soft.len()
    );
}

/// Scores of all outlines, and fragments, by scene.
fn by_scene(out: &mut String, folder: &Path, scores: &Table) -> Result<(), String> {
    let whole = load(folder, "line_fragments")?;
    out.push_str(
        "\nAll outlines by scene. False pixels lie more than two pixels from a true line, wrong \
         ones also from any faint one; both are fractions of the picture. Fragments are parts of \
         at most six pixels, for each 100 pixels of lines that are 1 pixel wide, in a picture of \
         twice the width and height.\n\n\
         | | lines found | same rule at 1x | precision | F1 | false pixels | wrong pixels | fragments |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for row in &whole.rows {
        let scene = whole.cell(row, "scene");
        let of = |detector| {
            let wanted = [
                ("scene", scene),
                ("detector", detector),
                ("truth", "every line"),
            ];
            let rows = scores.matching(&wanted);
            move |name| scores.numbers(&rows, name).iter().sum::<f64>()
        };
        let (ours, same) = (of("all outlines"), of(SAME_RULE));
        let recall = ours("found") / ours("true").max(1.0);
        let precision = ours("right") / ours("drawn").max(1.0);
        let of_picture = |count: f64| 100.0 * count / ours("pixels").max(1.0);
        let _ = writeln!(
            out,
            "| {scene} | {:.1} % | {:.1} % | {:.1} % | {:.3} | {:.3} % | {:.3} % | {:.2} |",
            100.0 * recall,
            100.0 * same("found") / same("true").max(1.0),
            100.0 * precision,
            2.0 * recall * precision / (recall + precision).max(1e-9),
            of_picture(ours("drawn") - ours("right")),
            of_picture(ours("wrong")),
            100.0 * whole.number(row, "fragments") / whole.number(row, "line").max(1.0),
        );
    }
    Ok(())
}

/// Scores of the outlines on models that turn, by model and distance.
fn models(out: &mut String, folder: &Path) -> Result<(), String> {
    if !folder.join("model_scores.csv").exists() {
        out.push_str("### Lines of models\n\nNot measured yet: `report --only models`.\n\n");
        return Ok(());
    }
    let scores = load(folder, "model_scores")?;
    let all: Vec<&Vec<String>> = scores.rows.iter().collect();
    let [frames, count] = ["frame", "model"].map(|column| scores.distinct(&all, column).len());
    let _ = writeln!(
        out,
        "### Lines of models\n\nAll outlines of {count} generated models, each turned through \
         {frames} frames, near and far. False pixels are those with a line that lie \
         more than two pixels from a true one, wrong pixels those that also lie that far from \
         any faint line; both are fractions of the picture. Fragments are parts \
         of at most six pixels, for each 100 pixels of lines that are 1 pixel wide, in a picture \
         four times as wide and high.\n\n\
         | | lines found | precision | F1 | false pixels | wrong pixels | fragments |\n\
         |---|---|---|---|---|---|---|"
    );
    for model in scores.distinct(&all, "model") {
        for distance in scores.distinct(&all, "distance") {
            let rows = scores.matching(&[("model", &model), ("distance", &distance)]);
            let sum = |name| scores.numbers(&rows, name).iter().sum::<f64>();
            let recall = sum("found") / sum("true").max(1.0);
            let precision = sum("right") / sum("drawn").max(1.0);
            let _ = writeln!(
                out,
                "| {model}, {distance} | {:.1} % | {:.1} % | {:.3} | {:.3} % | {:.3} % | {:.2} |",
                100.0 * recall,
                100.0 * precision,
                2.0 * recall * precision / (recall + precision).max(1e-9),
                100.0 * sum("false") / sum("pixels").max(1.0),
                100.0 * sum("wrong") / sum("pixels").max(1.0),
                100.0 * sum("fragments") / sum("line").max(1.0),
            );
        }
    }
    out.push('\n');
    Ok(())
}
