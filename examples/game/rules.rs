//! The rules of the game: a paper plane, lanterns, storm clouds and a clock. They use no
//! app and no renderer, so that unit tests can play the game. Lengths are in world units.

use bevy::math::{EulerRot, Quat, Vec2, Vec3};

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
    pub lanterns: Vec<Vec3>,
    pub clouds: Vec<Vec3>,
    /// Time at the start, seconds.
    pub seconds: f32,
    /// Height of the ground at (x, z).
    pub ground: fn(Vec2) -> f32,
}

/// What happened in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The lantern of this index was collected.
    Lantern(usize),
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
    pub score: u32,
    /// Slow motion that is left, 0 to 1.
    pub focus: f32,
    pub is_slow: bool,
    pub is_over: bool,
    /// Seconds until a hit counts again.
    shield: f32,
    /// Lanterns in a row without a hit.
    streak: u32,
    time: f32,
}

pub const CLOUD_RADIUS: f32 = 5.0;
/// Distance from which a lantern is collected.
const LANTERN_REACH: f32 = 5.5;
/// Units per second, and the factor while boosting.
const SPEED: f32 = 20.0;
const BOOST: f32 = 1.6;
/// Speed of time in slow motion.
const SLOW: f32 = 0.35;
/// Seconds that a lantern adds, and that a hit takes.
const GAIN: f32 = 1.5;
const LOSS: f32 = 4.0;

