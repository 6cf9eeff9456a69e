//! Reference of `lines/link/density.wgsl` and `budget.wgsl`: how much of the width of lines is left
//! where they crowd.

use std::{collections::HashSet, f64::consts::FRAC_1_SQRT_2};

use super::link::Place;

/// Columns and rows of the cells whose lines share their budget.
const CELL: [i64; 2] = [4, 8];
/// Pixels along the sides of squares, level by level.
const SQUARES: [i64; 7] = [8, 16, 32, 64, 128, 256, 512];

/// The length of lines per area in squares, level by level, each row by row; in 1 / pixels.
pub struct Densities {
    size: [i64; 2],
    levels: Vec<Vec<f64>>,
}

impl Densities {
    pub fn new(lines: &HashSet<Place>, size: [i64; 2]) -> Self {
        let mut sums = vec![0.0; Self::count(size, SQUARES[0])];
        let across = Self::squares(size, SQUARES[0])[0];
        let has = |x, y, side| lines.contains(&([x, y], side));
        for y in 0..size[1] {
            for x in 0..size[0] {
                let [east, south] = [has(x, y, 0), has(x, y, 1)];
                let cracks = f64::from(u8::from(east) + u8::from(south));
                // Two cracks of a diagonal have two corners.
                let corner = east != has(x, y + 1, 0) && south != has(x + 1, y, 1);
                let saved = if corner { 1.0 - FRAC_1_SQRT_2 } else { 0.0 };
                sums[(y / 8 * across + x / 8) as usize] += cracks - saved;
            }
        }
        let inside = |i: i64, size: i64| (size - 8 * i).min(8) as f64;
        let first = sums.into_iter().enumerate().map(|(i, sum)| {
            let [column, row] = [i as i64 % across, i as i64 / across];
            sum / (inside(column, size[0]) * inside(row, size[1]))
        });
        let mut levels: Vec<Vec<f64>> = vec![first.collect()];
        for level in 1..SQUARES.len() {
            // One pass begins with the smallest squares, another one with those of level 3. Beyond
            // the grid, the last ones of these count.
            let from = if level <= 3 { 0 } else { 3 };
            let [small, large] = [from, level].map(|at| Self::squares(size, SQUARES[at]));
            let steps = 1 << (level - from);
            let at = |x: i64, y: i64| {
                levels[from][(y.min(small[1] - 1) * small[0] + x.min(small[0] - 1)) as usize]
            };
            let inside = |x: i64, y: i64| {
                let places = (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j)));
                let sum: f64 = places.map(|(i, j)| at(steps * x + i, steps * y + j)).sum();
                sum / (steps * steps) as f64
            };
            let places = (0..large[1]).flat_map(|y| (0..large[0]).map(move |x| (x, y)));
            let means = places.map(|(x, y)| inside(x, y)).collect();
            levels.push(means);
        }
        Self { size, levels }
    }

    fn squares(size: [i64; 2], side: i64) -> [i64; 2] {
        size.map(|pixels| (pixels + side - 1) / side)
    }

    fn count(size: [i64; 2], side: i64) -> usize {
        Self::squares(size, side).iter().product::<i64>() as usize
    }

    /// The mean under a tent with a radius of two squares of a level.
    fn under(&self, level: usize, place: [f64; 2]) -> f64 {
        let side = SQUARES[level];
        let [across, down] = Self::squares(self.size, side);
        // Weights of squares in a row; beyond the grid, its last ones count.
        let weights = |at: f64, count: i64| {
            let at = at / side as f64 - 0.5;
            let near = at.floor() as i64;
            (near - 1..near + 3).map(move |i| {
                let weight = 0.5 - 0.25 * (i as f64 - at).abs();
                (weight, i.clamp(0, count - 1))
            })
        };
        let mut sum = 0.0;
        for (row_weight, y) in weights(place[1], down) {
            for (weight, x) in weights(place[0], across) {
                sum += row_weight * weight * self.levels[level][(y * across + x) as usize];
            }
        }
        sum
    }

    /// The density around the cell of a pixel, within a radius in pixels.
    pub fn around(&self, pixel: [i64; 2], radius: f64) -> f64 {
        let middle = |i: usize| {
            let first = pixel[i] - pixel[i].rem_euclid(CELL[i]);
            first as f64 + 0.5 * CELL[i] as f64
        };
        let place = [middle(0), middle(1)];
        let wide = |level: usize| 2.0 * SQUARES[level] as f64;
        let low = (0..5).filter(|level| wide(level + 1) <= radius).count();
        // A single line has the density 1 / radius under the tents of both levels together.
        let part = 2.0 * (1.0 - wide(low) / radius.max(wide(0)));
        let [near, far] = [low, low + 1].map(|level| self.under(level, place));
        near + part.min(1.0) * (far - near)
    }

    /// The factor of the width of a line at a pixel.
    pub fn budget_weight(&self, budget: f64, pixel: [i64; 2], width: f64) -> f64 {
        let covered = width * self.around(pixel, 2.0 * width / budget);
        if covered <= budget {
            1.0
        } else {
            budget / covered
        }
    }
}
