//! Twin of `lines/columns.wgsl`: the best crack of each pixel's column.

use super::{
    crack::{Crack, SIDES},
    draw::{Cracks, Line, distance, ink_of, middle},
};

impl Cracks {
    /// The lines that are found from the best cracks of each column.
    pub(super) fn lines_by_columns(&self, at: [f64; 2], nudge: f64) -> Vec<Line> {
        let (px, py) = (at[0].floor() as i64, at[1].floor() as i64);
        let mut lines = Vec::new();
        for x in px - self.reach - 1..=px + self.reach {
            let Some((crack, first, next)) = self.column(x, py, nudge) else {
                continue;
            };
            let border = distance(first, at) - crack.half_width;
            lines.push((border, first, Some(crack)));
            if let Some(next) = next {
                let own = distance(next, at) - crack.half_width;
                lines.push((own.max(border + 1e-4), next, None));
            }
        }
        lines
    }

    /// The crack in a pixel's column whose line covers the pixel most, the middle of its
    /// line, and the middle of the next line.
    fn column(&self, x: i64, y: i64, nudge: f64) -> Option<(Crack, [f64; 2], Option<[f64; 2]>)> {
        let mut best: Option<(f64, Crack, [f64; 2])> = None;
        let mut next: Option<(f64, [f64; 2])> = None;
        for row in y - self.reach - 1..=y + self.reach {
            for (crack, v) in self.at(x, row).into_iter().zip(SIDES) {
                let Some(crack) = crack else { continue };
                let middle = middle(&crack, [x, row], v);
                let away = (middle[1] - (y as f64 + 0.5)).abs();
                let ink = ink_of(&crack, nudge, away);
                let value = [0, 1, 2]
                    .map(|kind| ink[kind] * self.opacity[kind])
                    .into_iter()
                    .fold(0.0, f64::max);
                let score = value + 1e-4 * (crack.half_width - away);
                if score <= -1.0 {
                    continue;
                }
                let other = best.is_none_or(|best| distance(middle, best.2) > 0.25);
                match best {
                    Some(first) if score <= first.0 => {
                        if other && next.is_none_or(|next| score > next.0) {
                            next = Some((score, middle));
                        }
                    }
                    _ => {
                        if let Some(first) = best
                            && other
                        {
                            next = Some((first.0, first.2));
                        }
                        best = Some((score, crack, middle));
                    }
                }
            }
        }
        // The place of the next line is stored in 64ths of a pixel.
        let stored = |v: f64| (v * 64.0).round_ties_even() / 64.0;
        best.map(|(_, crack, middle)| (crack, middle, next.map(|next| next.1.map(stored))))
    }
}
