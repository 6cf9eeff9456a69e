//! Ink on paper.

use bevy_comics_testkit::reference::paper::on_paper;

use super::{
    settings::{expression, view},
    *,
};
use crate::prelude::*;

const IMPORTS: &str = "#import bevy_comics::effects::paper::{Paper, on_paper}";

/// Light that no display shows included.
#[test]
fn ink_on_paper_matches_the_reference() {
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
        let fields = ["vec3", "f32", "f32", "f32", "f32", "u32", "vec2"];
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
