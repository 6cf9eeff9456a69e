//! What is left of lines where they crowd.

use bevy_comics_testkit::reference::{
    budget::{budget_weight, line_density},
    link::Place,
};

use super::*;
use crate::prelude::*;

const BUDGET: &str = "#import bevy_comics::lines::budget::{
        budget_weight, column_weight, counted, line_density,
    }";

/// Random cracks in one column: the sum over columns is the test's.
#[test]
#[ignore = "long: thousands of random columns"]
fn the_density_of_lines_matches_the_reference() {
    let row = (0u32..=0x3fff, 0u32..=0x3fff, 0u32..24)
        .prop_map(|(high, low, column)| [high as f32, low as f32, column as f32]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            BUDGET,
            "let bits = (u(0u) << 18u) | (u(1u) << 4u);
             let sum = column_weight(i32(u(2u))) * counted(bits);
             return vec4(line_density(sum), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let bits = (row[0] as u32) << 18 | (row[1] as u32) << 4;
            let x = row[2] as i64 - 10;
            let set = (0..32).filter(|y| bits >> y & 1 == 1);
            let lines: HashSet<Place> = set.map(|y| ([x, y - 12], 0)).collect();
            let want = line_density(&lines, [3, 7]);
            assert!(
                (f64::from(found[0]) - want).abs() < 1e-6,
                "{row:?}: {found:?}, {want}"
            );
        }
    });
}

/// Truth: a field of parallel lines `spacing` apart has the density 1 / spacing, whatever
/// its direction is, on average over directions and places.
#[test]
fn fields_of_parallel_lines_have_their_density() {
    for spacing in [3.0, 5.0, 8.0] {
        let mut sum = 0.0;
        let mut count = 0.0;
        for turn in 0..36 {
            let (sin, cos) = (f64::from(turn) * 5.0 + 1.3).to_radians().sin_cos();
            let band = |x: f64, y: f64| ((x * cos + y * sin) / spacing).floor() as i64;
            let mut lines: HashSet<Place> = HashSet::new();
            for (x, y) in (-20..40).flat_map(|y| (-20..40).map(move |x| (x, y))) {
                let at = |dx: i64, dy: i64| band((x + dx) as f64 + 0.5, (y + dy) as f64 + 0.5);
                if at(0, 0) != at(1, 0) {
                    lines.insert(([x, y], 0));
                }
                if at(0, 0) != at(0, 1) {
                    lines.insert(([x, y], 1));
                }
            }
            for place in [[0, 0], [5, 9], [8, 16]] {
                sum += line_density(&lines, place);
                count += 1.0;
            }
        }
        let mean: f64 = sum / count * spacing;
        assert!((mean - 1.0).abs() < 0.02, "{spacing}: {mean}");
    }
}

/// Truth: straight lines through every cell have the density of a lone line, in every
/// direction.
#[test]
fn lone_lines_have_little_density() {
    for turn in 0..180 {
        let (sin, cos) = f64::from(turn).to_radians().sin_cos();
        for shift in [-3.0, 0.0, 2.5] {
            let side = |x: i64, y: i64| {
                let [x, y] = [x as f64 - 1.5 + shift, y as f64 - 3.5];
                x * cos + y * sin > 0.01
            };
            let mut lines: HashSet<Place> = HashSet::new();
            for (x, y) in (-20..40).flat_map(|y| (-20..40).map(move |x| (x, y))) {
                if side(x, y) != side(x + 1, y) {
                    lines.insert(([x, y], 0));
                }
                if side(x, y) != side(x, y + 1) {
                    lines.insert(([x, y], 1));
                }
            }
            let found = line_density(&lines, [0, 0]);
            assert!(found < 0.075, "{turn} degrees, {shift}: {found}");
        }
    }
}

/// The factor is 1 below the budget; above it, width times density is the budget.
#[test]
fn crowded_lines_get_the_budget() {
    let row = (0.05f32..=1.0, 0.0f32..=1.0, 0.0f32..=16.0)
        .prop_map(|(budget, density, width)| [budget, density, width]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            BUDGET,
            "return vec4(budget_weight(i(0u), i(1u), i(2u)), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [budget, density, width] = row.map(f64::from);
            let found = f64::from(found[0]);
            assert!(
                (found - budget_weight(budget, density, width)).abs() < 1e-5,
                "{row:?}: {found}"
            );
            let covered = found * density * width;
            if density >= 0.15 {
                let want = budget.min(density * width);
                assert!((covered - want).abs() < 1e-5, "{row:?}: {covered}, {want}");
            } else if density <= 0.075 {
                assert_eq!(found, 1.0, "{row:?}");
            }
        }
    });
}
