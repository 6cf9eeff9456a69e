//! Where an object was in the last moments.

use std::collections::VecDeque;

use bevy::{math::Affine3A, prelude::*};

use super::seeds::Seed;

/// Poses per duration of a line, at high frame rates.
const MOST_POSES: f64 = 32.0;

/// A step is a jump if it is faster than the usual one by this factor.
const JUMP: f64 = 5.0;

/// A pose, and the time of the app's default clock in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub time: f64,
    pub world_from_mesh: Affine3A,
}

/// What the points of an object were chosen for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SeedsOf {
    pub mesh: AssetId<Mesh>,
    pub count: u32,
    pub seed: u32,
}

/// On an object with [`MotionLines`](super::MotionLines): its points, its last poses, and the
/// entity of its ribbons.
#[derive(Component, Debug, Default)]
pub(super) struct Trail {
    /// The oldest one first. The last one is that of this frame. There are as few as the duration
    /// needs.
    poses: VecDeque<Pose>,
    pub seeds: Vec<Seed>,
    pub seeds_of: Option<SeedsOf>,
    /// Middle of the points.
    center: Vec3,
    pub ink: Option<Entity>,
    /// Number of the drawing that the ribbons show.
    pub drawing: Option<u64>,
}

impl Trail {
    pub fn set_seeds(&mut self, seeds: Vec<Seed>, of: SeedsOf) {
        let sum: Vec3 = seeds.iter().map(|seed| seed.place).sum();
        self.center = sum / seeds.len().max(1) as f32;
        self.seeds = seeds;
        self.seeds_of = Some(of);
        self.drawing = None;
    }

    /// Begins anew.
    pub fn forget(&mut self) {
        self.poses.clear();
        self.drawing = None;
    }

    /// The whole world has moved, the object with it.
    pub fn shift(&mut self, by: Vec3) {
        for pose in &mut self.poses {
            pose.world_from_mesh.translation += Vec3A::from(by);
        }
        self.drawing = None;
    }

    pub fn poses(&self) -> &VecDeque<Pose> {
        &self.poses
    }

    /// Adds the pose of this frame. `duration`: of the longest line, in seconds.
    pub fn add(&mut self, new: Pose, duration: f64) {
        if !new.world_from_mesh.is_finite() {
            self.forget();
            return;
        }
        if let Some(last) = self.poses.back() {
            if new.time == last.time {
                // The game is paused.
                return;
            }
            if new.time < last.time {
                self.forget();
            }
        }
        self.forget_before_jump(&new);
        let spacing = duration / MOST_POSES;
        if let [.., before, last] = *self.poses.make_contiguous()
            && last.time - before.time < spacing
        {
            self.poses.pop_back();
        }
        self.poses.push_back(new);
        let begin = new.time - duration;
        while self.poses.get(1).is_some_and(|second| second.time <= begin) {
            self.poses.pop_front();
        }
    }

    /// Mean speed of the middle between two poses.
    fn speed(&self, from: &Pose, to: &Pose) -> f64 {
        let [a, b] = [from, to].map(|pose| pose.world_from_mesh.transform_point3(self.center));
        f64::from(a.distance(b)) / (to.time - from.time)
    }

    fn forget_before_jump(&mut self, new: &Pose) {
        let poses: Vec<Pose> = self.poses.iter().copied().collect();
        let Some(last) = poses.last() else {
            return;
        };
        let speed = self.speed(last, new);
        let mut usual: Vec<f64> = (poses.windows(2))
            .map(|step| self.speed(&step[0], &step[1]))
            .collect();
        usual.sort_by(f64::total_cmp);
        let Some(median) = usual.get(usual.len() / 2) else {
            return;
        };
        if speed > JUMP * median {
            self.forget();
        } else if usual.len() == 1 && *median > JUMP * speed {
            // The first step of all was one.
            self.poses.pop_front();
        }
    }

    /// The path of a point between two times, and how fast it is at its end: places in the world,
    /// the oldest one first. Empty if nothing is known of this time.
    pub fn path(&self, seed: &Seed, tail: f64, head: f64) -> Vec<Vec3A> {
        let at = |pose: &Pose| (pose.world_from_mesh).transform_point3a(seed.place.into());
        let mut path = Vec::new();
        let mut before: Option<&Pose> = None;
        for pose in &self.poses {
            let place = at(pose);
            if let Some(before) = before {
                let from = at(before);
                let between = |time: f64| {
                    let t = (time - before.time) / (pose.time - before.time);
                    from.lerp(place, t as f32)
                };
                if before.time < tail && tail < pose.time {
                    path.push(between(tail));
                }
                if before.time < head && head < pose.time && tail < head {
                    path.push(between(head));
                }
            }
            if (tail..=head).contains(&pose.time) {
                path.push(place);
            }
            before = Some(pose);
        }
        path
    }

    /// The last step of a point.
    pub fn last_step(&self, seed: &Seed) -> Vec3A {
        let mut last = self.poses.iter().rev();
        let (Some(now), Some(before)) = (last.next(), last.next()) else {
            return Vec3A::ZERO;
        };
        let at = |pose: &Pose| (pose.world_from_mesh).transform_point3a(seed.place.into());
        at(now) - at(before)
    }
}
