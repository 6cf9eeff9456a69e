//! Reference of `lines/link/gaps.wgsl` and `lines/link/close_gaps.wgsl`: gaps in lines that are closed.

use std::collections::{HashMap, HashSet};

use super::{crack::Crack, link::Place};

/// The crack that is `n` cracks further along the run of a crack.
fn along(([x, y], side): Place, n: i64) -> Place {
    match side {
        0 => ([x, y + n], side),
        _ => ([x + n, y], side),
    }
}

/// The cracks that are missing in gaps of at most `longest` cracks between two cracks of lines
/// in a row.
pub fn gaps(lines: &HashSet<Place>, longest: u32) -> HashSet<Place> {
    let behind = |place: &Place| {
        let ends = (1..=i64::from(longest) + 1).map(|n| along(*place, n));
        let length = ends.take_while(|end| !lines.contains(end)).count() as i64;
        let gap = (1..=length).map(|n| along(*place, n));
        let closed = length <= i64::from(longest);
        gap.filter(move |_| closed).collect::<Vec<Place>>()
    };
    lines.iter().flat_map(behind).collect()
}

/// The crack that one in a gap is like: the nearest found one of its run, at most three cracks
/// away; of two, the one before it.
pub fn source(found: &HashMap<Place, Crack>, place: Place) -> Place {
    let steps = [0, -1, 1, -2, 2, -3, 3].map(|n| along(place, n));
    let nearest = steps.into_iter().find(|other| found.contains_key(other));
    nearest.unwrap_or(place)
}
