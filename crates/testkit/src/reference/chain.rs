//! Reference of `lines/link/chain.wgsl`: lines are followed from crack to crack.

use std::{collections::HashSet, ops::RangeInclusive};

use super::{
    bend::diagonal_bend,
    link::{Place, at_corner, corners},
};

/// How a line goes on at a corner of one of its cracks.
enum Next {
    Crack(Place),
    End,
    Junction,
}

fn next(lines: &HashSet<Place>, place: Place, corner: [i64; 2]) -> Next {
    let others: Vec<Place> = at_corner(corner)
        .into_iter()
        .filter(|other| *other != place && lines.contains(other))
        .collect();
    match others[..] {
        [] => Next::End,
        [other] => Next::Crack(other),
        _ => Next::Junction,
    }
}

/// The corner of a crack that is not this one.
fn other_corner(place: Place, corner: [i64; 2]) -> [i64; 2] {
    let [first, last] = corners(place);
    if corner == first { last } else { first }
}

/// Up to `most` cracks that a line goes on in behind a corner of a crack, and whether it
/// ends behind them without meeting another line.
pub fn follow(
    lines: &HashSet<Place>,
    (mut place, mut corner): (Place, [i64; 2]),
    most: usize,
) -> (Vec<Place>, Option<[i64; 2]>) {
    let mut followed = vec![];
    while followed.len() < most {
        match next(lines, place, corner) {
            Next::Crack(other) => {
                followed.push(other);
                place = other;
                corner = other_corner(other, corner);
            }
            Next::End => return (followed, Some(corner)),
            Next::Junction => break,
        }
    }
    (followed, None)
}

/// Cracks from a crack to the loose ends of its line on both sides, at most `most`, rounded up.
/// A line does not end at the border of a grid of this size.
pub fn cracks_to_ends(
    lines: &HashSet<Place>,
    place: Place,
    size: [i64; 2],
    most: f64,
) -> [usize; 2] {
    let most = most.ceil() as usize;
    corners(place).map(|corner| {
        let (followed, end) = follow(lines, (place, corner), most);
        let loose = end.is_some_and(|end| (0..2).all(|i| end[i] > 0 && end[i] < size[i]));
        if loose { followed.len() } else { most }
    })
}

/// Number of cracks in the piece of line that a crack is in; `None` if the piece branches,
/// is closed or reaches the border of a grid of this size.
pub fn piece(lines: &HashSet<Place>, place: Place, size: [i64; 2]) -> Option<usize> {
    let mut cracks = 1;
    for corner in corners(place) {
        let (followed, end) = follow(lines, (place, corner), lines.len());
        end.filter(|end| (0..2).all(|i| end[i] > 0 && end[i] < size[i]))?;
        cracks += followed.len();
    }
    Some(cracks)
}

/// The center of a crack; whole numbers are corners of pixels.
fn center(place: Place) -> [f64; 2] {
    let [first, last] = corners(place);
    [0, 1].map(|i| (first[i] + last[i]) as f64 / 2.0)
}

/// Offset and slope from the mean of seven centers in a row and the direction from the first
/// to the last; `None` if there are no seven, or if they run across the crack.
pub fn mean_bend(lines: &HashSet<Place>, place: Place) -> Option<[f64; 2]> {
    let [back, on] = corners(place).map(|corner| follow(lines, (place, corner), 3).0);
    if back.len() < 3 || on.len() < 3 {
        return None;
    }
    let own = center(place);
    let [b, c] = [center(back[2]), center(on[2])];
    let (along, across) = if place.1 == 0 { (1, 0) } else { (0, 1) };
    let around = || back.iter().chain(&on).map(|place| center(*place));
    let away = |i: usize| around().map(|center| center[i] - own[i]).sum::<f64>() / 7.0;
    let [rise, run] = [across, along].map(|i| c[i] - b[i]);
    if rise.abs() >= 1.9 * run.abs() {
        return None;
    }
    let slope = rise / run;
    let offset = away(across) - slope * away(along);
    (offset.abs() <= 0.49).then_some([offset, slope])
}

/// Cracks of a diagonal run that is followed.
pub const DIAGONALS: RangeInclusive<usize> = 7..=31;

/// The cracks of a diagonal run from one of them in the direction `way` (1 or -1) of its corner,
/// itself included; from the last one's center to the corner where the next run begins, along and
/// across the first crack, if the line goes on in it; and whether the diagonal goes to the
/// south-east (1) or to the north-east (-1), if it is known.
fn stairs(
    lines: &HashSet<Place>,
    place: Place,
    corner: [i64; 2],
    way: i64,
) -> (usize, Option<[f64; 2]>, Option<i64>) {
    let (along, across) = if place.1 == 0 { (1, 0) } else { (0, 1) };
    let (followed, _) = follow(lines, (place, corner), *DIAGONALS.end());
    let (mut last, mut at, mut sense) = (place, corner, None);
    for (i, next) in followed.iter().enumerate() {
        let behind = other_corner(*next, at);
        let step = [along, across].map(|axis| way * (behind[axis] - at[axis]));
        let turns = next.1 != last.1;
        if turns && i == 0 {
            sense = Some(step[1]);
        }
        let onward = step[0] == 1 || sense == Some(step[1]);
        if !turns || !onward {
            // Both runs meet at the corner between the two cracks of a kind.
            let own = center(last);
            let to_corner = [along, across].map(|axis| at[axis] as f64 - own[axis]);
            return (i + 1, onward.then_some(to_corner), sense);
        }
        (last, at) = (*next, behind);
    }
    (followed.len() + 1, None, sense)
}

/// Offset and slope of a line in a diagonal run, if the next runs are on different sides of it.
pub fn stairs_bend(lines: &HashSet<Place>, place: Place) -> Option<[f64; 2]> {
    let [first, last] = corners(place);
    let (back, before, one) = stairs(lines, place, first, -1);
    let (on, after, other) = stairs(lines, place, last, 1);
    let sense = match (one, other) {
        (Some(one), Some(other)) if one != other => return None,
        _ => one.or(other)? as f64,
    };
    // On which side of the diagonal the next run begins.
    let side = |[along, across]: [f64; 2]| (across - sense * along).signum();
    let [before, after] = [side(before?), side(after?)];
    let follows = DIAGONALS.contains(&(back + on - 1)) && before != after;
    follows.then(|| diagonal_bend([back, on], sense, after))
}
