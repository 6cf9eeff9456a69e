//! Reference of `lines/link/link.wgsl`, `lines/link/join.wgsl` and `lines/link/settle.wgsl`: the
//! cracks that are parts of lines, and how these run. A graph of cracks and of the corners of
//! pixels that they end at.

use std::collections::{HashMap, HashSet};

use super::{
    bend::{LONGEST, end_sign, line_bend, stored},
    chain,
    crack::Crack,
};

/// A crack: the pixel that has it, and the side, an entry of
/// [`SIDES`](super::crack::SIDES).
pub type Place = ([i64; 2], usize);

/// The corners of pixels that a crack ends at: the corner (x, y) is that at the top left of
/// the pixel (x, y).
pub(super) fn corners(([x, y], side): Place) -> [[i64; 2]; 2] {
    let end = [x + 1, y + 1];
    match side {
        0 => [[x + 1, y], end],
        _ => [[x, y + 1], end],
    }
}

/// The cracks that end at a corner.
pub(super) fn at_corner([x, y]: [i64; 2]) -> [Place; 4] {
    [
        ([x - 1, y - 1], 0),
        ([x - 1, y], 0),
        ([x - 1, y - 1], 1),
        ([x, y - 1], 1),
    ]
}

/// The cracks that share a corner with one.
fn neighbors(place: Place) -> impl Iterator<Item = Place> {
    corners(place)
        .into_iter()
        .flat_map(at_corner)
        .filter(move |other| *other != place)
}

/// Steps along which lines grow from both sides to join.
const JOINED: usize = 6;

/// With the ledges on paths of at most `2 * JOINED` ledges from one line to another: lines grow
/// along ledges, and what has a loose end is taken away again.
pub fn joined(lines: &HashSet<Place>, cracks: &HashMap<Place, Crack>) -> HashSet<Place> {
    let is_ledge = |place: &Place| cracks.get(place).is_some_and(|c| c.ledge);
    let mut all = lines.clone();
    let mut border = all.clone();
    for _ in 0..JOINED {
        border = border
            .into_iter()
            .flat_map(neighbors)
            .filter(|place| is_ledge(place) && !all.contains(place))
            .collect();
        all.extend(&border);
    }
    for _ in 0..JOINED {
        let before = all.clone();
        let goes_on = |place: Place| {
            corners(place).into_iter().all(|corner| {
                let mut others = at_corner(corner).into_iter();
                others.any(|other| other != place && before.contains(&other))
            })
        };
        all.retain(|place| lines.contains(place) || goes_on(*place));
    }
    all
}

/// The cracks that are parts of lines, without ledges: those that are certain, and those that a
/// path of at most `steps` cracks connects with one.
pub fn linked(cracks: &HashMap<Place, Crack>, steps: i32) -> HashSet<Place> {
    let certain = cracks.iter().filter(|(_, crack)| crack.certain);
    let mut all: HashSet<Place> = certain.map(|(place, _)| *place).collect();
    let mut border = all.clone();
    for _ in 0..steps {
        border = border
            .into_iter()
            .flat_map(neighbors)
            .filter(|place| {
                let weak = cracks.get(place).is_some_and(|c| !c.ledge);
                weak && !all.contains(place)
            })
            .collect();
        all.extend(&border);
    }
    all
}

/// The cracks that are in pieces of at least `min_length` cracks, in pieces that branch or are
/// closed, or in pieces that reach the border of a grid of this size.
pub fn without_short_pieces(
    linked: &HashSet<Place>,
    size: [i64; 2],
    min_length: u32,
) -> HashSet<Place> {
    let kept = linked.iter().filter(|place| {
        let piece = chain::piece(linked, **place, size);
        piece.is_none_or(|cracks| cracks >= min_length as usize)
    });
    kept.copied().collect()
}

/// Offset and slope of the line along a crack, as they are stored.
pub fn bend(linked: &HashSet<Place>, ([x, y], side): Place) -> [f64; 2] {
    // Along and across the run.
    let along = [[0, 1], [1, 0]][side];
    let at = |n: i64| ([x + n * along[0], y + n * along[1]], side);
    let seen = |step: i64| {
        let run = (0..LONGEST as i64).take_while(|n| linked.contains(&at(n * step)));
        run.count()
    };
    let seen = [seen(-1), seen(1)];
    let single = seen == [1, 1];
    // The cracks across the run at the corner behind the n-th crack from this one.
    let sides = |n: i64| {
        let ([px, py], _) = at(n);
        [-1, 0, 1, 2].map(|across| {
            let place = match side {
                0 => [px + across, py],
                _ => [px, py + across],
            };
            linked.contains(&(place, 1 - side))
        })
    };
    let ends = [-(seen[0] as i64), seen[1] as i64 - 1];
    let run = line_bend(seen, ends.map(|n| end_sign(sides(n), single)));
    let short = seen[0] + seen[1] <= 3;
    let stairs = || chain::stairs_bend(linked, at(0)).or_else(|| chain::mean_bend(linked, at(0)));
    stored(short.then(stairs).flatten().unwrap_or(run))
}
