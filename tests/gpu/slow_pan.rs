//! Lines under temporal anti-aliasing while the camera moves by a tenth of a pixel a frame.

use crate::{
    memory::{SIZE, outline, scene},
    outlines::removed,
    prelude::*,
};

/// The width of the line along the upper side of the wall, and its middle, in every column.
fn columns(small: &Small) -> Vec<[f64; 2]> {
    let ink = removed(small);
    (40..70)
        .map(|x| {
            let column = || (15..60).map(|y| (y, f64::from(ink[y * SIZE + x])));
            let sum: f64 = column().map(|(_, ink)| ink).sum();
            let moment: f64 = column().map(|(y, ink)| (y as f64 + 0.5) * ink).sum();
            [sum, moment / sum]
        })
        .collect()
}

/// The standard deviation of values from the straight line of least squares through them.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count;
    let (mut cross, mut square) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        cross += (i as f64 - middle) * (value - mean);
        square += (i as f64 - middle).powi(2);
    }
    let off = |(i, value): (usize, &f64)| value - mean - (i as f64 - middle) * cross / square;
    let squares: f64 = values.iter().enumerate().map(|v| off(v).powi(2)).sum();
    (squares / count).sqrt()
}

/// Along a line, its width and its place vary no more with a memory than without one: the memory
/// reads the last frame between its pixels.
#[test]
fn a_slow_pan_keeps_lines_even() {
    let (mut small, _) = scene();
    let [without, with] = [0.0, 0.875].map(|history_weight| {
        small.insert(Transform::IDENTITY);
        outline(&mut small, history_weight);
        let mut sums = [0.0; 2];
        for frame in 1..=48 {
            small.insert(Transform::from_xyz(0.1 * frame as f32, 0.0, 0.0));
            small.headless.step(1);
            // Four rounds of the engine's offsets.
            if frame > 16 {
                let found = columns(&small);
                for (i, sum) in sums.iter_mut().enumerate() {
                    let values: Vec<f64> = found.iter().map(|column| column[i]).collect();
                    *sum += deviation(&values) / 32.0;
                }
            }
        }
        println!(
            "history weight {history_weight}: width {:.4} px, place {:.4} px",
            sums[0], sums[1]
        );
        sums
    });
    for (without, with) in without.iter().zip(with) {
        assert!(with <= *without, "{with}, {without}");
    }
    assert_eq!(small.errors(), 0);
}
