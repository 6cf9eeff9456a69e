//! Other crates, and the range over time.

use std::{fmt::Write, path::Path};

use crate::{
    costs::{LAPS, OWN, costs, size, unsigned_zero},
    load,
    table::largest,
};

pub fn peers(out: &mut String, folder: &Path) -> Result<(), String> {
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

pub fn flicker(out: &mut String, folder: &Path) -> Result<(), String> {
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
