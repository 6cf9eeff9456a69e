//! When flashes began, to limit how many there are in a second.

use std::collections::VecDeque;

use bevy::{camera::NormalizedRenderTarget, ecs::resource::Resource};

/// The flashes of a camera in the last second, in real time. Those that are announced may begin
/// later: while a pipeline is compiled or the game is paused, the picture does not change.
#[derive(Debug, Default)]
pub(super) struct Flashes {
    /// When each began; for one that has not begun, the last time that was known. The oldest is
    /// first, those of the last impact are last.
    times: VecDeque<f64>,
    /// Flashes of the last impact, and how many of them had begun in the frame before.
    announced: usize,
    begun: usize,
}

impl Flashes {
    /// Number of flashes that began in the second before `now`, or have not begun.
    pub fn recent(&self, now: f64) -> usize {
        self.times.iter().filter(|then| now - **then < 1.0).count()
    }

    /// Adds the flashes of an impact. Those of the impact before stay, even if they had not begun
    /// and never will.
    pub fn announce(&mut self, flashes: usize, now: f64) {
        while self.times.front().is_some_and(|then| now - then >= 1.0) {
            self.times.pop_front();
        }
        self.times.extend(std::iter::repeat_n(now, flashes));
        self.announced = flashes;
        self.begun = 0;
    }

    /// Notes that a frame shows as many flashes of the last impact. Those that had not begun in
    /// the frame before may have begun in this one.
    pub fn show(&mut self, begun: usize, now: f64) {
        let waiting = self.announced - self.begun.min(begun).min(self.announced);
        for time in self.times.iter_mut().rev().take(waiting) {
            *time = now;
        }
        self.begun = begun;
    }
}

/// Flashes whose camera is gone or has another render target by now. Their targets showed them, so
/// they count there.
#[derive(Resource, Debug, Default)]
pub(super) struct PastFlashes(Vec<(Option<NormalizedRenderTarget>, f64)>);

impl PastFlashes {
    /// Keeps the flashes that a camera had on a target.
    pub fn keep(&mut self, target: Option<&NormalizedRenderTarget>, flashes: &Flashes) {
        let times = flashes.times.iter();
        self.0.extend(times.map(|time| (target.cloned(), *time)));
    }

    /// Number of those on a target in the second before `now`. Forgets older ones.
    pub fn recent(&mut self, target: Option<&NormalizedRenderTarget>, now: f64) -> usize {
        self.0.retain(|(_, time)| now - time < 1.0);
        let on_target = self.0.iter().filter(|(at, _)| at.as_ref() == target);
        on_target.count()
    }
}
