//! Reference of `effect/screen.wgsl`: coverages of screens. `at`: cells; `cell_size`: pixels.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use bevy_comics::effects::ScreenShape;

use super::{mix, smoothstep};

/// Dots below this tone become paler, not smaller.
pub const LEAST: f64 = 1.0 / 32.0;

fn to_nearest(x: f64) -> f64 {
    x - x.round()
}

/// Discs, from the areas of circles: an edge with a ramp of one pixel has the area of the
/// circle of radius sqrt(r^2 + 1/12), and a cone if the ramps from all sides meet.
fn disc_radius(tone: f64, cell_size: f64) -> f64 {
    if tone <= FRAC_PI_4 {
        let square = tone * cell_size.powi(2) / PI;
        return if square >= 1.0 / 3.0 {
            (square - 1.0 / 12.0).sqrt()
        } else {
            (3.0 * square).cbrt() - 0.5
        };
    }
    let rest = (1.0 - tone) / (1.0 - FRAC_PI_4);
    let root = rest.sqrt();
    cell_size * (0.5f64.sqrt() - root * (0.2471 - 0.04 * root)) - 0.09 * rest / cell_size.powi(2)
}

pub fn disc(at: [f64; 2], tone: f64, cell_size: f64) -> f64 {
    let radius = disc_radius(tone, cell_size);
    let [x, y] = at.map(|v| to_nearest(v).abs());
    let covers = [(x, y), (1.0 - x, y), (x, 1.0 - y), (1.0 - x, 1.0 - y)]
        .map(|(x, y)| (radius - cell_size * x.hypot(y) + 0.5).clamp(0.0, 1.0));
    let largest = covers.into_iter().fold(0.0, f64::max);
    let sum = covers.into_iter().sum::<f64>().min(1.0);
    mix(sum, largest, 0.31 * smoothstep(0.77, 0.8, tone))
}

/// The disc of the pixel's own cell.
fn own_disc(at: [f64; 2], tone: f64, cell_size: f64) -> f64 {
    let [x, y] = at.map(to_nearest);
    (disc_radius(tone, cell_size) - cell_size * x.hypot(y) + 0.5).clamp(0.0, 1.0)
}

fn checker([u, v]: [f64; 2], tone: f64, cell_size: f64) -> f64 {
    let height = 0.5 * ((TAU * u).cos() + (TAU * v).cos());
    let curved = ((0.5 - tone) / 0.11).clamp(-1.0, 1.0);
    let x = 1.0 - 2.0 * (tone - curved * PI / 12.0 / cell_size.powi(2));
    let threshold = x * (0.4 + 0.65 * x.abs() - 0.05 * x * x);
    let gradient = PI / cell_size * (TAU * u).sin().hypot((TAU * v).sin()).max(0.5);
    ((height - threshold) / gradient + 0.5).clamp(0.0, 1.0)
}

pub fn euclidean(at: [f64; 2], tone: f64, cell_size: f64) -> f64 {
    let middle = checker(at, tone, cell_size);
    if tone <= 0.5 {
        let weight = ((tone - 0.15) / 0.15).clamp(0.0, 1.0);
        mix(own_disc(at, tone, cell_size), middle, weight)
    } else {
        let weight = ((0.85 - tone) / 0.15).clamp(0.0, 1.0);
        let hole = own_disc(at.map(|v| v + 0.5), 1.0 - tone, cell_size);
        mix(1.0 - hole, middle, weight)
    }
}

/// The part of an interval that lines around whole numbers cover.
pub fn line(x: f64, tone: f64, footprint: f64) -> f64 {
    let (low, high) = (x - 0.5 * footprint, x + 0.5 * footprint);
    let lines = (low - 1.0).floor() as i64..=(high + 1.0).ceil() as i64;
    let covered: f64 = lines
        .map(|line| {
            let middle = line as f64;
            let from = low.max(middle - 0.5 * tone);
            (high.min(middle + 0.5 * tone) - from).max(0.0)
        })
        .sum();
    covered / footprint
}

/// The area that the diamond |x| + |y| < r shares with a rectangle: between places where a side
/// of either begins or ends, the height of what they share is linear.
fn shared_area(r: f64, x: [f64; 2], y: [f64; 2]) -> f64 {
    let height = |at: f64| (y[1].min(r - at.abs()) - y[0].max(at.abs() - r)).max(0.0);
    let [low, high] = y.map(|y| r - y.abs());
    let ends = [x[0], x[1], 0.0, r, -r, low, -low, high, -high];
    let mut ends = ends.map(|end| end.clamp(x[0], x[1]));
    ends.sort_by(f64::total_cmp);
    let parts = ends.windows(2);
    parts
        .map(|part| 0.5 * (part[1] - part[0]) * (height(part[0]) + height(part[1])))
        .sum()
}

/// Diamonds around whole numbers: what a square of the size of a pixel, along the cell, shares
/// with them. Tones beyond a half leave diamonds of paper between them.
pub fn diamond(at: [f64; 2], tone: f64, cell_size: f64) -> f64 {
    if tone > 0.5 {
        return 1.0 - diamond(at.map(|v| v + 0.5), 1.0 - tone, cell_size);
    }
    let side = 1.0 / cell_size;
    let radius = (0.5 * tone).sqrt();
    let first = at.map(f64::floor);
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let shared = corners.map(|corner| {
        let [x, y] = [0, 1].map(|i| {
            let to = at[i] - first[i] - corner[i];
            [to - 0.5 * side, to + 0.5 * side]
        });
        shared_area(radius, x, y)
    });
    shared.iter().sum::<f64>() / side.powi(2)
}

pub fn cross_lines([u, v]: [f64; 2], tone: f64, footprint: f64) -> f64 {
    let each = 1.0 - (1.0 - tone).sqrt();
    1.0 - (1.0 - line(u, each, footprint)) * (1.0 - line(v, each, footprint))
}

pub fn grain(tone: f64, threshold: f64) -> f64 {
    ((tone - threshold) * 96.0 + 0.5).clamp(0.0, 1.0)
}

pub fn gained(tone: f64, gain: f64) -> f64 {
    (tone + 4.0 * gain * tone * (1.0 - tone)).clamp(0.0, 1.0)
}

pub fn tinted(tone: f64, tints: u32) -> f64 {
    if tints == 0 {
        return tone;
    }
    let x = tone * f64::from(tints);
    (x.floor() + smoothstep(0.45, 0.55, x.fract())) / f64::from(tints)
}

/// Length of the edges of ink of a shape in a cell, in cell sizes.
pub fn edges(shape: ScreenShape, tone: f64) -> f64 {
    let part = tone.min(1.0 - tone);
    match shape {
        // Circles; beyond the tone at which they touch, what is left of them.
        ScreenShape::Round => (4.0 * PI * tone).sqrt().min(5.5 * (1.0 - tone).sqrt()),
        ScreenShape::Euclidean => (4.0 * PI * part).sqrt(),
        ScreenShape::Line => 2.0,
        // Four sides of a square of this area.
        ScreenShape::Diamond => 4.0 * part.sqrt(),
        // Two lines, each with both edges where the other is not.
        ScreenShape::Cross => 4.0 * (1.0 - tone).sqrt(),
        // Two sides of each square, where it differs from the next one.
        _ => 3.0 * 2.0 * 2.0 * tone * (1.0 - tone),
    }
}
