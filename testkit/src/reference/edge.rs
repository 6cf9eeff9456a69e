//! Twin of `lines/edge.wgsl`: responses and line geometry.

use super::Rgb;

/// Weights of \[CL\] Eq. 1, row by row.
pub const WEIGHTS: [[f64; 3]; 3] = [[1.0, 2.0, 1.0], [2.0, 0.0, 2.0], [1.0, 2.0, 1.0]];

/// Eq. 1 at the centre of a 3 x 3 window, for any measure of difference.
pub fn gradient<T: Copy>(window: [[T; 3]; 3], difference: impl Fn(T, T) -> f64) -> f64 {
    let x = window[1][1];
    (0..3)
        .flat_map(|r| (0..3).map(move |c| (r, c)))
        .map(|(r, c)| WEIGHTS[r][c] * difference(window[r][c], x))
        .sum::<f64>()
        / 8.0
}

/// (`g_min`, `g_max`) of the nine gradients in a 5 x 5 window.
pub fn gradient_extremes<T: Copy>(
    window: &[[T; 5]; 5],
    difference: impl Fn(T, T) -> f64 + Copy,
) -> [f64; 2] {
    let mut found = [f64::INFINITY, 0.0];
    for r in 1..4 {
        for c in 1..4 {
            let around =
                std::array::from_fn(|i| std::array::from_fn(|j| window[r + i - 1][c + j - 1]));
            let g = gradient(around, difference);
            found = [f64::min(found[0], g), f64::max(found[1], g)];
        }
    }
    found
}

/// Eq. 2: the response, 0 to 1. `g`: (`g_min`, `g_max`); `k`: detection threshold.
pub fn edge_response(g: [f64; 2], k: f64) -> f64 {
    ((g[1] - g[0]) / k).powi(2).min(1.0)
}

/// A unit normal; `None` where a pixel has none.
pub type Normal = Option<Rgb>;

/// Distance between two unit normals, 2 sin(angle / 2); 0 if either is missing.
pub fn normal_step(a: Normal, b: Normal) -> f64 {
    match (a, b) {
        (Some(a), Some(b)) => (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt(),
        _ => 0.0,
    }
}

/// Eq. 1 and 2 on each component of the normals: the largest response.
pub fn component_response(window: &[[Normal; 5]; 5], k: f64) -> f64 {
    (0..3)
        .map(|i| {
            let g = gradient_extremes(window, |a: Normal, b: Normal| match (a, b) {
                (Some(a), Some(b)) => (a[i] - b[i]).abs(),
                _ => 0.0,
            });
            edge_response(g, k)
        })
        .fold(0.0, f64::max)
}

/// How much the step down from `here` to `there` exceeds the slopes on both sides
/// of it, in raw depth: positive at an edge, 0 or less on a plane. `before` lies
/// behind `here`, `beyond` behind `there`.
pub fn step_excess(before: f64, here: f64, there: f64, beyond: f64) -> f64 {
    (here - there) - (before - here).max(there - beyond).max(0.0)
}

/// Fraction of a pixel that a line covers, across the line: the overlap of the
/// intervals [distance - 1/2, distance + 1/2] and [-half width, half width], pixels.
pub fn line_coverage(distance: f64, half_width: f64) -> f64 {
    let (low, high) = (
        (distance - 0.5).max(-half_width),
        (distance + 0.5).min(half_width),
    );
    (high - low).max(0.0)
}

/// Distance in pixels from the centre of the pixel that owns a line to the middle
/// of the line: 1/2 for even widths, 0 for odd ones and below 1, linear in between.
pub fn line_offset(half_width: f64) -> f64 {
    let width = 2.0 * half_width;
    if width < 1.0 {
        return 0.0;
    }
    let to_even = (width.rem_euclid(2.0)).min(2.0 - width.rem_euclid(2.0));
    0.5 - 0.5 * to_even
}
