//! Straight edges of all slopes, the cracks that pixels make of them, and how far from them lines
//! may be.

use std::collections::HashSet;

use crate::reference::link::Place;

/// Root mean squares of the distance of lines from straight edges in pixels that are aimed at: for
/// slopes, rows per column.
pub const AIMED: [(f64, f64); 7] = [
    (0.04, 0.009),
    (0.1, 0.025),
    (0.2, 0.053),
    (0.3, 0.061),
    (0.5, 0.127),
    (0.7, 0.103),
    (0.9, 0.168),
];

/// The root mean square of a distance that is anywhere within a range, as often here as there.
pub fn uniform(range: f64) -> f64 {
    range / 12f64.sqrt()
}

/// 64 slopes from 1/64 to 1, the simple fractions among them.
pub fn slopes() -> impl Iterator<Item = f64> {
    (1..=64).map(|n| f64::from(n) / 64.0)
}

/// 16 offsets of an edge in pixels, 0 to 1, which are spread evenly modulo any fraction of a pixel.
pub fn offsets() -> [f64; 16] {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    std::array::from_fn(|n| (0.13 + n as f64 * golden).fract())
}

/// The largest root mean square of the distance from an edge that is accepted: a tenth above what
/// is aimed at. Between the slopes for which that is stated, it is interpolated, but an edge of a
/// slope of at most 1/2 is not known better than by one run of cracks: these are the same while the
/// edge moves by `slope` pixels. At slope 1, they are the same while it moves by sqrt(1/2).
pub fn accepted(slope: f64) -> f64 {
    let run = if slope <= 0.5 { uniform(slope) } else { 0.0 };
    let last = (1.0, uniform(0.5f64.sqrt()));
    let mut before = (0.0, 0.0);
    for next in AIMED.into_iter().chain([last]) {
        if slope <= next.0 {
            let part = (slope - before.0) / (next.0 - before.0);
            return 1.1 * run.max(before.1 + part * (next.1 - before.1));
        }
        before = next;
    }
    1.1 * last.1
}

/// The cracks along the edge `y = start + slope * x`, from column -80 to 280. A pixel is above the
/// edge if its center is.
pub fn cracks(slope: f64, start: f64) -> HashSet<Place> {
    let above = |x: i64, y: i64| y as f64 + 0.5 < start + slope * (x as f64 + 0.5);
    let mut cracks = HashSet::new();
    for x in -80..280 {
        let row = (start + slope * x as f64).floor() as i64;
        for y in row - 3..row + 4 {
            if above(x, y) != above(x + 1, y) {
                cracks.insert(([x, y], 0));
            }
            if above(x, y) != above(x, y + 1) {
                cracks.insert(([x, y], 1));
            }
        }
    }
    cracks
}

/// The distance of a place from the edge.
pub fn distance(slope: f64, start: f64, [x, y]: [f64; 2]) -> f64 {
    (start + slope * x - y) / slope.hypot(1.0)
}
