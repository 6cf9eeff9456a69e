//! Reference of `lines/link/rim.wgsl`: where the rim of a surface is a single silhouette.

use std::collections::{HashMap, HashSet};

use super::{
    chain::follow,
    crack::{Crack, SIDES},
    link::{Place, corners},
    view::View,
};

/// Cracks within which silhouettes follow on both sides.
const RIM: usize = 16;

/// Whether a crack of these lines is part of a silhouette: others follow on both sides, and the
/// step is as large as that of a silhouette, a fraction `jump` of the reference. `source`: the
/// crack whose depths count; `found`: all cracks.
pub fn is_rim(
    (found, lines): (&HashMap<Place, Crack>, &HashSet<Place>),
    place: Place,
    (view, jump): (&View, f64),
    ([x, y], side): Place,
) -> bool {
    let [x0, y0, ..] = view.viewport.map(i64::from);
    let [dx, dy] = SIDES[side];
    let depth = |x: i64, y: i64| view.depth((x0 + x) as u32, (y0 + y) as u32, 0);
    let [here, there] = [depth(x, y), depth(x + dx, y + dy)];
    let is_silhouette = |place: &Place| found.get(place).is_some_and(|crack| crack.kinds[0]);
    let leads = |corner| {
        let (followed, _) = follow(lines, (place, corner), RIM);
        followed.iter().any(is_silhouette)
    };
    (here - there).abs() > jump * view.jump_reference(here.max(there))
        && corners(place).into_iter().all(leads)
}
