//! Reference of `lines/draw/ends.wgsl`, `lines/draw/overshoot.wgsl` and `lines/draw/strokes.wgsl`:
//! strokes that extend lines beyond their loose ends.

use std::collections::HashSet;

use bevy::math::{DMat3, DVec3};

use super::{
    chain::follow,
    coverage::segment_coverage,
    crack::{Crack, SIDES, THINNEST},
    draw::{ink_of, middle},
    link::{Place, corners},
    sheet::Spot,
    weight::taper_weight,
};

/// Cracks of a line that say in which direction it ends.
const DIRECTING: usize = 16;

/// A stroke: from the end of a line to its own end, and the crack at the end of the line.
pub struct Stroke {
    pub start: [f64; 2],
    pub tip: [f64; 2],
    pub crack: Crack,
}

/// The direction in which a line leaves the first of these middles, away from the others: that
/// of the derivative of the parabola through them, by the normal equations.
fn end_direction(middles: &[[f64; 2]]) -> [f64; 2] {
    let n = middles.len();
    if n < 3 {
        return [0, 1].map(|axis| middles[0][axis] - middles[n - 1][axis]);
    }
    // Sums of powers of the index, and of these times the middles.
    let powers = |i: usize| [0, 1, 2, 3, 4].map(|k| (i as f64).powi(k));
    let sum = |k: usize| (0..n).map(|i| powers(i)[k]).sum::<f64>();
    let sums = DMat3::from_cols_array_2d(&[0, 1, 2].map(|i| [0, 1, 2].map(|j| sum(i + j))));
    [0, 1].map(|axis| {
        let moment = |k: usize| (0..n).map(|i| powers(i)[k] * middles[i][axis]).sum::<f64>();
        let moments = DVec3::from_array([0, 1, 2].map(moment));
        -(sums.inverse() * moments).y
    })
}

/// Whether the middle half way to the last one is at most 0.7 pixels from their chord.
fn is_straight(middles: &[[f64; 2]]) -> bool {
    let last = middles.len() - 1;
    let from = |i: usize| [0, 1].map(|axis| middles[i][axis] - middles[0][axis]);
    let ([cx, cy], [hx, hy]) = (from(last), from(last / 2));
    (cx * hy - cy * hx).abs() <= 0.7 * cx.hypot(cy)
}

/// The strokes of a view. `lines`: all cracks of lines; `at`: what is left of a crack;
/// `longest`: in pixels.
pub fn strokes(
    lines: &HashSet<Place>,
    at: &dyn Fn(Place) -> Option<Crack>,
    size: [i64; 2],
    longest: f64,
) -> Vec<Stroke> {
    let place_of = |place: Place| {
        let (pixel, side) = place;
        at(place).map(|crack| middle(&crack, pixel, SIDES[side]))
    };
    let mut found = vec![];
    for place in lines {
        let Some(crack) = at(*place) else { continue };
        let [first, last] = corners(*place);
        for (corner, other) in [(first, last), (last, first)] {
            let inside = (0..2).all(|i| corner[i] > 0 && corner[i] < size[i]);
            let (none, end) = follow(lines, (*place, corner), 1);
            if !inside || !none.is_empty() || end.is_none() {
                continue;
            }
            let most = DIRECTING.max(longest.ceil() as usize);
            let (behind, _) = follow(lines, (*place, other), most - 1);
            let chain = std::iter::once(*place).chain(behind);
            let chain: Vec<[f64; 2]> = chain.map_while(place_of).collect();
            let mut directing = chain.len().min(3);
            while directing < chain.len().min(DIRECTING) && is_straight(&chain[..=directing]) {
                directing += 1;
            }
            let mut direction = end_direction(&chain[..directing]);
            if direction[0].hypot(direction[1]) < 1e-3 {
                direction = [0, 1].map(|i| (corner[i] - other[i]) as f64);
            }
            let length = longest.min(chain.len() as f64) / direction[0].hypot(direction[1]);
            let start = chain[0];
            found.push(Stroke {
                start,
                tip: [0, 1].map(|i| start[i] + length * direction[i]),
                crack,
            });
        }
    }
    found
}

impl Stroke {
    /// Ink by kind at a place, which has a place on the sheet. `taper`: in cracks.
    pub fn ink(&self, (at, on): ([f64; 2], &Spot), taper: f64, nudge: f64) -> [f64; 3] {
        let along = [0, 1].map(|i| self.tip[i] - self.start[i]);
        let length = along[0].hypot(along[1]);
        let from = [0, 1].map(|i| at[i] - self.start[i]);
        let away = (from[0] * along[0] + from[1] * along[1]) / length;
        let part = if taper > 0.0 {
            let left = length - away.clamp(0.0, length);
            (taper_weight(taper, left) / taper_weight(taper, length)).min(1.0)
        } else {
            1.0
        };
        let half_width = self.crack.half_width * part;
        let thinnest = self.crack.half_width.min(THINNEST);
        let thinner = Crack {
            half_width: half_width.max(thinnest),
            ..self.crack
        };
        let fainter = (half_width / thinnest.max(1e-3)).min(1.0);
        let left = fainter * on.dry_ink(along, thinner.half_width);
        let half_width = on.half_width(thinner.half_width);
        let covered = segment_coverage(at, self.start, self.tip, half_width);
        ink_of(&thinner, nudge, covered).map(|ink| ink * left)
    }
}
