//! Reference of `toon/hatch.wgsl`.

use bevy::math::DVec3;
use bevy_comics::Hatching;

use super::hatching::Hatch;

/// The darkness of strokes where a share of all light arrives.
pub fn hatch_tone(settings: &Hatching, arriving: f64, all: f64) -> f64 {
    let hatch = Hatch {
        settings,
        scale: 1.0,
        drawing: 0,
    };
    let share = if all > 0.0 { arriving / all } else { 0.0 };
    hatch.tone(share.clamp(0.0, 1.0).sqrt()) * f64::from(settings.at_near)
}

/// The unit normal of a surface at rest: that of the mesh, or of the plane that its place changes in.
pub fn rest_normal(across: DVec3, down: DVec3, normal: DVec3) -> DVec3 {
    let face = across.normalize().cross(down.normalize());
    normal.try_normalize().unwrap_or(face.normalize())
}
