//! How dense lines are. `cracks.rs` compares widths under a budget with the reference, and
//! `crowds.rs` measures them; these tests compare the density of the reference with geometry.

use bevy_comics_testkit::reference::{budget::line_density, link::Place};

use super::*;

/// The cracks between the pixels of a region whose centres have different values.
fn borders(value: impl Fn(f64, f64) -> i64) -> HashSet<Place> {
    let at = |x: i64, y: i64| value(x as f64 + 0.5, y as f64 + 0.5);
    let pixels = (-20..40).flat_map(|y| (-20..40).map(move |x| [x, y]));
    pixels
        .flat_map(|pixel| [0, 1].map(|side| (pixel, side)))
        .filter(|([x, y], side)| at(*x, *y) != at(x + 1 - *side as i64, y + *side as i64))
        .collect()
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
            let lines = borders(|x, y| ((x * cos + y * sin) / spacing).floor() as i64);
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
            let side = |x: f64, y: f64| (x - 2.0 + shift) * cos + (y - 4.0) * sin > 0.01;
            let lines = borders(|x, y| i64::from(side(x, y)));
            let found = line_density(&lines, [0, 0]);
            assert!(found < 0.075, "{turn} degrees, {shift}: {found}");
        }
    }
}