impl Flight {
    pub fn new(course: Course) -> Self {
        Self {
            at: course.start,
            yaw: course.heading,
            pitch: 0.0,
            roll: 0.0,
            collected: vec![false; course.lanterns.len()],
            seconds_left: course.seconds,
            score: 0,
            focus: 1.0,
            is_slow: false,
            is_over: false,
            shield: 1.0,
            streak: 0,
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

    /// Where a cloud is now; clouds drift.
    pub fn cloud(&self, index: usize) -> Vec3 {
        let phase = self.time * 0.5 + index as f32 * 2.1;
        self.course.clouds[index] + Vec3::new(phase.sin() * 6.0, (phase * 0.7).cos() * 2.0, 0.0)
    }

    /// 0 is safe; 1 is close to a cloud, or out of time.
    pub fn danger(&self) -> f32 {
        let nearest = (0..self.course.clouds.len())
            .map(|i| self.cloud(i).distance(self.at))
            .fold(f32::INFINITY, f32::min);
        let clouds = ((CLOUD_RADIUS * 5.0 - nearest) / (CLOUD_RADIUS * 3.5)).clamp(0.0, 1.0);
        let clock = ((8.0 - self.seconds_left) / 8.0).clamp(0.0, 1.0);
        clouds.max(clock)
    }

    /// Advances the flight by `seconds` of real time.
    pub fn step(&mut self, controls: &Controls, seconds: f32) -> Vec<Event> {
        let mut events = Vec::new();
        if self.is_over {
            return events;
        }
        self.is_slow = controls.slow && self.focus > 0.0;
        self.focus = if self.is_slow {
            (self.focus - seconds / 4.0).max(0.0)
        } else {
            (self.focus + seconds / 12.0).min(1.0)
        };
        let dt = seconds * if self.is_slow { SLOW } else { 1.0 };
        self.time += dt;
        self.seconds_left = (self.seconds_left - dt).max(0.0);
        self.shield = (self.shield - dt).max(0.0);

        let steer = controls.steer.clamp(Vec2::NEG_ONE, Vec2::ONE);
        self.yaw -= steer.x * 1.5 * dt;
        let ease = |now: f32, goal: f32, rate: f32| now + (goal - now) * (1.0 - (-rate * dt).exp());
        self.pitch = ease(self.pitch, steer.y * 0.75, 4.0);
        self.roll = ease(self.roll, -steer.x * 0.8, 5.0);
        let speed = SPEED * if controls.boost { BOOST } else { 1.0 };
        self.at += self.forward() * speed * dt;

        let floor = (self.course.ground)(Vec2::new(self.at.x, self.at.z)) + 1.0;
        let mut hit = false;
        if self.at.y < floor {
            self.at.y = floor + 0.5;
            self.pitch = 0.5;
            hit = true;
        }
        self.at.y = self.at.y.min(floor + 70.0);
        for i in 0..self.course.clouds.len() {
            let away = self.at - self.cloud(i);
            if away.length() < CLOUD_RADIUS {
                self.at += away.normalize_or(Vec3::Y) * 2.0;
                hit = true;
            }
        }
        if hit && self.shield == 0.0 {
            self.shield = 1.5;
            self.streak = 0;
            self.seconds_left = (self.seconds_left - LOSS).max(0.0);
            events.push(Event::Hit);
        }
        for (i, lantern) in self.course.lanterns.iter().enumerate() {
            if !self.collected[i] && lantern.distance(self.at) < LANTERN_REACH {
                self.collected[i] = true;
                self.streak += 1;
                self.score += 100 * self.streak;
                self.seconds_left += GAIN;
                events.push(Event::Lantern(i));
            }
        }
        if self.collected.iter().all(|c| *c) {
            self.score += (self.seconds_left * 20.0) as u32;
            self.is_over = true;
            events.push(Event::Won);
        } else if self.seconds_left == 0.0 {
            self.is_over = true;
            events.push(Event::Lost);
        }
        events
    }

    /// Steers towards the nearest lantern that is left, and away from clouds.
    pub fn autopilot(&self) -> Controls {
        let open = self
            .course
            .lanterns
            .iter()
            .zip(&self.collected)
            .filter(|(_, collected)| !**collected)
            .map(|(lantern, _)| *lantern);
        let Some(goal) = open.min_by(|a, b| a.distance(self.at).total_cmp(&b.distance(self.at)))
        else {
            return Controls::default();
        };
        let mut wanted = (goal - self.at).normalize_or_zero();
        for i in 0..self.course.clouds.len() {
            let away = self.at - self.cloud(i);
            let near = (CLOUD_RADIUS * 3.0 / away.length().max(0.1)).powi(2);
            if near > 1.0 && away.dot(wanted) < 0.0 {
                wanted += away.normalize_or_zero() * (near - 1.0).min(1.5) + Vec3::Y * 0.3;
            }
        }
        let local = Quat::from_rotation_y(-self.yaw) * wanted.normalize_or_zero();
        let turn = local.x.atan2(-local.z);
        // A lantern that is too near for a turn: flies on and comes back.
        let circling = turn.abs() > 1.0 && goal.distance(self.at) < 14.0;
        Controls {
            steer: Vec2::new(
                if circling {
                    0.0
                } else {
                    (turn * 2.0).clamp(-1.0, 1.0)
                },
                (local.y * 2.5).clamp(-1.0, 1.0),
            ),
            boost: turn.abs() < 0.15 && goal.distance(self.at) > 40.0,
            slow: self.danger() > 0.9,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course() -> Course {
        Course {
            start: Vec3::new(0.0, 10.0, 0.0),
            heading: 0.0,
            lanterns: vec![Vec3::new(0.0, 10.0, -40.0), Vec3::new(20.0, 14.0, -80.0)],
            clouds: Vec::new(),
            seconds: 30.0,
            ground: |_| 0.0,
        }
    }

    fn fly(mut flight: Flight, mut controls: impl FnMut(&Flight) -> Controls) -> Flight {
        for _ in 0..6000 {
            let now = controls(&flight);
            flight.step(&now, 1.0 / 60.0);
        }
        flight
    }

    #[test]
    fn the_autopilot_wins_and_nobody_else_does() {
        let won = fly(Flight::new(course()), Flight::autopilot);
        assert_eq!(won.found(), 2);
        assert!(won.is_over && won.seconds_left > 0.0 && won.score > 300);
        let lost = fly(Flight::new(course()), |_| Controls::default());
        assert!(lost.is_over && lost.found() < 2 && lost.seconds_left == 0.0);
    }

    #[test]
    fn the_ground_costs_time_and_no_more() {
        let mut flight = Flight::new(course());
        let down = Controls {
            steer: Vec2::new(0.0, -1.0),
            ..Controls::default()
        };
        let mut hits = 0;
        for _ in 0..240 {
            hits += flight
                .step(&down, 1.0 / 60.0)
                .iter()
                .filter(|event| **event == Event::Hit)
                .count();
            assert!(flight.at.y >= 1.0 && flight.at.is_finite());
        }
        assert!(hits >= 1);
        assert!(flight.seconds_left < 30.0 - 4.0 - LOSS + 0.1);
    }

    #[test]
    fn slow_motion_slows_and_runs_out() {
        let slow = Controls {
            slow: true,
            ..Controls::default()
        };
        let mut flight = Flight::new(course());
        flight.step(&slow, 0.1);
        assert!(flight.is_slow);
        assert!((30.0 - flight.seconds_left - 0.1 * SLOW).abs() < 1e-4);
        for _ in 0..60 {
            flight.step(&slow, 0.1);
        }
        assert!(
            !flight.is_slow || flight.focus < 0.05,
            "slow motion has to run out"
        );
    }
}
