//! The report's text: how exactly the page is printed.

use std::{fmt::Write, path::Path};

use crate::load;

pub fn page(out: &mut String, folder: &Path) -> Result<(), String> {
    let table = load(folder, "page_screens")?;
    let all: Vec<&Vec<String>> = table.rows.iter().collect();
    out.push_str(
        "### The printed page\n\nErrors of screens, in double precision; every pixel of the shader \
         equals this within rounding (`tests/gpu/halftone.rs`). Tone: the largest difference of \
         the mean of a flat area from its tone, of 11 tones at four angles. Jump: the largest \
         change of a pixel when the tone changes by 1/1024. Moire: the part of the power of a \
         print less its picture that is below half of the screen's frequency, the larger one of a \
         gradient and of rings that become finer. The largest of periods of 4 pixels and more; at \
         3 pixels the tone alone:\n\n\
         | screen | tone | jump | moire | tone at 3 px |\n|---|---|---|---|---|\n",
    );
    for shape in table.distinct(&all, "what") {
        let rows = table.matching(&[("what", &shape)]);
        let is_fine = |row: &&&Vec<String>| table.number(row, "period") < 4.0;
        let largest = |fine: bool, column: &str| {
            let rows = rows.iter().filter(|row| is_fine(row) == fine);
            rows.map(|row| table.number(row, column).abs())
                .fold(f64::NAN, f64::max)
        };
        let of = |column| largest(false, column);
        let _ = writeln!(
            out,
            "| {} | {:.4} | {:.3} | {:.2} % | {:.4} |",
            shape.to_lowercase(),
            of("tone"),
            of("jump"),
            100.0 * of("moire"),
            largest(true, "tone"),
        );
    }
    let colors = load(folder, "page_colors")?;
    out.push_str(
        "\nThe largest difference of the mean light of a print with four inks from its colour, of \
         20 colours and three lights each, by the fraction of grey that is printed in black:\n\n\
         | black | difference |\n|---|---|\n",
    );
    for row in &colors.rows {
        let _ = writeln!(
            out,
            "| {} | {:.4} |",
            colors.cell(row, "black"),
            colors.number(row, "error")
        );
    }
    let harmonies = load(folder, "page_harmonies")?;
    out.push_str(
        "\nThe largest change of the lightness in OKLab (0 to 1) by a `ColorHarmony`, of 32 x 32 x 32 \
         colours at three places in the depth map, with the strongest change of hue:\n\n\
         | mode | change |\n|---|---|\n",
    );
    for row in &harmonies.rows {
        let _ = writeln!(
            out,
            "| {} | {:.4} |",
            harmonies.cell(row, "mode"),
            harmonies.number(row, "lightness")
        );
    }
    out.push_str("\nTheir times are under \"Single parts\".\n\n");
    Ok(())
}
