//! Reference of `toon/ramp_map.wgsl`: tones are areas of texels, without sums.

use super::{Rgb, mix};

/// The mean of a row of tones between two fractions of it: what each texel covers of the interval.
/// The first and the last texel go on beyond the ends.
pub fn row_mean(row: &[Rgb], low: f64, high: f64) -> Rgb {
    let count = row.len() as f64;
    if high <= low {
        let texel = (low * count).floor().clamp(0.0, count - 1.0);
        return row[texel as usize];
    }
    let mut sum = [0.0; 3];
    for (k, color) in row.iter().enumerate() {
        let from = match k {
            0 => f64::NEG_INFINITY,
            _ => k as f64 / count,
        };
        let to = match k + 1 == row.len() {
            true => f64::INFINITY,
            false => (k + 1) as f64 / count,
        };
        let covered = (to.min(high) - from.max(low)).max(0.0) / (high - low);
        sum = std::array::from_fn(|c| sum[c] + covered * color[c]);
    }
    sum
}

/// The mean at a detail from 0, the last row, to 1, the first one.
pub fn mean(rows: &[Vec<Rgb>], detail: f64, low: f64, high: f64) -> Rgb {
    let place = (1.0 - detail).clamp(0.0, 1.0) * (rows.len() - 1) as f64;
    let above = place.floor() as usize;
    let below = (above + 1).min(rows.len() - 1);
    let [a, b] = [above, below].map(|row| row_mean(&rows[row], low, high));
    std::array::from_fn(|c| mix(a[c], b[c], place - place.floor()))
}

/// The tone where `arriving` of the light arrives, over a pixel in which it changes by `width`.
pub fn tone(rows: &[Vec<Rgb>], detail: f64, arriving: f64, width: f64) -> Rgb {
    mean(rows, detail, arriving - 0.5 * width, arriving + 0.5 * width)
}

/// The same where the darker part of the pixel, `1 - lit` of it, is in the shadow of something
/// else.
pub fn shadowed(rows: &[Vec<Rgb>], detail: f64, arriving: f64, width: f64, lit: f64) -> Rgb {
    let high = arriving + 0.5 * width;
    let bright = mean(rows, detail, high - lit * width, high);
    let shade = mean(rows, detail, 0.0, 0.0);
    std::array::from_fn(|c| mix(shade[c], bright[c], lit))
}
