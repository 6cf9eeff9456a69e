//! Reference of `toon/rim_light.wgsl`.

use bevy::math::DVec3;
use bevy_comics::toon::Rim;

use super::rim::{facing_rim, rim_side};
use super::surface::{Surface, cosine_over_pixel};

/// How much of a rim that faces away there is on a surface.
pub fn facing(rim: &Rim, s: &Surface) -> f64 {
    let width = cosine_over_pixel(&s.foot, s.to_eye);
    facing_rim(rim, s.normal.dot(s.to_eye), width)
}

/// A colour with a rim over it, of which `there` is at this place. `to_light`: towards the brightest
/// light, 0 if there is none.
pub fn with_rim(rim: &Rim, color: DVec3, s: &Surface, to_light: DVec3, there: f64) -> DVec3 {
    let side = rim_side(rim, s.normal.dot(to_light));
    let own = rim.color.to_linear();
    let own = DVec3::new(own.red.into(), own.green.into(), own.blue.into());
    color.lerp(own, there * side * f64::from(rim.strength))
}
