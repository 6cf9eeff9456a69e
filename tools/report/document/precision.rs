//! The report's text: the range, and what lines find and cost.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{OWN, cost_table, costs, line_score, size},
    load,
    scores::SAME_RULE,
    table::Table,
};

pub fn ranges(out: &mut String, folder: &Path) -> Result<(), String> {
    let times = load(folder, "range_times")?;
    let _ = writeln!(
        out,
        "### The range\n\n\
         Time of the crate's reductions at {}, in the app (the passes of the range alone; every exact method gives the \
         same bits):\n",
        size(&times)
    );
    let all = costs(&times, "ranges", "teapot", &["range"]);
    cost_table(out, &all);
    if let Some(exact) = all.iter().find(|cost| cost.name == "BarrierFree") {
        let _ = writeln!(
            out,
            "The exact range takes {:.2} blits (barrier-free), which is all that a cheaper one could save. \
             docs/internals/measurements.md has what it would lose.\n",
            exact.ratio[1]
        );
    }
    Ok(())
}

pub fn lines(out: &mut String, folder: &Path) -> Result<(), String> {
    let scores = load(folder, "line_scores")?;
    let times = load(folder, "line_times")?;
    let costs_of = costs(&times, "lines", "teapot", &OWN);
    let _ = writeln!(
        out,
        "### Lines\n\n\
         The true lines come from the scene at four times the resolution. Scores are over the pixels of all scenes; times \
         are at {}. Contours measure a jump as a fraction of the visible range, outlines of the distance: in deep scenes, \
         contours find fewer lines. \"F1, silhouettes\" counts every line that is no silhouette as false.\n\n\
         A pixel is wrong if it has ink more than two pixels from any depth step above 1 % or fold above 20 degrees, at \
         which ink begins, and from any border of objects. `{SAME_RULE}` applies the rule of the true lines to the picture \
         itself: what it misses is too small for its pixels.\n\n\
         | | silhouettes found | F1, silhouettes | every line found | precision | wrong, of drawn | F1, every line | ms | \
         blits |\n|---|---|---|---|---|---|---|---|---|",
        size(&times)
    );
    for detector in scores.values("detector") {
        let [found, _, f1] = line_score(&scores, &detector, "silhouettes");
        let [all, precision, every] = line_score(&scores, &detector, "every line");
        let rows = scores.matching(&[("detector", &detector), ("truth", "every line")]);
        let sum = |name| scores.sum(&rows, name);
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
    Ok(())
}

/// Scores of all outlines, and fragments, by scene.
fn by_scene(out: &mut String, folder: &Path, scores: &Table) -> Result<(), String> {
    let whole = load(folder, "line_fragments")?;
    out.push_str(
        "\nAll outlines by scene. False pixels lie more than two pixels from a true line, wrong ones also from any faint \
         one; both are fractions of the picture. Fragments: parts of at most six pixels, for each 100 pixels of lines of 1 \
         pixel, at twice the resolution.\n\n\
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
            move |name| scores.sum(&rows, name)
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
    let [frames, count] = ["frame", "model"].map(|column| scores.values(column).len());
    let _ = writeln!(
        out,
        "### Lines of models\n\n\
         All outlines of {count} generated models, each turned through {frames} frames, near and far. Columns are those \
         above; fragments are counted at four times the resolution.\n\n\
         | | lines found | precision | F1 | false pixels | wrong pixels | fragments |\n|---|---|---|---|---|---|---|"
    );
    for model in scores.values("model") {
        for distance in scores.values("distance") {
            let rows = scores.matching(&[("model", &model), ("distance", &distance)]);
            let sum = |name| scores.sum(&rows, name);
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
