//! Twin of `styles/contours/contours.wgsl`.

use super::{
    Rgb,
    map::{Frame, is_background},
    mix, smoothstep,
};
use bevy_comics::{ContourForm, ContourOperator, Contours};

/// Depths of 3 x 3 taps, row by row, and which sides lie outside the viewport.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    pub depths: [[f64; 3]; 3],
    /// West, east, north, south.
    pub missing: [bool; 4],
}

/// What every neighbour has over its reference, row by row, the middle zero.
type Steps = [[f64; 3]; 3];

/// The raw kernels, as matrices.
fn convolve(steps: &Steps, kernel: [[f64; 3]; 3]) -> f64 {
    (0..3)
        .flat_map(|r| (0..3).map(move |c| (r, c)))
        .map(|(r, c)| steps[r][c] * kernel[r][c])
        .sum()
}

const PREWITT: [[f64; 3]; 3] = [[-1.0, 0.0, 1.0]; 3];
const SOBEL: [[f64; 3]; 3] = [[-1.0, 0.0, 1.0], [-2.0, 0.0, 2.0], [-1.0, 0.0, 1.0]];

fn transposed(k: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| k[c][r]))
}

fn gradient(steps: &Steps, kernel: [[f64; 3]; 3]) -> f64 {
    convolve(steps, kernel).hypot(convolve(steps, transposed(kernel)))
}

/// The plane's continuation past the centre: the smaller of two slopes that
/// agree, none where they do not; where one side is sky, the other's.
fn slope(before: f64, c: f64, after: f64) -> f64 {
    let (back, ahead) = (c - before, after - c);
    match (is_background(before), is_background(after)) {
        _ if is_background(c) => 0.0,
        (true, true) => 0.0,
        (true, false) => ahead,
        (false, true) => back,
        (false, false) if (back > 0.0) != (ahead > 0.0) => 0.0,
        (false, false) => {
            if back.abs() < ahead.abs() {
                back
            } else {
                ahead
            }
        }
    }
}

fn plane_steps(frame: &Frame, win: &Window) -> Steps {
    let [near, far] = frame.ends.expect("geometry");
    let d = &win.depths;
    let c = d[1][1];
    let mut steps = [[0.0; 3]; 3];
    for (row, column) in [(0usize, 0usize), (0, 1), (0, 2), (1, 0)] {
        let needs_across = column != 1;
        let needs_along = row != 1;
        if needs_across && (win.missing[0] || win.missing[1])
            || needs_along && (win.missing[2] || win.missing[3])
        {
            continue;
        }
        let (r2, c2) = (2 - row, 2 - column);
        let (before, after) = (d[row][column], d[r2][c2]);
        let s = slope(before, c, after);
        let over = |d: f64, p: f64| {
            let p = if is_background(c) {
                0.0
            } else {
                p.clamp(far, near)
            };
            frame.with_sky(d) - frame.with_sky(p)
        };
        steps[row][column] = over(before, c - s);
        steps[r2][c2] = over(after, c + s);
    }
    steps
}

pub fn response(s: &Contours, frame: &Frame, win: &Window) -> f64 {
    if frame.ends.is_none() {
        return 0.0;
    }
    let faithful = s.form == ContourForm::Faithful;
    let steps = if faithful {
        let c = frame.with_sky(win.depths[1][1]);
        win.depths.map(|row| row.map(|d| frame.with_sky(d) - c))
    } else {
        plane_steps(frame, win)
    };
    let unit = |gain: f64| if faithful { 1.0 } else { gain };
    match s.operator {
        ContourOperator::Prewitt => gradient(&steps, PREWITT) / unit(3.0),
        ContourOperator::Sobel => gradient(&steps, SOBEL) / unit(4.0),
        ContourOperator::Laplace => steps.iter().flatten().sum::<f64>().abs() / unit(3.0),
        ContourOperator::Roberts if faithful => steps[2][2].hypot(steps[1][2] - steps[2][1]),
        ContourOperator::Roberts => {
            (steps[2][2] - steps[0][0]).hypot(steps[2][0] - steps[0][2]) / 2f64.sqrt()
        }
    }
}

pub fn line(s: &Contours, response: f64) -> f64 {
    let t = f64::from(s.threshold);
    let ramp = t * f64::from(s.softness).max(1e-3);
    smoothstep(t - ramp, t + ramp, response)
}

pub fn draw(s: &Contours, linear: Rgb, coverage: f64, depth: f64) -> Rgb {
    let ink = s.color.to_linear();
    let ink = [ink.red, ink.green, ink.blue].map(f64::from);
    let t = (coverage * f64::from(s.opacity) * (1.0 - f64::from(s.fade) * depth)).clamp(0.0, 1.0);
    std::array::from_fn(|i| mix(linear[i], ink[i], t))
}
