//! The rules of the game: a paper plane, lanterns, storm clouds, walls and a clock. They use no
//! app and no renderer, so that unit tests can play the game.
//!
//! Lengths are in world units. Those of the constants are for a course of scale 1.

use bevy::math::{EulerRot, Quat, Vec2, Vec3};

use crate::solids::Solids;

/// The player's controls in a frame, independent of the input device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls {
    /// Right and up are positive; each component -1 to 1.
    pub steer: Vec2,
    pub boost: bool,
    pub slow: bool,
}

/// A course to fly.
#[derive(Clone, Debug)]
pub struct Course {
    pub start: Vec3,
    /// Direction at the start in radians; 0 is along -z.
    pub heading: f32,
    /// In the order of flight.
    pub lanterns: Vec<Vec3>,
    pub clouds: Vec<Vec3>,
    /// Time at the start, seconds.
    pub seconds: f32,
    /// Height of the ground at (x, z).
    pub ground: fn(Vec2) -> f32,
    /// Greatest height above the ground.
    pub ceiling: f32,
    /// Size of the plane, its speed and what belongs to it.
    pub scale: f32,
    /// Houses and trees.
    pub solids: Solids,
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The lantern of this index was collected.
    Lantern(usize),
    /// A wall, a tree or the ground.
    Bump,
    /// A storm cloud.
    Hit,
    Won,
    Lost,
}

/// The state of a flight.
#[derive(Clone, Debug)]
pub struct Flight {
    pub course: Course,
    pub at: Vec3,
    /// Angles in radians.
    pub yaw: f32,
    pub pitch: f32,
    /// Drawn, but without effect on the flight.
    pub roll: f32,
    pub collected: Vec<bool>,
    pub seconds_left: f32,
    /// Slow motion that is left, 0 to 1.
    pub focus: f32,
    pub is_slow: bool,
    pub is_fast: bool,
    pub is_over: bool,
    /// Speed as a fraction of the usual one: less after a bump.
    pub pace: f32,
    /// Seconds until a hit or a bump is an event again.
    shield: f32,
    time: f32,
}

pub const CLOUD_RADIUS: f32 = 5.0;
/// Distance from which a lantern is collected.
const LANTERN_REACH: f32 = 5.5;
/// How many lanterns are lit at a time. Only these can be collected.
const LIT: usize = 3;
/// The plane collides as a ball of this radius.
const BODY: f32 = 0.8;
/// Units per second, and the factor while boosting.
const SPEED: f32 = 20.0;
const BOOST: f32 = 1.6;
/// Speed of time in slow motion.
const SLOW: f32 = 0.35;
/// Seconds that a storm cloud takes.
const LOSS: f32 = 4.0;
/// Pace after a bump, and how much of it comes back in a second.
const BUMPED: f32 = 0.35;
const RECOVERY: f32 = 0.5;

impl Flight {
    pub fn new(course: Course) -> Self {
        Self {
            at: course.start,
            yaw: course.heading,
            pitch: 0.0,
            roll: 0.0,
            collected: vec![false; course.lanterns.len()],
            seconds_left: course.seconds,
            focus: 1.0,
            is_slow: false,
            is_fast: false,
            is_over: false,
            pace: 1.0,
            shield: 0.0,
            time: 0.0,
            course,
        }
    }

    pub fn rotation(&self) -> Quat {
        Quat::from_euler(EulerRot::YXZ, self.yaw, self.pitch, self.roll)
    }

    fn forward(&self) -> Vec3 {
        Quat::from_euler(EulerRot::YXZ, self.yaw, self.pitch, 0.0) * Vec3::NEG_Z
    }

    pub fn found(&self) -> usize {
        self.collected.iter().filter(|c| **c).count()
    }

    /// The lanterns that are lit: the next ones on the course.
    pub fn lit(&self) -> impl Iterator<Item = usize> {
        let open = self.collected.iter().enumerate().filter(|(_, c)| !**c);
        open.map(|(index, _)| index).take(LIT)
    }

    /// Seconds since the start, with those that clouds took: the result of a won flight.
    pub fn seconds_used(&self) -> f32 {
        self.course.seconds - self.seconds_left
    }

    /// Where a cloud is now; clouds drift.
    pub fn cloud(&self, index: usize) -> Vec3 {
        let phase = self.time * 0.5 + index as f32 * 2.1;
        let drift = Vec3::new(phase.sin() * 6.0, (phase * 0.7).cos() * 2.0, 0.0);
        self.course.clouds[index] + drift * self.course.scale
    }

    /// 0 is safe; 1 is close to a cloud, or out of time.
    pub fn danger(&self) -> f32 {
        let nearest = (0..self.course.clouds.len())
            .map(|i| self.cloud(i).distance(self.at) / self.course.scale)
            .fold(f32::INFINITY, f32::min);
        let clouds = ((CLOUD_RADIUS * 5.0 - nearest) / (CLOUD_RADIUS * 3.5)).clamp(0.0, 1.0);
        let clock = ((10.0 - self.seconds_left) / 10.0).clamp(0.0, 1.0);
        clouds.max(clock)
    }

