//! At a scale factor of 2, in a picture of twice as many pixels, settings in logical pixels mean
//! twice as many of them.

use crate::{
    outlines::{ink, put},
    overshoot,
    prelude::*,
    walls::unit_per_pixel,
};

/// In logical pixels; a unit of the scene is one.
const SIZE: UVec2 = UVec2::new(192, 32);

/// A step between two walls along the middle row, which closes from left to right. Its line goes
/// from the left border of the picture to a loose end.
fn closing_step(small: &mut Small, scale: u32) {
    small.headless.resize(SIZE * scale, scale as f32);
    small.restart(Msaa::Off);
    small.clear();
    small.insert((
        Transform::IDENTITY,
        Projection::Orthographic(unit_per_pixel(SIZE)),
    ));
    // The walls meet 60 pixels to the right of the middle.
    let angle = 1f32.to_radians();
    put(
        small,
        Rectangle::new(400.0, 200.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 100.0, -50.0),
    );
    put(
        small,
        Rectangle::new(800.0, 400.0),
        Color::WHITE,
        Transform::from_xyz(0.0, 0.0, -50.0 - 60.0 * angle.tan())
            .with_rotation(Quat::from_rotation_y(-angle)),
    );
}

fn lines(hysteresis: f32, taper: f32) -> Outlines {
    Outlines {
        hysteresis,
        hysteresis_ratio: 0.1,
        min_length: 1,
        ..overshoot::lines(4.0, 0.0, taper)
    }
}

/// The number of cracks of the line.
fn length(small: &mut Small, outlines: Outlines) -> usize {
    small.style(&ComicStyle::new().with(outlines)).settle();
    let cracks = small.cracks().expect("lines");
    cracks.words.iter().filter(|word| word[1] & 7 != 0).count()
}

/// A line continues along its weak part by the asked number of logical pixels, exactly.
#[test]
fn lines_continue_by_logical_pixels() {
    let mut small = Small::new(SIZE, Msaa::Off);
    for scale in [1, 2] {
        closing_step(&mut small, scale);
        let certain = length(&mut small, lines(0.0, 0.0));
        for hysteresis in [4, 8] {
            let grown = length(&mut small, lines(hysteresis as f32, 0.0)) - certain;
            assert_eq!(grown, hysteresis * scale as usize, "scale {scale}");
        }
        // The weak part is longer than that.
        let whole = length(&mut small, lines(32.0, 0.0)) - certain;
        assert!(whole > 8 * scale as usize, "scale {scale}: {whole}");
    }
}

/// Widths along the line, column by column, from its loose end on.
fn from_the_end(small: &mut Small, outlines: Outlines, scale: u32) -> Vec<f64> {
    let all = ink(small, outlines);
    let cracks = small.cracks().expect("lines");
    let width = (SIZE.x * scale) as usize;
    let last = (0..cracks.words.len())
        .filter(|i| cracks.words[*i][1] & 7 != 0)
        .map(|i| i % width)
        .max()
        .expect("a line");
    let rows = (SIZE.y * scale) as usize;
    (0..=last)
        .rev()
        .map(|x| (0..rows).map(|y| f64::from(all[y * width + x])).sum())
        .collect()
}

/// The width of a line that tapers is that of the formula at every crack, in logical pixels: at
/// scale 2, it is twice as wide and tapers over twice as many cracks.
#[test]
fn lines_taper_over_logical_pixels() {
    let mut small = Small::new(SIZE, Msaa::Off);
    let taper = 24.0;
    for scale in [1, 2] {
        closing_step(&mut small, scale);
        let found = from_the_end(&mut small, lines(0.0, taper), scale);
        let scale = f64::from(scale);
        for (crack, width) in found.iter().enumerate().take(40 * scale as usize) {
            // The distance of the middle of the crack from the end of the line.
            let t = ((crack as f64 + 0.5) / (f64::from(taper) * scale)).min(1.0);
            let want = 4.0 * scale * t * t * (3.0 - 2.0 * t);
            // Thinner lines than 0.6 physical pixels are fainter instead, and do not reach as far
            // as the next pixels. Wider cracks beside this one cover a little of its column.
            assert!(
                (width - want).abs() < 0.05 * scale,
                "scale {scale}, {crack} cracks from the end: {width}, {want}"
            );
        }
    }
}
