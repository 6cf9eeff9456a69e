//! Where lines end.

use std::collections::HashSet;

use crate::read_back::CrackWords;

/// Ends of lines: corners of pixels at which a single crack that is part of a line ends. Not at
/// the border of the picture, and not where another line runs at most a pixel away, under whose
/// ink the end lies.
pub fn ends_of_lines(cracks: &CrackWords) -> Vec<[i64; 2]> {
    let [_, _, width, height] = cracks.rect.map(i64::from);
    let is_line = |side: usize, x: i64, y: i64| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside && { cracks.words[(y * width + x) as usize][side] & 7 != 0 }
    };
    // The cracks that end at the top left corner of a pixel: above, below, left, right.
    let at_corner = |x: i64, y: i64| {
        [
            (0, x - 1, y - 1),
            (0, x - 1, y),
            (1, x - 1, y - 1),
            (1, x, y - 1),
        ]
        .into_iter()
        .filter(|(side, x, y)| is_line(*side, *x, *y))
    };
    let corners_of = |(side, x, y): (usize, i64, i64)| {
        let first = if side == 0 { (x + 1, y) } else { (x, y + 1) };
        [first, (x + 1, y + 1)]
    };
    let is_end = |x: i64, y: i64| at_corner(x, y).count() == 1;
    let is_covered = |x: i64, y: i64| {
        // The corners of the end's own line, up to three cracks away.
        let mut own = HashSet::from([(x, y)]);
        for _ in 0..3 {
            let more = own.iter().flat_map(|(x, y)| at_corner(*x, *y));
            let more: Vec<_> = more.flat_map(corners_of).collect();
            own.extend(more);
        }
        let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| (x + i, y + j)));
        let mut others = around.filter(|corner| !own.contains(corner));
        others.any(|(x, y)| at_corner(x, y).next().is_some())
    };
    let corners = (1..height).flat_map(|y| (1..width).map(move |x| (x, y)));
    corners
        .filter(|(x, y)| is_end(*x, *y) && !is_covered(*x, *y))
        .map(|(x, y)| [x, y])
        .collect()
}

/// The number of ends of lines.
pub fn line_ends(cracks: &CrackWords) -> usize {
    ends_of_lines(cracks).len()
}

/// How many of these places have one of the others within a distance along both axes. Places of
/// a picture are multiplied by `fine` before: others are those of a picture that is as many times
/// as large.
pub fn at_places(places: &[[i64; 2]], fine: i64, others: &[[i64; 2]], distance: i64) -> usize {
    let has_other = |[x, y]: &&[i64; 2]| {
        others
            .iter()
            .any(|[u, v]| (fine * x - u).abs().max((fine * y - v).abs()) <= distance)
    };
    places.iter().filter(has_other).count()
}

#[cfg(test)]
mod tests {
    use super::{CrackWords, line_ends};

    /// A line across the picture has no ends, a loose one two, and a branch one more.
    #[test]
    fn ends_of_lines_are_counted() {
        let ends = |places: &[(usize, i64, i64)]| {
            let mut cracks = CrackWords {
                rect: [0, 0, 40, 36],
                words: vec![[0; 2]; 40 * 36],
                planes: vec![],
                bends: vec![],
            };
            for (side, x, y) in places {
                cracks.words[(y * 40 + x) as usize][*side] = 1;
            }
            line_ends(&cracks)
        };
        let across: Vec<_> = (0..40).map(|x| (1, x, 20)).collect();
        assert_eq!(ends(&across), 0);
        let down: Vec<_> = (10..34).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&down), 2);
        let branch: Vec<_> = (21..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across.clone(), branch].concat()), 1);
        // An end one pixel below the line is covered by it; two pixels below it is not.
        let near: Vec<_> = (22..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across.clone(), near].concat()), 1);
        let apart: Vec<_> = (23..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across, apart].concat()), 2);
    }
}
