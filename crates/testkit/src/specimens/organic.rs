//! The smooth body of an animal with a few deep folds.

use bevy::prelude::*;

use super::{Part, solid::sculpt};
use crate::scenes::noise::{noise3, smoothstep};

/// What stands out of the body: the direction, the sharpness and the height of a smooth
/// bump. A bump is `1 / sqrt(sharpness)` radians wide.
const BUMPS: [(Vec3, f32, f32); 12] = [
    // Head, snout and ears.
    (Vec3::new(0.12, 1.0, 0.45), 9.0, 0.75),
    (Vec3::new(0.1, 0.75, 0.9), 30.0, 0.45),
    (Vec3::new(0.55, 1.1, 0.0), 55.0, 0.35),
    (Vec3::new(-0.35, 1.15, 0.0), 55.0, 0.35),
    // Rump, belly and tail.
    (Vec3::new(0.0, -0.2, -1.0), 6.0, 0.35),
    (Vec3::new(0.0, -0.5, 0.6), 5.0, 0.2),
    (Vec3::new(0.35, 0.15, -1.0), 60.0, 0.45),
    // Legs and shoulders.
    (Vec3::new(0.5, -1.0, 0.5), 25.0, 0.5),
    (Vec3::new(-0.5, -1.0, 0.6), 25.0, 0.5),
    (Vec3::new(0.6, -0.9, -0.4), 18.0, 0.45),
    (Vec3::new(-0.6, -0.9, -0.4), 18.0, 0.45),
    (Vec3::new(-0.9, 0.2, 0.4), 14.0, 0.2),
];

pub(super) fn parts() -> Vec<Part> {
    vec![(sculpt(54, surface), 0xb98a6e)]
}

/// The distance of the surface from the center.
fn radius(direction: Vec3) -> f32 {
    let bumps = BUMPS.iter().map(|(towards, sharpness, height)| {
        let cosine = direction.dot(towards.normalize());
        height * (sharpness * (cosine - 1.0)).exp()
    });
    let soft = 0.06 * noise3(direction * 2.3 + 5.0) + 0.025 * noise3(direction * 5.1 - 3.0);
    // A fold runs where the noise changes its sign, in the areas chosen by other noise.
    let ridge = noise3(direction * 1.9 + Vec3::new(7.3, 1.1, 4.7)).abs();
    let area = noise3(direction * 1.3 + Vec3::new(3.0, 9.0, 2.0));
    let fold = 0.07 * smoothstep(-0.1, 0.2, area) * (1.0 - ridge / 0.2).max(0.0).powi(2);
    1.0 + bumps.sum::<f32>() + soft - fold
}

/// The body is bent and twisted, so that parts of it hide others.
fn surface(direction: Vec3) -> Vec3 {
    let p = direction * Vec3::new(0.75, 0.9, 1.0) * radius(direction);
    let bent = p + Vec3::Z * (0.15 * p.y * p.y);
    Quat::from_rotation_y(0.45 * p.y) * bent
}
