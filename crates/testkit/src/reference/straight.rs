//! Reference of a part of `lines/draw/draw.wgsl`: lines run straight between the middles of
//! neighboring cracks.

use super::{
    coverage::segment_coverage,
    draw::{Line, distance, ink_of, is_apart},
    sheet::Spot,
};

/// The two nearest lines in different places, as the shader keeps them while it goes
/// through all lines: of lines in nearly the same place, it only keeps the nearest.
fn followed(lines: &[Line]) -> Option<(Line, Option<Line>)> {
    let mut first: Option<Line> = None;
    let mut second: Option<Line> = None;
    for line in lines {
        let Some(nearest) = first else {
            first = Some(*line);
            continue;
        };
        let other = is_apart(line.1, nearest.1);
        if line.0 < nearest.0 {
            second = if other { first } else { second };
            first = Some(*line);
        } else if other && second.is_none_or(|second| line.0 < second.0) {
            second = Some(*line);
        }
    }
    Some((first?, second))
}

/// The ink of the straight line from the middle of a line to another middle, or of a dot if that is
/// far away, and what a dry brush leaves of all ink there.
fn between(
    (_, from, crack): &Line,
    to: Option<[f64; 2]>,
    (at, on): ([f64; 2], &Spot),
    nudge: f64,
) -> ([f64; 3], f64) {
    let next = to.filter(|to| distance(*from, *to) < 1.45);
    let to = next.unwrap_or(*from);
    let half_width = on.half_width(crack.half_width);
    let covered = segment_coverage(at, *from, to, half_width);
    let along = [to[0] - from[0], to[1] - from[1]];
    let left = next.map_or(1.0, |_| on.dry_ink(along, crack.half_width));
    (ink_of(crack, nudge, covered), left)
}

/// The ink of the straight line between the middles of the two lines whose borders are
/// nearest, and what a dry brush leaves, for every choice of these two.
pub(super) fn straight(
    lines: &mut [Line],
    (at, on): ([f64; 2], &Spot),
    nudge: f64,
) -> Vec<([f64; 3], f64)> {
    // Middles are stored in 512ths of a pixel: each of two distances is off by up to
    // sqrt(2) / 1024.
    const TIE: f64 = 3e-3;
    let mut found: Vec<_> = followed(lines)
        .map(|(first, second)| between(&first, second.map(|line| line.1), (at, on), nudge))
        .into_iter()
        .collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (border, a, crack) in lines.iter() {
        if *border > lines[0].0 + TIE {
            break;
        }
        // Both cracks at a corner of a line of odd width have their middle in one pixel.
        let others: Vec<&Line> = lines.iter().filter(|other| is_apart(other.1, *a)).collect();
        if others.is_empty() {
            found.push(between(&(*border, *a, *crack), None, (at, on), nudge));
        }
        for (border, b, _) in &others {
            if *border > others[0].0 + TIE {
                break;
            }
            found.push(between(&(*border, *a, *crack), Some(*b), (at, on), nudge));
        }
    }
    found
}
