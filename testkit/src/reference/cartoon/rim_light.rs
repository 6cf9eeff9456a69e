//! Twin of `cartoon/rim_light.wgsl`.

use bevy::math::DVec3;
use bevy_comics::Rim;

use super::super::light_rim::{facing_rim, rim_side};
use super::surface::{Surface, cosine_over_pixel};

/// A colour with the rim over it, where the surface turns away from the eye. `to_light`: towards the
/// brightest light, 0 if there is none.
pub fn with_rim(rim: &Rim, color: DVec3, s: &Surface, to_light: DVec3) -> DVec3 {
    let width = cosine_over_pixel(&s.foot, s.to_eye);
    let there = facing_rim(rim, s.normal.dot(s.to_eye), width);
    let side = rim_side(rim, s.normal.dot(to_light));
    let own = rim.color.to_linear();
    let own = DVec3::new(own.red.into(), own.green.into(), own.blue.into());
    color.lerp(own, there * side * f64::from(rim.strength))
}
