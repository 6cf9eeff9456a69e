//! Reference of `lines/find/jumps.wgsl`: the bound below which the depth map does not depart from a
//! plane.

use super::{
    map::{Frame, Projection, is_background},
    walk::BELOW,
    window::Window,
};

/// How far the depth map may depart from a plane at distance `radius` of the middle of a
/// window of direct neighbours; infinite beside the sky.
pub fn departure(frame: &Frame, win: &Window, radius: f64) -> f64 {
    let d = &win.depths;
    let c = d[1][1];
    let all = || d.iter().flatten();
    let sky = all().filter(|d| is_background(**d)).count();
    if sky > 0 && sky < 9 {
        return f64::INFINITY;
    }
    let pairs = [(0, 0), (0, 1), (0, 2), (1, 0)];
    let bend = pairs
        .map(|(y, x)| (d[y][x] + d[2 - y][2 - x] - 2.0 * c).abs())
        .into_iter()
        .fold(0.0, f64::max);
    let slope = all().map(|d| (d - c).abs()).fold(0.0, f64::max);
    let [Some(near), Some(far)] = [frame.ends.map(|e| e[0]), frame.ends.map(|e| e[1])] else {
        return 0.0;
    };
    let jump = radius * radius * bend;
    let away = (2.0 * radius - 1.0) * slope + jump - bend;
    let step = |farther: f64, nearer: f64| {
        let at = |d: f64| frame.depth_map(d.clamp(far, near))[0];
        at(farther) - at(nearer)
    };
    let orthographic = matches!(frame.projection, Projection::Orthographic { .. });
    if orthographic && frame.logarithmic {
        let nearest = (c + away).clamp(far, near);
        step(nearest - jump, nearest)
    } else {
        let farthest = (c - away).clamp(far, near);
        step(farthest, farthest + jump)
    }
}

/// Whether the depth map may jump by `least`.
pub fn may_jump(departure: f64, least: f64) -> bool {
    departure >= least * BELOW
}
