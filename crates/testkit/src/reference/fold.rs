//! Reference of `lines/link/fold.wgsl`: where the two sides of a crease meet.

use std::collections::HashSet;

use super::{crack::SIDES, link::Place, view::View};

/// Offset and slope of the line along a crease from its crack. `across`: raw depths of the
/// four pixels in a row across the crack; `beside`: for the first and the last of them,
/// those before and after it along the crack. `jump`: the difference of depths that
/// separates two surfaces; `otherwise`: the bend by the run of cracks.
pub fn fold_bend(
    across: [f64; 4],
    beside: [[f64; 2]; 2],
    jump: f64,
    otherwise: [f64; 2],
) -> Option<[f64; 2]> {
    let [d0, d1, d2, d3] = across;
    let apart = |[a, b]: [f64; 2], pixels: f64| (a - b).abs() >= jump * pixels;
    if apart([d0, d1], 1.0) || apart([d2, d3], 1.0) || beside.iter().any(|b| apart(*b, 2.0)) {
        return None;
    }
    let bend = (d1 - d0) - (d3 - d2);
    if bend.abs() <= 3.8e-6 * d1.max(d2) {
        return None;
    }
    let [here, there] = beside.map(|[before, after]| 0.5 * (after - before));
    let offset = (d2 - (d3 - d2) - d1) / bend - 0.5;
    let slope = (there - here) / bend;
    let unlike = (offset - otherwise[0]).hypot(slope - otherwise[1]);
    let near = offset.abs() <= 0.6 && unlike <= 0.35;
    near.then(|| [offset.clamp(-0.49, 0.49), slope.clamp(-1.0, 1.0)])
}

/// The same for a crack of a view. `jump`: the fraction of a jump's reference. `None` also if
/// another line runs through the pixels that are read, if one runs along the crack at most
/// three pixels away, or if the pixels are not all in the viewport.
pub fn placed(
    (view, jump): (&View, f64),
    lines: &HashSet<Place>,
    (pixel, side): Place,
    otherwise: [f64; 2],
) -> Option<[f64; 2]> {
    let across = SIDES[side];
    let along = SIDES[1 - side];
    let at = |i: i64, j: i64| [0, 1].map(|k| pixel[k] + i * across[k] + j * along[k]);
    let [x0, y0, width, height] = view.viewport.map(i64::from);
    let inside = |[x, y]: [i64; 2]| (0..width).contains(&x) && (0..height).contains(&y);
    let parallel = [-3, -2, -1, 1, 2, 3]
        .iter()
        .any(|i| lines.contains(&(at(*i, 0), side)));
    let crossing = [-1, 2]
        .iter()
        .any(|i| (-1..=0).any(|j| lines.contains(&(at(*i, j), 1 - side))));
    if parallel || crossing || !inside(at(-1, -1)) || !inside(at(2, 1)) {
        return None;
    }
    let depth = |i: i64, j: i64| {
        let [x, y] = at(i, j);
        view.depth((x0 + x) as u32, (y0 + y) as u32, 0)
    };
    let across = [-1, 0, 1, 2].map(|i| depth(i, 0));
    let beside = [-1, 2].map(|i| [depth(i, -1), depth(i, 1)]);
    let reference = view.jump_reference(across[1].max(across[2]));
    fold_bend(across, beside, jump * reference, otherwise)
}
