//! Lines that crowd: how much of the picture they cover.

use bevy::prelude::*;
use bevy_comics::{ComicStyle, Outlines};

use crate::{
    small::{Small, black_ink, unlit},
    walls::{towards_the_sky, wall},
};

const SIZE: UVec2 = UVec2::new(96, 64);

/// Walls of 40 x 64 pixels on the left, an empty wall on the right: a crowd of small plates,
/// `step` pixels apart, each in front of the next.
fn crowd(step: f32) -> Small {
    scattered_crowd(step, 0.0)
}

/// The same with each plate moved by up to a number of pixels along both axes.
fn scattered_crowd(step: f32, scatter: f32) -> Small {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 900.0);
    let plate = Rectangle::from_length(0.5 * step);
    let [columns, rows] = [(48.0 / step) as i32, (64.0 / step) as i32];
    for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
        let place = Vec2::new(i as f32 + 0.5, j as f32 + 0.5) * step - Vec2::new(48.0, 32.0);
        let moved = Vec2::new(
            0.618 * i as f32 + 0.37 * j as f32,
            0.73 * i as f32 + 0.28 * j as f32,
        );
        let place = place + scatter * (2.0 * moved.fract() - 1.0);
        let turned = Quat::from_rotation_z(0.7 * (i + 3 * j) as f32);
        let depth = 100.0 + 80.0 * ((i * 7 + j * 3) % 9) as f32;
        let at = Transform::from_translation(place.extend(-depth)).with_rotation(turned);
        small.put(plate, unlit(Color::WHITE), at);
    }
    small
}

/// Ink of the crowd's inner part, as a fraction of its area.
fn coverage(small: &mut Small, width: f32, budget: f32) -> f64 {
    let outlines = Outlines {
        width,
        budget,
        ..Outlines::SILHOUETTES
    };
    small.style(&ComicStyle::new().with(outlines));
    small.settle();
    let inner = (14..50).flat_map(|y| (12..36).map(move |x| (x, y)));
    black_ink(&small.picture(), inner) / (36.0 * 24.0)
}

/// Truth: the mean tone of a field of crowded lines stays within the budget, for every size
/// of its parts; where there is room, nothing changes.
#[test]
fn crowded_lines_keep_their_budget() {
    for step in [4.0, 6.0, 9.0] {
        let mut small = crowd(step);
        for width in [1.0, 2.0, 4.0] {
            let free = coverage(&mut small, width, 1.0);
            for budget in [0.1, 0.2, 0.35] {
                let found = coverage(&mut small, width, budget);
                println!("{step} px, {width} px wide, {budget}: {free:.3} -> {found:.3}");
                // A band of the budget's own areas: the density changes from cell to cell.
                assert!(
                    found <= f64::from(budget) * 1.15,
                    "{step}, {width}, {budget}: {found}"
                );
                assert!(
                    found <= free + 1e-3,
                    "{step}, {width}, {budget}: {found}, {free}"
                );
                if free < 0.5 * f64::from(budget) {
                    assert!(
                        (found - free).abs() < 0.01,
                        "{step}, {width}: {found}, {free}"
                    );
                }
            }
        }
    }
}

/// While the camera moves past a crowd by a quarter of a pixel per frame, its ink neither pops
/// nor flickers: in an area that is hardly larger than those of the budget, it changes by at most a
/// tenth of the budget at once, and by a fiftieth on average. Plates of a few pixels lose and
/// gain rows of pixels while they move, so there is a change without a budget too.
#[test]
fn crowds_that_pass_slowly_are_steady() {
    const SPEED: f32 = 0.25;
    for step in [4.0, 6.0, 9.0] {
        // Plates in step would all gain a row of pixels in the same frame.
        let mut small = scattered_crowd(step, 0.5);
        for width in [1.0, 2.0, 4.0] {
            for budget in [1.0, 0.35, 0.2] {
                let outlines = Outlines {
                    width,
                    budget,
                    ..Outlines::SILHOUETTES
                };
                small.insert(Transform::IDENTITY);
                small.style(&ComicStyle::new().with(outlines));
                small.settle();
                let found = (0..=32).map(|frame| {
                    small.insert(Transform::from_xyz(-SPEED * frame as f32, 0.0, 0.0));
                    small.headless.step(1);
                    let area = (8..56).flat_map(|y| (10..42).map(move |x| (x, y)));
                    black_ink(&small.picture(), area) / (32.0 * 48.0)
                });
                let found: Vec<f64> = found.collect();
                let changes = found.windows(2).map(|two| (two[1] - two[0]).abs());
                let most = changes.clone().fold(0.0, f64::max);
                let mean = changes.sum::<f64>() / 32.0;
                println!("{step} px, {width} px wide, {budget}: mean {mean:.4}, most {most:.4}");
                if budget < 1.0 {
                    let budget = f64::from(budget);
                    assert!(most < budget / 10.0, "{step}, {width}, {budget}: {most}");
                    assert!(mean < budget / 50.0, "{step}, {width}, {budget}: {mean}");
                }
            }
        }
    }
}

/// A lone line is as wide as asked, also beside a crowd at a distance.
#[test]
fn lone_lines_do_not_change() {
    let mut small = towards_the_sky(SIZE);
    wall(&mut small, [-60.0, -40.0], [60.0, 40.0], 900.0);
    wall(&mut small, [-60.0, -40.0], [10.0, 40.0], 100.0);
    for width in [1.0, 2.0, 4.0, 8.0] {
        let outlines = |budget| Outlines {
            width,
            budget,
            ..Outlines::SILHOUETTES
        };
        for budget in [1.0, 0.35] {
            small.style(&ComicStyle::new().with(outlines(budget)));
            small.settle();
            let row = (20..90).map(|x| (x, 32));
            let found = black_ink(&small.picture(), row);
            assert!(
                (found - f64::from(width)).abs() < 0.02,
                "{width}, {budget}: {found}"
            );
        }
    }
}
