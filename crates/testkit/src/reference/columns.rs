//! Reference of `lines/draw/columns.wgsl`: the best two cracks of each pixel's column.

use super::{
    crack::{Crack, SIDES},
    draw::{Cracks, Line, distance, ink_of, is_apart, middle},
    edge::line_coverage,
};

/// A crack and the middle of its line.
type Found = (Crack, [f64; 2]);

impl Cracks {
    /// The lines that are found from the best cracks of each column.
    pub(super) fn lines_by_columns(&self, at: [f64; 2], nudge: f64) -> Vec<Line> {
        let (px, py) = (at[0].floor() as i64, at[1].floor() as i64);
        let columns = px - self.reach - 1..=px + self.reach;
        columns
            .flat_map(|x| self.column(x, py, nudge))
            .flatten()
            .map(|(crack, middle)| {
                // As it is stored, in 512ths of a pixel.
                let middle = middle.map(|m| (512.0 * m).round() / 512.0);
                let border = distance(middle, at) - crack.half_width;
                (border, middle, crack)
            })
            .collect()
    }

    /// The crack in a pixel's column whose line covers the pixel most, and of the others
    /// the one whose line reaches farthest over the pixel's row.
    fn column(&self, x: i64, y: i64, nudge: f64) -> [Option<Found>; 2] {
        // (score, reach, crack)
        let mut first: Option<(f64, f64, Found)> = None;
        let mut second: Option<(f64, Found)> = None;
        for row in y - self.reach - 1..=y + self.reach {
            for (crack, v) in self.at(x, row).into_iter().zip(SIDES) {
                let Some(crack) = crack else { continue };
                let middle = middle(&crack, [x, row], v);
                let away = (middle[1] - (y as f64 + 0.5)).abs();
                let ink = ink_of(&crack, nudge, line_coverage(away, crack.half_width));
                let value = [0, 1, 2]
                    .map(|kind| ink[kind] * self.opacity[kind])
                    .into_iter()
                    .fold(0.0, f64::max);
                let score = value + 1e-4 * (crack.half_width - away);
                let reach = (crack.half_width + 0.5).powi(2) - away.powi(2);
                let Some(best) = first else {
                    first = Some((score, reach, (crack, middle)));
                    continue;
                };
                let other = is_apart(middle, best.2.1);
                let farther = |reach: f64| second.is_none_or(|second| reach > second.0 + 1e-3);
                if score > best.0 + 1e-6 {
                    if other && farther(best.1) {
                        second = Some((best.1, best.2));
                    }
                    first = Some((score, reach, (crack, middle)));
                } else if other && farther(reach) {
                    second = Some((reach, (crack, middle)));
                }
            }
        }
        [first.map(|first| first.2), second.map(|second| second.1)]
    }
}
