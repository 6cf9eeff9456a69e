//! A simple animation: the character looks around, waves and blinks, and the wind moves hair and
//! scarf.

use std::f32::consts::TAU;

use bevy::prelude::*;

/// Turns an entity to and fro about its origin.
#[derive(Component, Clone, Copy)]
pub struct Sway {
    rest: Transform,
    axis: Vec3,
    /// Radians to both sides.
    angle: f32,
    /// Seconds.
    period: f32,
    /// Where in the period it begins, as a fraction.
    phase: f32,
}

impl Sway {
    pub fn new(rest: Transform, axis: Vec3, angle: f32, period: f32, phase: f32) -> Self {
        Self {
            rest,
            axis: axis.normalize_or(Vec3::Y),
            angle,
            period,
            phase,
        }
    }

    /// The transform after some seconds.
    pub fn at(&self, seconds: f32) -> Transform {
        let turns = seconds / self.period + self.phase;
        let angle = self.angle * (TAU * turns).sin();
        self.rest * Transform::from_rotation(Quat::from_axis_angle(self.axis, angle))
    }
}

/// What is shown while the eyes are open, or while they are closed.
#[derive(Component, Clone, Copy, PartialEq, Eq)]
pub enum Lids {
    Open,
    Closed,
}

/// Whether the eyes are closed after some seconds: a blink is short.
fn is_blinking(seconds: f32) -> bool {
    const PERIOD: f32 = 3.4;
    const LENGTH: f32 = 0.13;
    (seconds + 2.87) % PERIOD > PERIOD - LENGTH
}

/// Animates the scenes that move. Without it they stand still.
pub struct MotionPlugin;

impl Plugin for MotionPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, (sway, blink));
    }
}

fn sway(time: Res<Time>, mut parts: Query<(&Sway, &mut Transform)>) {
    for (sway, mut transform) in &mut parts {
        *transform = sway.at(time.elapsed_secs());
    }
}

fn blink(time: Res<Time>, mut eyes: Query<(&Lids, &mut Visibility)>) {
    let closed = is_blinking(time.elapsed_secs());
    for (lids, mut visibility) in &mut eyes {
        let shown = closed == (*lids == Lids::Closed);
        visibility.set_if_neq(if shown {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        });
    }
}
