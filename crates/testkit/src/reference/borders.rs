//! Reference of `depth/borders.wgsl`: the search by trying all pairs, and a view's borders over
//! time.

use super::histogram::{BINS, Bins};

/// Borders that explain this many times the variance take the place of those that are there.
const GAIN: f64 = 1.05;
/// Octaves of distance, or fraction of the visible range, at which a border is at its goal.
const SETTLED: f64 = 0.00025;

/// What is divided: counts of depths in bins.
#[derive(Clone, Debug)]
pub struct Counted<'a> {
    pub bins: Bins,
    pub counts: &'a [u32],
    /// What makes raw depth proportional to the reciprocal distance, in perspective.
    pub offset: f64,
}

impl Counted<'_> {
    /// Where a raw depth is compared: at the logarithm of the reciprocal distance, or in a
    /// fraction of the window.
    pub fn place(&self, d: f64) -> f64 {
        match self.bins {
            Bins::Octaves => (d + self.offset).log2(),
            Bins::Window([near, far]) => (d - far) / (near - far),
        }
    }

    fn depth_at(&self, place: f64) -> f64 {
        match self.bins {
            Bins::Octaves => place.exp2() - self.offset,
            Bins::Window([near, far]) => far + place * (near - far),
        }
    }

    fn middle(&self, bin: usize) -> f64 {
        let edges = [bin, bin + 1].map(|bin| self.place(self.bins.edge(bin)));
        0.5 * (edges[0] + edges[1])
    }

    /// How much of the variance the bins of a class are, by the first of them and the one behind
    /// them.
    fn parts(&self) -> impl Fn(usize, usize) -> f64 {
        // Sums before each bin, so that a pair takes no loop.
        let mut before = vec![[0.0, 0.0]];
        for bin in 0..BINS {
            let count = f64::from(self.counts[bin]);
            let [n, s] = before[bin];
            before.push([n + count, s + count * self.middle(bin)]);
        }
        let [total, sum] = before[BINS];
        move |first, end| {
            let [n, s] = [0, 1].map(|i| before[end][i] - before[first][i]);
            if n > 0.0 {
                n / total * (s / n - sum / total).powi(2)
            } else {
                0.0
            }
        }
    }

    /// The variance between the three classes of the bins before `middle`, before `near`, and
    /// the rest.
    pub fn explained(&self, middle: usize, near: usize) -> f64 {
        let part = self.parts();
        part(0, middle) + part(middle, near) + part(near, BINS)
    }

    /// The pair (first bin of the middle, first bin of near) that explains most, and how much, by
    /// trying all; `None` if all depths are in one bin.
    pub fn search(&self) -> Option<([usize; 2], f64)> {
        let mut best = None;
        let mut most = 0.0;
        let part = self.parts();
        for middle in 1..BINS {
            for near in middle + 1..BINS {
                let all = part(0, middle) + part(middle, near) + part(near, BINS);
                // Pairs that differ in empty bins are one.
                if all > most * (1.0 + 1e-12) {
                    most = all;
                    best = Some([middle, near]);
                }
            }
        }
        best.map(|pair| (pair, most))
    }

    /// The raw depth in the middle of the empty bins around the edge before a bin.
    pub fn gap(&self, bin: usize) -> f64 {
        let used = |bin: &usize| self.counts[*bin] > 0;
        let first = (0..bin).rev().find(used).map_or(0, |bin| bin + 1);
        let last = (bin..BINS).find(used).unwrap_or(BINS);
        let places = [first, last].map(|bin| self.place(self.bins.edge(bin)));
        self.depth_at(0.5 * (places[0] + places[1]))
    }

    /// Number of bins whose middle is farther than a raw depth.
    pub fn bins_before(&self, d: f64) -> usize {
        (0..BINS)
            .take_while(|bin| self.middle(*bin) < self.place(d))
            .count()
    }
}

/// The borders of a view over time.
#[derive(Clone, Debug, Default)]
pub struct Borders {
    /// Raw depths between near and middle, and between middle and far.
    goals: Option<[f64; 2]>,
    /// What the drawn levels are beyond those of the goals.
    rests: [f64; 2],
}

impl Borders {
    /// The borders in the next frame. `fraction`: of the way to the goals that is gone in a frame;
    /// `snaps`: the past is forgotten; `holds`: the goals stay.
    pub fn next(
        &mut self,
        counted: &Counted,
        fraction: f64,
        [snaps, holds]: [bool; 2],
    ) -> Option<[f64; 2]> {
        if snaps && !holds {
            *self = Self::default();
        }
        let level = |d: f64| match counted.bins {
            Bins::Octaves => (d + counted.offset).log2(),
            Bins::Window(_) => d,
        };
        if let Some((pair, most)) = counted.search().filter(|_| !holds || self.goals.is_none()) {
            let known = self.goals.map(|[near, far]| {
                counted.explained(counted.bins_before(far), counted.bins_before(near))
            });
            if known.is_none_or(|known| most > GAIN * known) {
                let goals = [pair[1], pair[0]].map(|bin| counted.gap(bin));
                if let Some(old) = self.goals {
                    for i in 0..2 {
                        self.rests[i] += level(old[i]) - level(goals[i]);
                    }
                }
                self.goals = Some(goals);
            }
        }
        let goals = self.goals?;
        let settled = match counted.bins {
            Bins::Octaves => SETTLED,
            Bins::Window([near, far]) => SETTLED * (near - far),
        };
        for rest in &mut self.rests {
            *rest *= 1.0 - fraction;
            if rest.abs() <= settled {
                *rest = 0.0;
            }
        }
        let drawn = |i: usize| match counted.bins {
            Bins::Octaves => (level(goals[i]) + self.rests[i]).exp2() - counted.offset,
            Bins::Window(_) => goals[i] + self.rests[i],
        };
        Some([drawn(0), drawn(1)])
    }
}
