//! Reference of `lines/cracks/edge.wgsl`: responses and line geometry.

use super::Rgb;

/// Weights of \[CL\] Eq. 1, row by row.
pub const WEIGHTS: [[f64; 3]; 3] = [[1.0, 2.0, 1.0], [2.0, 0.0, 2.0], [1.0, 2.0, 1.0]];

/// Eq. 1 at the center of a 3 x 3 window, for any measure of difference.
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

/// How much the step between the third and the fourth of six raw depths in a row
/// exceeds the slopes on both sides of it. Positive at an edge, 0 or less on a plane.
/// A slope counts only if it persists over two pixels.
pub fn step_excess(d: [f64; 6]) -> f64 {
    let step = d[2] - d[3];
    let down = if step >= 0.0 { 1.0 } else { -1.0 };
    let slope = |a: f64, b: f64, c: f64| (down * (a - b)).min(down * (b - c));
    step.abs()
        - slope(d[0], d[1], d[2])
            .max(slope(d[3], d[4], d[5]))
            .max(0.0)
}

/// How six raw depths in a row depart from a plane in their middle, beyond four times what they bend
/// beside it: the step in the middle, the largest one on its two sides or over it and one of them, and
/// the change of the slope.
pub fn departures(d: [f64; 6]) -> [f64; 3] {
    let bends = [0, 1, 2, 3].map(|i| d[i] - 2.0 * d[i + 1] + d[i + 2]);
    let step = |[i, j]: [usize; 2], others: [usize; 2]| {
        let [a, b] = [bends[i], bends[j]];
        let opposite = (a > 0.0) != (b > 0.0);
        let size = if opposite { a.abs().min(b.abs()) } else { 0.0 };
        let [c, d] = others.map(|i| bends[i].abs());
        size - 4.0 * c.min(d)
    };
    let outer = bends[0].abs().min(bends[3].abs());
    let beside = step([0, 1], [2, 3]).max(step([2, 3], [0, 1]));
    let wide = step([0, 2], [3, 3]).max(step([1, 3], [0, 0]));
    let turn = (bends[1] + bends[2]).abs() - 4.0 * outer;
    [step([1, 2], [0, 3]), beside.max(wide), turn]
}

/// Whether the step between the third and the fourth of six raw depths is part of a curve
/// that ends in a larger step beside it: the one on its other side is at least a tenth of it.
pub fn is_outdone(d: [f64; 6]) -> bool {
    let step = d[2] - d[3];
    let down = if step >= 0.0 { 1.0 } else { -1.0 };
    let [near, far] = [d[1] - d[2], d[3] - d[4]].map(|beside| down * beside);
    near.max(far) > step.abs() && near.min(far) >= 0.1 * step.abs()
}

/// Response to an excess, 0 to 1: half of it is the `g_max - g_min` of Eq. 2.
pub fn step_response(excess: f64, k: f64) -> f64 {
    (0.5 * excess.max(0.0) / k.max(1e-30)).powi(2).min(1.0)
}

/// Whether the excess of a step is that of a ledge: at least a twentieth of the jump that separates
/// two surfaces, but less than it.
pub fn is_ledge(excess: f64, jump: f64) -> bool {
    excess > 0.05 * jump && excess < jump
}

/// Squared distance of two unit normals; `None` if one is missing.
pub fn fold(a: Normal, b: Normal) -> Option<f64> {
    let (a, b) = (a?, b?);
    Some((0..3).map(|i| (a[i] - b[i]).powi(2)).sum())
}

/// Response to a fold, 0 to 1: half of the distance is the sine of half of the angle.
pub fn fold_response(fold: Option<f64>, k: f64) -> f64 {
    (0.25 * fold.unwrap_or(0.0) / (k * k)).min(1.0)
}

/// Whether the second of three folds in a row is the sharpest, and none is missing.
pub fn is_ridge(folds: [Option<f64>; 3]) -> bool {
    let [Some(before), Some(fold), Some(beyond)] = folds else {
        return false;
    };
    fold > 0.0 && fold >= before && fold >= beyond
}

/// Whether the second of three folds in a row is sharper than 60 degrees and than its one
/// neighbor, where the other is missing.
pub fn is_rim_ridge(folds: [Option<f64>; 3]) -> bool {
    match folds {
        [Some(other), Some(fold), None] | [None, Some(fold), Some(other)] => {
            fold >= 1.0 && fold >= other
        }
        _ => false,
    }
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

/// Distance in pixels from the middle of a line to the crack that it runs along: 0 for
/// even widths, 1/2 for odd ones and below 1, linear in between.
pub fn line_offset(half_width: f64) -> f64 {
    let width = 2.0 * half_width;
    if width < 1.0 {
        return 0.5;
    }
    0.5 * (width.rem_euclid(2.0)).min(2.0 - width.rem_euclid(2.0))
}