    /// Advances the flight by `seconds` of real time.
    pub fn step(&mut self, controls: &Controls, seconds: f32) -> Vec<Event> {
        if self.is_over {
            return Vec::new();
        }
        self.is_slow = controls.slow && self.focus > 0.0;
        self.is_fast = controls.boost;
        self.focus = if self.is_slow {
            (self.focus - seconds / 4.0).max(0.0)
        } else {
            (self.focus + seconds / 12.0).min(1.0)
        };
        let dt = seconds * if self.is_slow { SLOW } else { 1.0 };
        self.time += dt;
        self.seconds_left = (self.seconds_left - dt).max(0.0);
        self.shield = (self.shield - dt).max(0.0);
        self.pace = (self.pace + RECOVERY * dt).min(1.0);
        self.turn(controls, dt);
        let bumped = self.advance(dt);
        let hit = self.meet_clouds();
        let mut events = Vec::new();
        if (hit || bumped) && self.shield == 0.0 {
            self.shield = 1.5;
            events.push(if hit { Event::Hit } else { Event::Bump });
        }
        if events.contains(&Event::Hit) {
            self.seconds_left = (self.seconds_left - LOSS).max(0.0);
        }
        self.collect(&mut events);
        events
    }

    fn turn(&mut self, controls: &Controls, dt: f32) {
        let steer = controls.steer.clamp(Vec2::NEG_ONE, Vec2::ONE);
        let ease = |now: f32, goal: f32, rate: f32| now + (goal - now) * (1.0 - (-rate * dt).exp());
        self.yaw -= steer.x * 1.5 * dt;
        self.pitch = ease(self.pitch, steer.y * 0.75, 4.0);
        self.roll = ease(self.roll, -steer.x * 0.8, 5.0);
    }

    /// Moves in short steps, so that nothing is passed through. Returns whether it hit something.
    fn advance(&mut self, dt: f32) -> bool {
        let scale = self.course.scale;
        let speed = SPEED * scale * self.pace * if self.is_fast { BOOST } else { 1.0 };
        let steps = (speed * dt / (0.5 * BODY * scale)).ceil().max(1.0);
        let mut bumped = false;
        for _ in 0..steps as usize {
            self.at += self.forward() * (speed * dt / steps);
            let floor = (self.course.ground)(Vec2::new(self.at.x, self.at.z)) + scale;
            self.at.y = self.at.y.min(floor + self.course.ceiling);
            if self.at.y < floor {
                self.bounce(Vec3::Y * (floor - self.at.y));
                bumped = true;
            }
            if let Some(way) = self.course.solids.way_out(self.at, BODY * scale) {
                self.bounce(way);
                bumped = true;
            }
        }
        bumped
    }

    /// Moves out of a surface and flies off from it, more slowly.
    fn bounce(&mut self, way: Vec3) {
        self.at += way;
        let normal = way.normalize_or(Vec3::Y);
        let into = self.forward().dot(normal);
        if into < 0.0 {
            let off = (self.forward() - 1.6 * into * normal).normalize_or(normal);
            self.yaw = (-off.x).atan2(-off.z);
            self.pitch = off.y.clamp(-1.0, 1.0).asin().clamp(-0.75, 0.75);
        }
        // A wing that only grazes costs less than a nose.
        self.pace = self
            .pace
            .min(1.0 - (1.0 - BUMPED) * (-into).clamp(0.25, 1.0));
    }

    /// Leaves the clouds that the plane is in. Returns whether there are any.
    fn meet_clouds(&mut self) -> bool {
        let scale = self.course.scale;
        let mut hit = false;
        for i in 0..self.course.clouds.len() {
            let away = self.at - self.cloud(i);
            if away.length() < CLOUD_RADIUS * scale {
                self.at += away.normalize_or(Vec3::Y) * 2.0 * scale;
                hit = true;
            }
        }
        hit
    }

    /// Collects lit lanterns, and ends the flight if it is over.
    fn collect(&mut self, events: &mut Vec<Event>) {
        let reach = LANTERN_REACH * self.course.scale;
        let lit: Vec<usize> = self.lit().collect();
        for i in lit {
            if self.course.lanterns[i].distance(self.at) < reach {
                self.collected[i] = true;
                events.push(Event::Lantern(i));
            }
        }
        let won = self.collected.iter().all(|c| *c);
        self.is_over = won || self.seconds_left == 0.0;
        if self.is_over {
            events.push(if won { Event::Won } else { Event::Lost });
        }
    }

    /// Steers towards the next lantern, and away from clouds and walls.
    pub fn autopilot(&self) -> Controls {
        let Some(goal) = self.lit().next().map(|i| self.course.lanterns[i]) else {
            return Controls::default();
        };
        let scale = self.course.scale;
        let mut wanted = (goal - self.at).normalize_or_zero();
        for i in 0..self.course.clouds.len() {
            let away = self.at - self.cloud(i);
            let near = (CLOUD_RADIUS * 3.0 * scale / away.length().max(0.1)).powi(2);
            if near > 1.0 && away.dot(wanted) < 0.0 {
                wanted += away.normalize_or_zero() * (near - 1.0).min(1.5) + Vec3::Y * 0.3;
            }
        }
        for ahead in [2.0, 6.0] {
            let (feeler, reach) = (self.at + self.forward() * ahead * scale, 3.0 * scale);
            if let Some(way) = self.course.solids.way_out(feeler, reach) {
                wanted += way / reach * 2.0;
            }
        }
        let local = Quat::from_rotation_y(-self.yaw) * wanted.normalize_or_zero();
        let turn = local.x.atan2(-local.z);
        let distance = goal.distance(self.at) / scale;
        // A lantern that is too near for a turn: flies on and comes back.
        let circling = turn.abs() > 1.0 && distance < 14.0;
        let aside = if circling { 0.0 } else { turn * 2.0 };
        Controls {
            steer: Vec2::new(aside, local.y * 2.5).clamp(Vec2::NEG_ONE, Vec2::ONE),
            boost: turn.abs() < 0.15 && distance > 40.0,
            slow: false,
        }
    }
}

#[cfg(test)]
#[path = "rules_tests.rs"]
mod tests;
