//! How densely lines lie. `cracks.rs` compares widths under a budget with the reference, and
//! `crowds.rs` measures them; these tests compare the reference with geometry.

use bevy_comics_testkit::reference::{budget::Densities, link::Place};

use super::*;

/// The cracks between the pixels of a square picture whose centers have different values. Places
/// are relative to its middle.
fn borders(size: i64, value: impl Fn(f64, f64) -> i64) -> HashSet<Place> {
    let half = 0.5 * size as f64;
    let at = |x: i64, y: i64| value(x as f64 + 0.5 - half, y as f64 + 0.5 - half);
    let values: Vec<i64> = (0..size * size).map(|i| at(i % size, i / size)).collect();
    let pixels = (0..size - 1).flat_map(|y| (0..size - 1).map(move |x| [x, y]));
    let places = pixels.flat_map(|pixel| [0, 1].map(|side| (pixel, side)));
    let differ = |([x, y], side): &Place| {
        let here = (y * size + x) as usize;
        values[here] != values[here + [1, size as usize][*side]]
    };
    places.filter(differ).collect()
}

/// Truth: a field of parallel lines `spacing` apart has the density 1 / spacing at 0, 45 and 90
/// degrees, and at most 8.3 % more between; in the mean of all places of the lines between the
/// squares.
#[test]
fn fields_of_parallel_lines_have_their_density() {
    assert_density(&[3, 8], &[0, 1, 3, 6, 8, 11]);
}

#[test]
#[ignore = "long: every turn"]
fn fields_of_parallel_lines_in_every_turn_have_their_density() {
    let turns: Vec<i32> = (0..12).collect();
    assert_density(&[3, 5, 8], &turns);
}

/// `turns`: by 15 degrees.
fn assert_density(spacings: &[i32], turns: &[i32]) {
    const SIZE: i64 = 128;
    for &spacing in spacings {
        for &turn in turns {
            let (sin, cos) = (f64::from(turn) * 15.0).to_radians().sin_cos();
            let places = (0..spacing).map(|shift| {
                // Away from the centers of pixels.
                let along = |x: f64, y: f64| x * cos + y * sin + f64::from(shift) + 0.013;
                let line = |x, y| (along(x, y) / f64::from(spacing)).floor() as i64;
                let densities = Densities::new(&borders(SIZE, line), [SIZE; 2]);
                densities.around([SIZE / 2; 2], 40.0)
            });
            let mean = places.sum::<f64>();
            let most = if turn % 3 == 0 { 1.0 } else { 1.083 };
            let what = format!("{spacing} px, {turn}: {mean}");
            // Shifts of whole pixels are all places only at right angles.
            assert!(mean > 0.99 && mean < most + 0.01, "{what}");
        }
    }
}

/// Which side of some lines from or through the middle a place is on.
type Shape = (&'static str, fn(f64, f64) -> i64);

/// Lone lines, and few lines that meet.
const SHAPES: [Shape; 8] = [
    ("line", |x, _| i64::from(x > 0.0)),
    ("diagonal", |x, y| i64::from(x > y)),
    ("T", |x, y| i64::from(x > 0.0) * (1 + i64::from(y > 0.0))),
    ("Y", |x, y| {
        let third = (y.atan2(x).to_degrees() / 120.0 + 0.3).floor() as i64;
        third.rem_euclid(3)
    }),
    ("X", |x, y| 2 * i64::from(x > 0.0) + i64::from(y > 0.0)),
    ("diagonal X", |x, y| {
        2 * i64::from(x > y) + i64::from(x > -y)
    }),
    ("pair", |x, _| i64::from(x > 0.0) + i64::from(x > 6.0)),
    ("diagonal pair", |x, y| {
        i64::from(x > y) + i64::from(x > y + 9.0)
    }),
];

/// Truth: lone lines and few lines that meet keep their width, whatever it is, and wherever they
/// lie between the squares.
#[test]
fn lone_lines_and_few_that_meet_keep_their_width() {
    assert_width_is_kept(2);
}

#[test]
#[ignore = "long: every shape in four places"]
fn lone_lines_and_few_that_meet_keep_their_width_everywhere() {
    assert_width_is_kept(1);
}

/// `step`: of the places of each shape, one in so many.
fn assert_width_is_kept(step: usize) {
    const SIZE: i64 = 288;
    const SHIFTS: [[f64; 2]; 4] = [[0.21, 0.1], [3.21, 5.1], [-6.8, 12.1], [14.2, -25.9]];
    for (i, (name, shape)) in SHAPES.into_iter().enumerate() {
        for shift in SHIFTS.into_iter().skip(i % step).step_by(step) {
            let lines = borders(SIZE, |x, y| shape(x - shift[0], y - shift[1]));
            let densities = Densities::new(&lines, [SIZE; 2]);
            for width in [1.0, 2.0, 4.0, 8.0, 16.0] {
                // Where they meet.
                let is_near = |i: i64| (i - SIZE / 2).abs() < 48;
                let near = lines.iter().filter(|(p, _)| p.iter().all(|i| is_near(*i)));
                let factors = near.map(|(pixel, _)| {
                    let factor = densities.budget_weight(0.35, *pixel, width);
                    (factor, pixel)
                });
                let least = factors.min_by(|a, b| a.0.total_cmp(&b.0)).expect("lines");
                assert!(least.0 > 0.995, "{name}, {width} px, {shift:?}: {least:?}");
            }
        }
    }
}
