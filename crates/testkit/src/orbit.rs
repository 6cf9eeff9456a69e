//! A camera that orbits its target: drag to turn, wheel to zoom.

use bevy::{
    input::mouse::{AccumulatedMouseMotion, AccumulatedMouseScroll, MouseScrollUnit},
    prelude::*,
};
use bevy_comics_inspector::ComicsInspector;

use crate::scenes::Vantage;

pub struct OrbitPlugin;

impl Plugin for OrbitPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, turn.run_if(is_free));
    }
}

/// Whether the pointer is outside the panel.
fn is_free(inspector: Option<Res<ComicsInspector>>) -> bool {
    inspector.is_none_or(|inspector| !inspector.wants_pointer)
}

/// Position of the camera relative to its target.
#[derive(Component, Clone)]
pub struct Orbit {
    target: Vec3,
    distance: f32,
    yaw: f32,
    pitch: f32,
}

impl Orbit {
    pub fn of(vantage: &Vantage) -> Self {
        let away = vantage.eye - vantage.target;
        let distance = away.length();
        Self {
            target: vantage.target,
            distance,
            yaw: away.x.atan2(away.z),
            pitch: (away.y / distance).asin(),
        }
    }
}

fn turn(
    buttons: Res<ButtonInput<MouseButton>>,
    motion: Res<AccumulatedMouseMotion>,
    scroll: Res<AccumulatedMouseScroll>,
    mut cameras: Query<(&mut Transform, &mut Projection, &mut Orbit)>,
) {
    for (mut transform, mut projection, mut orbit) in &mut cameras {
        if buttons.pressed(MouseButton::Left) && motion.delta != Vec2::ZERO {
            orbit.yaw -= motion.delta.x * 0.005;
            orbit.pitch = (orbit.pitch + motion.delta.y * 0.005).clamp(-0.2, 1.4);
        }
        if scroll.delta.y != 0.0 {
            let lines = match scroll.unit {
                MouseScrollUnit::Line => scroll.delta.y,
                MouseScrollUnit::Pixel => scroll.delta.y / 40.0,
            };
            let factor = 0.9f32.powf(lines);
            match &mut *projection {
                Projection::Orthographic(p) => p.scale = (p.scale * factor).clamp(0.1, 10.0),
                _ => orbit.distance = (orbit.distance * factor).clamp(1.0, 500.0),
            }
        }
        if orbit.is_changed() {
            let turned = Quat::from_euler(EulerRot::YXZ, orbit.yaw, -orbit.pitch, 0.0);
            let eye = orbit.target + turned * Vec3::Z * orbit.distance;
            *transform = Transform::from_translation(eye).looking_at(orbit.target, Vec3::Y);
        }
    }
}
