//! Twin of `cartoon/rim_light.wgsl`.

use bevy::math::{DVec2, DVec3};
use bevy_comics::Rim;

use super::super::light_rim::{facing_rim, is_behind, rim_side, sharper};
use super::surface::{Surface, cosine_over_pixel};

/// How much of a rim that faces away there is on a surface.
pub fn facing(rim: &Rim, s: &Surface) -> f64 {
    let width = cosine_over_pixel(&s.foot, s.to_eye);
    facing_rim(rim, s.normal.dot(s.to_eye), width)
}

/// How much of a rim of constant width there is at a place of the picture, in pixels. `away`: the
/// direction on the screen in which the surface turns away, of any length; `recedes`: the change of its
/// distance over a pixel in that direction, over its distance; `far`: distances of pixels over that of
/// the surface. It is all of a rim if the pixels at the end of it are behind.
pub fn beside(
    pixels: f64,
    at: DVec2,
    away: DVec2,
    recedes: f64,
    far: &dyn Fn(DVec2) -> f64,
) -> f64 {
    let place = at + pixels * away.normalize();
    let corner = (place - 0.5).floor();
    let mut behind = 0.0;
    for step in [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE] {
        let middle = corner + step + 0.5;
        let weight = DVec2::ONE - (place - middle).abs();
        behind += weight.x * weight.y * is_behind(far(middle), recedes * pixels);
    }
    sharper(behind)
}

/// A colour with a rim over it, of which `there` is at this place. `to_light`: towards the brightest
/// light, 0 if there is none.
pub fn with_rim(rim: &Rim, color: DVec3, s: &Surface, to_light: DVec3, there: f64) -> DVec3 {
    let side = rim_side(rim, s.normal.dot(to_light));
    let own = rim.color.to_linear();
    let own = DVec3::new(own.red.into(), own.green.into(), own.blue.into());
    color.lerp(own, there * side * f64::from(rim.strength))
}
