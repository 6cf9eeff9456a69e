//! The report's text: other crates, and the range over time.

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
        "The teapot at {}, in one process and in turn, with the crates' defaults but for what a row names; the lines of \
         bevy_mod_outline are 2 pixels wide. The depth and normal prepass is always on, so its time is in no row. Times \
         are those over the frame without any of the crates. \"Full-screen passes\": all after the main pass, and this \
         crate's before it. \"Whole camera\": the frame, with the noise of the main pass, for crates that draw with the \
         meshes; it is negative where it is faster than the frame with the standard material, and by noise. Extruded and \
         scaled shells are lines around objects only, and a material draws no lines.\n\n\
         | | full-screen passes, ms | blits | 10 % to 90 % | whole camera, ms |\n|---|---|---|---|---|",
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
                "* {} takes {:.2} times as long as {} (full-screen passes alone: {:.2} and {:.2} ms).",
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
        "## 6. A range that does not flicker\n\n\
         Sequences of 72 frames, at 60 frames per second. Flicker: the difference, in display codes, between a frame and \
         the same frame drawn with the range of the frame before, which the scene does not cause: the mean over pixels and \
         frames, the largest mean, and the largest 99th percentile of a frame. Lag: the distance between the drawn and the \
         exact range in octaves, at the end that differs more, in the mean (outliers that percentiles leave out count). \
         The camera cut is announced, and starts every variant anew. The ranges are those of the shader's reference.\n\n\
         | sequence | smoothing | flicker, mean | worst frame | worst 99 % | lag, octaves |\n|---|---|---|---|---|---|\n",
    );
    for sequence in table.values("sequence") {
        for variant in table.values("variant") {
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
            "\nAn intruder crosses near the camera from frame 20 to 49: frames 18, 20, 24, 35, 51 and 66 without smoothing \
             (above) and with the default.\n\n\
             ![Six frames without and with smoothing](flicker.png)\n",
        );
    }
    out.push_str("\n![Flicker against lag](flicker.svg)\n\n");
    Ok(())
}
