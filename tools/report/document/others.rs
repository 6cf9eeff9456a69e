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
        "The teapot at {}, in one process and in turn. Settings are the crates' defaults, but \
         for what a row names; the lines of bevy_mod_outline are 2 pixels wide. The camera \
         always has the depth and normal prepass, so that their time is in no row. All times \
         are those over the frame without any of the crates. \"Full-screen passes\" are all \
         passes after the main pass, and this crate's passes before it. \"Whole camera\" is the \
         whole frame, with the noise of the main pass: the time of crates that draw lines or \
         light with the meshes. It is negative where a camera is faster than the frame without the crates, in \
         which meshes have the standard material, and by noise. The crates do not draw the same: extruded and scaled shells \
         are lines around objects only, and a material draws no lines.\n\n\
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
        "## 6. A range that does not flicker\n\nSequences of 72 frames, at 60 frames per second. \
         The flicker of a frame is the difference, in display codes, between the frame and the \
         same frame drawn with the range of the frame before: the change that the scene itself \
         does not cause. The columns are the mean over all pixels and frames, the largest mean \
         of a frame, and the largest 99th percentile of a frame. The lag is the distance \
         between the drawn and the exact range in octaves of distance, for the end that \
         differs more, as the mean over all frames (outliers that percentiles leave out count \
         as lag). The camera cut is announced, and starts every variant anew. The ranges are \
         computed by the reference of the shader, which the tests compare with the shader.\n\n\
         | sequence | smoothing | flicker, mean | worst frame | worst 99 % | lag, octaves |\n\
         |---|---|---|---|---|---|\n",
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
            "\nAn intruder crosses near the camera for half a second, from frame 20 to frame 49: \
             without smoothing (above) and with the default (below). Frames 18, 20, 24, 35, 51 \
             and 66.\n\n![Six frames without and with smoothing](flicker.png)\n",
        );
    }
    out.push_str("\n![Flicker against lag](flicker.svg)\n\n");
    Ok(())
}
