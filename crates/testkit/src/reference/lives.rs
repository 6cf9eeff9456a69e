//! Reference of `lines/memory/lives.wgsl` and `lines/memory/persist.wgsl`: lines that stay where their edges have
//! become weak. Without motion vectors.

use std::collections::{HashMap, HashSet};

use super::{
    crack::{Crack, SIDES},
    link::Place,
};

/// For each found crack the frames that a line may stay there from now on.
#[derive(Default)]
pub struct Lives(HashMap<Place, u32>);

impl Lives {
    /// The lines of the next frame. `all`: the cracks that are found; `grown`: those of lines
    /// without a memory; `longest`: frames that lines stay.
    pub fn next(
        &mut self,
        all: &HashMap<Place, Crack>,
        grown: &HashSet<Place>,
        longest: u32,
    ) -> HashSet<Place> {
        let mut lines = grown.clone();
        let mut lives = HashMap::new();
        for place in all.keys() {
            let ([x, y], side) = *place;
            let [dx, dy] = SIDES[side];
            let around = [-1, 0, 1].map(|n| ([x + n * dx, y + n * dy], side));
            // Those beside it count if they have gone.
            let gone = |other: &&Place| **other == *place || !all.contains_key(*other);
            let around = around.iter().filter(gone);
            let past = around.filter_map(|place| self.0.get(place)).max();
            let past = past.copied().unwrap_or(0);
            if grown.contains(place) {
                lives.insert(*place, longest);
            } else if past > 0 {
                lines.insert(*place);
                lives.insert(*place, past - 1);
            }
        }
        self.0 = lives;
        lines
    }
}
