//! Reference of `effect/box_statistics.wgsl`: means over boxes of a picture.

use super::{Rgb, Rgba, color};

/// A picture of a viewport in linear light, multiplied by its opacity, row by row.
#[derive(Clone, Debug)]
pub struct Sheet {
    pub size: [usize; 2],
    pub pixels: Vec<Rgba>,
}

impl Sheet {
    pub fn new(size: [usize; 2], pixel: impl Fn([usize; 2]) -> Rgba) -> Self {
        let pixels = (0..size[0] * size[1]).map(|i| pixel([i % size[0], i / size[0]]));
        Self {
            size,
            pixels: pixels.collect(),
        }
    }

    pub fn at(&self, [x, y]: [usize; 2]) -> Rgba {
        self.pixels[y * self.size[0] + x]
    }

    /// The pixel at a place; outside of the sheet, its nearest one.
    pub fn nearest(&self, at: [i64; 2]) -> Rgba {
        let inside = |i: usize| at[i].clamp(0, self.size[i] as i64 - 1) as usize;
        self.at([inside(0), inside(1)])
    }

    pub fn contains(&self, at: [i64; 2]) -> bool {
        (0..2).all(|i| (0..self.size[i] as i64).contains(&at[i]))
    }

    /// Bilinear between the centers of pixels.
    pub fn between(&self, at: [f64; 2]) -> Rgba {
        let low = at.map(|v| (v - 0.5).floor());
        let [fx, fy] = [0, 1].map(|i| at[i] - 0.5 - low[i]);
        let mut sum = [0.0; 4];
        for (dx, dy, part) in [
            (0, 0, (1.0 - fx) * (1.0 - fy)),
            (1, 0, fx * (1.0 - fy)),
            (0, 1, (1.0 - fx) * fy),
            (1, 1, fx * fy),
        ] {
            let found = self.nearest([low[0] as i64 + dx, low[1] as i64 + dy]);
            for (sum, found) in sum.iter_mut().zip(found) {
                *sum += part * found;
            }
        }
        sum
    }
}

/// The mean over a box: of the square root of linear light, of the square of that color's
/// luminance, and the fraction of the box that shows something.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    pub color: Rgb,
    pub square: f64,
    pub coverage: f64,
    /// Half the side of the box.
    pub half: f64,
}

impl Means {
    /// Those of a pixel.
    pub fn of([r, g, b, alpha]: Rgba) -> Self {
        let coverage = alpha.clamp(0.0, 1.0);
        let color = [r, g, b].map(|c| root(c / coverage.max(1e-3)));
        Self {
            color,
            square: color::luminance(color).powi(2),
            coverage,
            half: 0.0,
        }
    }

    pub fn variance(&self) -> f64 {
        (self.square - color::luminance(self.color).powi(2)).max(0.0)
    }

    /// The mean of several with weights that add up to `side`.
    pub fn mean(parts: impl Iterator<Item = (f64, Self)>, side: f64) -> Self {
        let mut sum = Self::default();
        for (part, m) in parts {
            let weight = part * m.coverage;
            sum.color = std::array::from_fn(|i| sum.color[i] + weight * m.color[i]);
            sum.square += weight * m.square;
            sum.coverage += weight;
        }
        let weight = sum.coverage.max(1e-20);
        Self {
            color: sum.color.map(|c| c / weight),
            square: sum.square / weight,
            coverage: sum.coverage / side,
            half: 0.0,
        }
    }
}

pub fn root(c: f64) -> f64 {
    c.signum() * c.abs().sqrt()
}

pub fn square(c: f64) -> f64 {
    c * c.abs()
}

/// The fraction of a pixel that is in a box, `by` pixels from its middle.
pub fn part_of_box(half: f64, by: i64) -> f64 {
    (half + 1.0 - by.abs() as f64).clamp(0.0, 1.0)
}

/// The means around every pixel. `half`: half the side of the box around a pixel.
pub fn means(sheet: &Sheet, half: &dyn Fn([usize; 2]) -> f64) -> Vec<Means> {
    let [width, height] = sheet.size;
    let line = |at: [usize; 2], axis: usize, from: &dyn Fn([usize; 2]) -> Means| {
        let half = half(at).clamp(0.0, 128.0);
        let reach = half.ceil() as i64;
        let parts = (-reach..=reach).filter_map(|by| {
            let mut other = at.map(|v| v as i64);
            other[axis] += by;
            (sheet.contains(other))
                .then(|| (part_of_box(half, by), from(other.map(|v| v as usize))))
        });
        Means {
            half,
            ..Means::mean(parts, 2.0 * half + 1.0)
        }
    };
    let all = || (0..width * height).map(|i| [i % width, i / width]);
    let across: Vec<Means> = all()
        .map(|at| line(at, 0, &|at| Means::of(sheet.at(at))))
        .collect();
    all()
        .map(|at| line(at, 1, &|[x, y]| across[y * width + x]))
        .collect()
}
