//! Reference of `effects/contours/contours.wgsl`.

use super::{
    Rgba,
    map::{Frame, is_background},
    mix, over, smoothstep,
    view::{View, load_window},
    window::{Steps, Window, gradient, map_steps, prewitt},
};
use bevy_comics::{
    Contours,
    effects::{ContourOperator, Equations},
};

const SOBEL: [[f64; 3]; 3] = [[-1.0, 0.0, 1.0], [-2.0, 0.0, 2.0], [-1.0, 0.0, 1.0]];

/// Change of raw depth per tap of the plane through the center `c`: the smaller
/// absolute slope of both sides if their signs agree, else 0. If one side is sky,
/// the slope of the other side.
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
    if s.equations == Equations::Corrected {
        return scaled_response(s, &plane_steps(frame, win));
    }
    let steps = map_steps(frame, win);
    match s.operator {
        ContourOperator::Prewitt => prewitt(&steps),
        ContourOperator::Sobel => gradient(&steps, SOBEL),
        ContourOperator::Laplace => steps.iter().flatten().sum::<f64>().abs(),
        ContourOperator::Roberts => steps[2][2].hypot(steps[1][2] - steps[2][1]),
        other => panic!("no reference of {other:?}"),
    }
}

/// The response of the corrected equations to steps over a plane.
fn scaled_response(s: &Contours, steps: &Steps) -> f64 {
    match s.operator {
        ContourOperator::Prewitt => prewitt(steps) / 3.0,
        ContourOperator::Sobel => gradient(steps, SOBEL) / 4.0,
        ContourOperator::Laplace => steps.iter().flatten().sum::<f64>().abs() / 3.0,
        ContourOperator::Roberts => {
            (steps[2][2] - steps[0][0]).hypot(steps[2][0] - steps[0][2]) / 2f64.sqrt()
        }
        other => panic!("no reference of {other:?}"),
    }
}

/// Coverage by a line, 0 to 1, for a response.
pub fn line(s: &Contours, response: f64) -> f64 {
    let t = f64::from(s.threshold);
    let ramp = t * f64::from(s.softness).max(1e-3);
    smoothstep(t - ramp, t + ramp, response)
}

/// `depth`: D of the nearer side of the line.
pub fn draw(s: &Contours, picture: Rgba, coverage: f64, depth: f64) -> Rgba {
    let ink = s.color.to_linear();
    let ink = [ink.red, ink.green, ink.blue].map(f64::from);
    let t = (coverage * f64::from(s.opacity) * (1.0 - f64::from(s.opacity_fade) * depth))
        .clamp(0.0, 1.0);
    over(picture, ink, t)
}

/// (coverage, nearest raw depth) of one sample: taps `reach` pixels around the
/// pixel `at`, and on every second ring inside.
fn ring_line(s: &Contours, view: &View, at: [u32; 2], reach: u32, sample: u32) -> [f64; 2] {
    let mut found = [0.0f64; 2];
    let mut r = reach;
    while r > 0 {
        let win = load_window(view, at[0], at[1], r, sample);
        let covered = line(s, response(s, &view.frame, &win));
        let nearest = win.depths.iter().flatten().copied().fold(0.0, f64::max);
        found = [found[0].max(covered), found[1].max(nearest)];
        r = r.saturating_sub(2);
    }
    found
}

/// (coverage, D of the nearer side) of the contours at a pixel. `scale`: physical
/// pixels per logical pixel.
pub fn contour(s: &Contours, view: &View, x: u32, y: u32, scale: f64) -> [f64; 2] {
    let radius = (0.5 * f64::from(s.width) * scale).clamp(0.125, 64.0);
    let (whole, part) = (radius.floor() as u32, radius.fract());
    let found = if view.samples > 1 {
        let n = f64::from(view.samples);
        (0..view.samples).fold([0.0, 0.0f64], |found, i| {
            let wider = part * n > f64::from(i) + 0.5;
            let one = ring_line(s, view, [x, y], whole + u32::from(wider), i);
            [found[0] + one[0] / n, found[1].max(one[1])]
        })
    } else {
        let inner = ring_line(s, view, [x, y], whole, 0);
        if part > 0.0 {
            let outer = ring_line(s, view, [x, y], whole + 1, 0);
            [
                mix(inner[0], inner[0].max(outer[0]), part),
                inner[1].max(outer[1]),
            ]
        } else {
            inner
        }
    };
    [found[0], view.frame.depth_map(found[1])[0]]
}
