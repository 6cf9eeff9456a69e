//! Reference of `lines/history/accumulate.wgsl` and `lines/history/history.wgsl`: ink that is blended with that of the
//! frames before.

use super::{Rgb, edge::is_in_front};

/// A place in pixels.
pub type At = [i64; 2];

/// The pixel of a picture of this size that is nearest to a place.
pub fn inside(size: At, at: At) -> At {
    [0, 1].map(|k| at[k].clamp(0, size[k] - 1))
}

/// A square of pixels around one, `spacing` apart: as many of them to each side as `reach`.
pub fn square(center: At, reach: i64, spacing: i64) -> impl Iterator<Item = At> {
    (-reach..=reach).flat_map(move |y| {
        (-reach..=reach).map(move |x| [center[0] + spacing * x, center[1] + spacing * y])
    })
}

/// Weights of four texels at a fraction from the second one: the cubic polynomials whose values
/// and slopes at the inner two are those of Catmull and Rom (1974).
fn cubic_weights(f: f64) -> [f64; 4] {
    // Hermite's basis.
    let start = (1.0 - f).powi(2) * (1.0 + 2.0 * f);
    let end = f * f * (3.0 - 2.0 * f);
    let leaving = f * (1.0 - f).powi(2);
    let arriving = f * f * (f - 1.0);
    [
        -0.5 * leaving,
        start - 0.5 * arriving,
        end + 0.5 * leaving,
        0.5 * arriving,
    ]
}

/// Ink of the last frame at a place: bicubic between the centers of pixels.
pub fn past_at(place: [f64; 2], ink: impl Fn(At) -> Rgb) -> Rgb {
    let low = place.map(|p| (p - 0.5).floor());
    let [across, down] = [0, 1].map(|k| cubic_weights(place[k] - 0.5 - low[k]));
    let mut sum = [0.0; 3];
    for (at, weight) in (0..16).map(|k| ([k % 4, k / 4], across[k % 4] * down[k / 4])) {
        let texel = ink([0, 1].map(|k| low[k] as i64 + at[k] as i64 - 1));
        sum = std::array::from_fn(|k| sum[k] + weight * texel[k]);
    }
    sum
}

/// The nearest raw depth at four pixels of the last frame: diagonally from a pixel, at the distance
/// of `spacing` pixels of the grid, of which there are `scale` per pixel.
pub fn past_nearest(pixel: At, spacing: i64, scale: [f64; 2], depth: impl Fn(At) -> f64) -> f64 {
    let far = scale.map(|scale| ((spacing as f64 / scale).round() as i64).max(1));
    let corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]];
    (corners.into_iter())
        .map(|corner| depth([0, 1].map(|k| pixel[k] + far[k] * corner[k])))
        .fold(0.0, f64::max)
}

/// What is known of a pixel in this frame, and of the place that it shows in the last one.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Ink of three kinds; the least and the most nearby.
    pub now: Rgb,
    pub least: Rgb,
    pub most: Rgb,
    /// Ink of the last frame at that place.
    pub past: Rgb,
    /// The nearest raw depth of 3 x 3 pixels, and of 5 x 5.
    pub nearest: f64,
    pub wide: f64,
    /// Those of the last frame at that place.
    pub past_nearest: f64,
    pub past_wide: f64,
    /// Frames in the history, frames with missing lines, and how unsteady the surface is.
    pub counts: [f64; 3],
    /// Whether the last frame shows that place.
    pub seen: bool,
    /// Pixels that it moves by.
    pub speed: f64,
    /// The fraction of this frame where lines move; 1: there is no history.
    pub blend_factor: f64,
}

/// What is kept of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulated {
    pub ink: Rgb,
    /// Frames, frames with missing lines, and how unsteady the surface is.
    pub counts: [f64; 3],
    /// Whether something else has come before the surface, what was before it has gone, and what
    /// was around it has gone.
    pub covered: bool,
    pub uncovered: bool,
    pub vanished: bool,
    /// Whether the history was limited to the ink nearby.
    pub limited: bool,
}

/// By how much the ink of the last frame may be beyond the ink nearby.
pub const ROUNDING: f64 = 0.01;

impl Pixel {
    /// Whether the ink of the last frame is not between the least and the most nearby.
    fn is_missing(&self) -> bool {
        (0..3).any(|k| {
            self.past[k] < self.least[k] - ROUNDING || self.past[k] > self.most[k] + ROUNDING
        })
    }

    /// The ink with its history. `jump`: the difference that separates two surfaces at a raw depth.
    pub fn accumulated(&self, jump: impl Fn(f64) -> f64) -> Accumulated {
        let before = |near: f64, far: f64| is_in_front(near, far, jump(near));
        let covered = before(self.nearest, self.past_wide);
        let uncovered = before(self.past_nearest, self.wide);
        let vanished = before(self.past_wide, self.wide);
        let exists = self.seen && self.blend_factor < 1.0;
        let [frames, missing, unsteady] = if exists { self.counts } else { [0.0; 3] };
        let moves = self.speed > 0.05;
        let unsteady = if moves {
            0.0
        } else if covered || uncovered || vanished {
            (unsteady + 16.0).min(48.0)
        } else {
            (unsteady - 1.0).max(0.0)
        };
        let steady = unsteady <= 32.0;
        // What is behind something that has gone was not seen before.
        let [frames, missing] = if uncovered && steady {
            [0.0; 2]
        } else {
            [frames, missing]
        };
        let frames = f64::min(
            frames + 1.0,
            if moves {
                1.0 / self.blend_factor
            } else {
                128.0
            },
        );
        let missing = if self.is_missing() {
            missing + 1.0
        } else {
            0.0
        };
        let ends = covered || vanished || self.wide <= 0.0;
        // In motion, or after two rounds of eight offsets.
        let limited = missing > 16.0 || moves || (steady && ends);
        let blend_factor = (1.0 / frames.max(1.0) + self.speed / 4.0).min(1.0);
        let ink = std::array::from_fn(|k| {
            let kept = if limited {
                self.past[k].max(self.least[k]).min(self.most[k])
            } else {
                self.past[k].clamp(0.0, 1.0)
            };
            kept * (1.0 - blend_factor) + self.now[k] * blend_factor
        });
        Accumulated {
            ink,
            counts: [frames, if limited { 0.0 } else { missing }, unsteady],
            covered,
            uncovered,
            vanished,
            limited,
        }
    }
}
