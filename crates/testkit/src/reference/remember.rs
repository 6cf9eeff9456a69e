//! Reference of `lines/memory/remember.wgsl`: ink that remembers the frames before.

use super::{
    Rgb,
    edge::is_in_front,
    memory::{
        cubic_weights, frames_at, is_limited, is_steady, missing_at, remembered, share_at,
        unsteady_at,
    },
};

/// A place in pixels.
pub type At = [i64; 2];

/// The pixel of a picture of this size that is nearest to a place.
pub fn inside(size: At, at: At) -> At {
    [0, 1].map(|k| at[k].clamp(0, size[k] - 1))
}

/// A square of pixels around one, `spacing` apart: as many of them to each side as `reach`.
pub fn square(centre: At, reach: i64, spacing: i64) -> impl Iterator<Item = At> {
    (-reach..=reach).flat_map(move |y| {
        (-reach..=reach).map(move |x| [centre[0] + spacing * x, centre[1] + spacing * y])
    })
}

/// Ink of the last frame at a place: bicubic between the centres of pixels.
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
    /// Frames in the memory, frames with missing lines, and how unsteady the surface is.
    pub counts: [f64; 3],
    /// Whether the last frame shows that place.
    pub seen: bool,
    /// Pixels that it moves by.
    pub speed: f64,
    /// The fraction of this frame where lines move; 1: there is no memory.
    pub share: f64,
}

/// What has happened to a surface since the last frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Changes {
    /// Something else has come before it.
    pub covered: bool,
    /// What was before it has gone.
    pub uncovered: bool,
    /// What was around it has gone.
    pub vanished: bool,
}

/// What is remembered of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Memory {
    pub ink: Rgb,
    /// Frames, frames with missing lines, and how unsteady the surface is.
    pub counts: [f64; 3],
    pub changes: Changes,
    /// Whether the memory was limited to the ink nearby.
    pub limited: bool,
}

/// By how much the ink of the last frame may be beyond the ink nearby.
pub const ROUNDING: f64 = 0.01;

impl Pixel {
    /// `jump`: the difference that separates two surfaces at a raw depth.
    fn changes(&self, jump: impl Fn(f64) -> f64) -> Changes {
        let before = |near: f64, far: f64| is_in_front(near, far, jump(near));
        Changes {
            covered: before(self.nearest, self.past_wide),
            uncovered: before(self.past_nearest, self.wide),
            vanished: before(self.past_wide, self.wide),
        }
    }

    /// Whether the ink of the last frame is not between the least and the most nearby.
    fn is_missing(&self) -> bool {
        (0..3).any(|k| {
            self.past[k] < self.least[k] - ROUNDING || self.past[k] > self.most[k] + ROUNDING
        })
    }

    /// The ink with its memory.
    pub fn remembered(&self, jump: impl Fn(f64) -> f64) -> Memory {
        let exists = self.seen && self.share < 1.0;
        let [frames, missing, unsteady] = if exists { self.counts } else { [0.0; 3] };
        let changes = self.changes(jump);
        let changed = changes.covered || changes.uncovered || changes.vanished;
        let unsteady = unsteady_at(unsteady, changed, self.speed);
        let steady = is_steady(unsteady);
        // What is behind something that has gone was not seen before.
        let [frames, missing] = if changes.uncovered && steady {
            [0.0; 2]
        } else {
            [frames, missing]
        };
        let frames = frames_at(frames, self.share, self.speed);
        let missing = missing_at(missing, self.is_missing());
        let is_sky = self.wide <= 0.0;
        let ends = changes.covered || changes.vanished || is_sky;
        let limited = is_limited(missing, self.speed) || (steady && ends);
        let ink = std::array::from_fn(|k| {
            let nearby = if limited {
                [self.least[k], self.most[k]]
            } else {
                [0.0, 1.0]
            };
            let share = share_at(frames, self.speed);
            remembered(self.past[k], self.now[k], nearby, share)
        });
        Memory {
            ink,
            counts: [frames, if limited { 0.0 } else { missing }, unsteady],
            changes,
            limited,
        }
    }
}
