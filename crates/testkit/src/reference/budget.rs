//! Reference of `lines/link/budget.wgsl`: how much of the width of lines is left where they crowd.

use std::{collections::HashSet, f64::consts::FRAC_PI_4};

use super::{link::Place, smoothstep};

/// Columns and rows of the cells whose lines share their budget.
const CELL: [i64; 2] = [4, 8];

/// The length of lines per area around the cell of a pixel of the grid, in 1 / pixels. The
/// weight of a crack falls with its distance: linearly across, in three steps down.
pub fn line_density(lines: &HashSet<Place>, pixel: [i64; 2]) -> f64 {
    let [left, top] = [0, 1].map(|i| pixel[i] - pixel[i].rem_euclid(CELL[i]));
    let mut sum = 0.0;
    let mut all = 0.0;
    for y in top - 12..top + 20 {
        let rows = match y - top {
            0..8 => 3.0,
            -4..12 => 2.0,
            _ => 1.0,
        };
        for x in left - 10..left + 14 {
            let columns = 1.0 - (x as f64 + 0.5 - (left as f64 + 2.0)).abs() / 12.0;
            let cracks = [0, 1]
                .into_iter()
                .filter(|side| lines.contains(&([x, y], *side)));
            sum += columns * rows * cracks.count() as f64;
            all += columns * rows;
        }
    }
    FRAC_PI_4 * sum / all
}

/// The factor of a line's width. A single line through the middle has a density of less than
/// 0.075; lines crowd from 0.15 on.
pub fn budget_weight(budget: f64, density: f64, width: f64) -> f64 {
    let covered = density * smoothstep(0.075, 0.15, density) * width;
    if covered <= budget {
        1.0
    } else {
        budget / covered
    }
}
