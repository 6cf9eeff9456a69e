//! The order of the grains of a tile by void and cluster (Ulichney 1993): grains are added where
//! the others leave the largest gap. It made `src/fused/pass/blue_noise.bin`.

use crate::screens::TILE;

/// Grains across and down the tile.
const SIDE: usize = 64;
const GRAINS: usize = SIDE * SIDE;
/// How far grains keep each other away: standard deviation of the Gaussian in grains, and
/// where it is cut off.
const SIGMA: f32 = 1.9;
const REACH: i32 = 9;

/// The rank of every grain in 256 classes, row by row.
fn classes() -> Vec<u8> {
    let class = |rank: usize| (rank / (GRAINS / 256)) as u8;
    ranks().into_iter().map(class).collect()
}

/// The pattern while it is made: which grains are set, and how close the set grains are to
/// every grain.
#[derive(Clone)]
struct Pattern {
    set: [bool; GRAINS],
    closeness: [f32; GRAINS],
}

impl Pattern {
    fn change(&mut self, at: usize, set: bool) {
        self.set[at] = set;
        let sign = if set { 1.0 } else { -1.0 };
        let (x, y) = ((at % SIDE) as i32, (at / SIDE) as i32);
        let wrapped = |v: i32| v.rem_euclid(SIDE as i32) as usize;
        for dy in -REACH..=REACH {
            for dx in -REACH..=REACH {
                let square = (dx * dx + dy * dy) as f32;
                let weight = (-square / (2.0 * SIGMA * SIGMA)).exp();
                self.closeness[wrapped(y + dy) * SIDE + wrapped(x + dx)] += sign * weight;
            }
        }
    }

    /// The set grain with the most others around it.
    fn tightest(&self) -> usize {
        let all = (0..GRAINS).filter(|i| self.set[*i]);
        all.max_by(|a, b| self.closeness[*a].total_cmp(&self.closeness[*b]))
            .unwrap_or(0)
    }

    /// The grain that is not set with the fewest set ones around it.
    fn largest_gap(&self) -> usize {
        let all = (0..GRAINS).filter(|i| !self.set[*i]);
        all.min_by(|a, b| self.closeness[*a].total_cmp(&self.closeness[*b]))
            .unwrap_or(0)
    }
}

/// A twentieth of the grains, spread evenly.
fn first_pattern() -> Pattern {
    let mut pattern = Pattern {
        set: [false; GRAINS],
        closeness: [0.0; GRAINS],
    };
    let mut state = 0x9e37_79b9_u32;
    let mut left = GRAINS / 20;
    while left > 0 {
        // xorshift32, Marsaglia 2003.
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        let at = state as usize % GRAINS;
        if !pattern.set[at] {
            pattern.change(at, true);
            left -= 1;
        }
    }
    // Grains move from clusters to gaps, until one would move back.
    for _ in 0..GRAINS {
        let from = pattern.tightest();
        pattern.change(from, false);
        let to = pattern.largest_gap();
        pattern.change(to, true);
        if from == to {
            break;
        }
    }
    pattern
}

/// For each grain how many are printed before it.
fn ranks() -> Vec<usize> {
    let first = first_pattern();
    let mut ranks = vec![0; GRAINS];
    let start = first.set.iter().filter(|set| **set).count();
    let mut fewer = first.clone();
    for rank in (0..start).rev() {
        let at = fewer.tightest();
        fewer.change(at, false);
        ranks[at] = rank;
    }
    let mut more = first;
    for rank in start..GRAINS {
        let at = more.largest_gap();
        more.change(at, true);
        ranks[at] = rank;
    }
    ranks
}

#[test]
fn the_tile_of_the_crate_has_this_order() {
    let mut sorted = ranks();
    sorted.sort_unstable();
    assert!(sorted.into_iter().eq(0..GRAINS));
    assert_eq!(classes(), TILE);
}

/// At every tone a, the grains of a square of n x n are nearly as many as the tone says:
/// they deviate by less than 0.4 of what random grains would, n sqrt(a (1 - a)). Squares
/// hold at least six grains or gaps: in smaller ones even a lattice deviates more (a
/// square lattice of 0.05 in squares of 8 x 8 by 0.6).
#[test]
fn grains_are_spread_evenly() {
    let ranks = ranks();
    for tone in [0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95] {
        let printed = |x: usize, y: usize| {
            let rank = ranks[(y % SIDE) * SIDE + x % SIDE];
            f64::from(u8::from((rank as f64) < tone * GRAINS as f64))
        };
        let side = if (0.1..=0.9).contains(&tone) { 8 } else { 12 };
        let area = (side * side) as f64;
        let squares = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
        let deviation = squares
            .map(|(x, y)| {
                let count: f64 = (0..side * side)
                    .map(|i| printed(x + i % side, y + i / side))
                    .sum();
                (count - area * tone).powi(2)
            })
            .sum::<f64>();
        let deviation = (deviation / GRAINS as f64).sqrt();
        let random = (area * tone * (1.0 - tone)).sqrt();
        assert!(deviation < 0.4 * random, "{tone}: {deviation}, {random}");
    }
}
