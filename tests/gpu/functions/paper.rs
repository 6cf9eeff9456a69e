//! Paper: its height, and ink on it.

use bevy_comics::Paper;
use bevy_comics_testkit::reference::paper::{height, on_paper};

use super::{
    settings::{expression, view},
    *,
};

const IMPORTS: &str = "#import bevy_comics::effects::paper::{Paper, on_paper, paper_height}";

#[test]
fn the_height_of_paper_is_that_of_the_twin() {
    let row = (0.0f32..=4000.0, 0.0f32..=4000.0, 0u16..=300)
        .prop_map(|(x, y, sheet)| [x, y, f32::from(sheet)]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            IMPORTS,
            "return vec4(paper_height(vec2(i(0u), i(1u)), u(2u)), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = height([row[0], row[1]].map(f64::from), row[2] as u32);
            // Noise of slope 3 per 1.5 pixels, at places that are rounded to 5e-4.
            let apart = (f64::from(found[0]) - want).abs();
            assert!(apart < 4e-3, "{row:?}: {found:?}, {want}");
        }
    });
}

/// Light that no display shows included.
#[test]
fn ink_on_paper_is_that_of_the_twin() {
    let row = || {
        let height = -1.0f32..=1.0;
        let colors = (wide_component(), wide_component(), component(), height);
        colors.prop_map(|(r, g, b, height)| [r, g, b, height])
    };
    for paper in [
        Paper::default(),
        Paper {
            grain: 1.0,
            shading: 0.3,
            ..Paper::default()
        },
    ] {
        let fields = ["vec3", "f32", "f32", "f32", "f32", "u32"];
        let s = expression("Paper", &fields, &paper, &view([96, 64], 1.0, 0.0));
        for_batches(row(), |rows| {
            let body = format!(
                "let c = on_paper({s}, vec3(i(0u), i(1u), i(2u)), i(3u)); return vec4(c, 0.0);"
            );
            for (row, found) in rows.iter().zip(gpu().evaluate(IMPORTS, &body, rows)) {
                let want = on_paper(&paper, rgb(row), f64::from(row[3]));
                assert_same_color(row, found, want);
                let shown = row[..3].iter().all(|c| (0.0..=1.0).contains(c));
                assert!(
                    !shown || want.iter().all(|c| (0.0..=1.2).contains(c)),
                    "{row:?}"
                );
            }
        });
    }
}

/// Truth: heights are as often above 0 as below, so that what is added to a tone is 0 in
/// the mean; and they vary.
#[test]
fn the_sheet_is_level() {
    for sheet in 0..6 {
        let heights: Vec<f64> = (0..90_000)
            .map(|n| {
                let at = [n % 300, n / 300].map(|v| f64::from(v) + 0.5);
                height(at, sheet)
            })
            .collect();
        let count = heights.len() as f64;
        let mean = heights.iter().sum::<f64>() / count;
        let square = heights.iter().map(|h| h * h).sum::<f64>() / count;
        // 625 grains of the coarsest octave, with a deviation of 0.2.
        assert!(mean.abs() < 0.03, "{sheet}: {mean}");
        assert!((0.3..0.7).contains(&square.sqrt()), "{sheet}: {square}");
    }
}
