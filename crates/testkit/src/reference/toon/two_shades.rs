//! Reference of `toon/two_shades.wgsl`.

use bevy::math::DVec3;

use super::surface::Arriving;

/// What a surface reflects besides lights with their shadows: its colour, light that arrives evenly,
/// that of its highlights times pi, and the exposure.
#[derive(Clone, Copy, Debug)]
pub struct Evenly {
    pub base: DVec3,
    pub around: DVec3,
    pub shine: DVec3,
    pub exposure: f64,
}

impl Evenly {
    /// The exposed highlights.
    pub fn highlights(&self) -> DVec3 {
        self.exposure * self.shine / std::f64::consts::PI
    }
}

/// All lights, each with what its shadows leave of it.
pub fn reflected(lamps: &[(Arriving, f64)], e: &Evenly) -> DVec3 {
    let illuminance: DVec3 = (lamps.iter())
        .map(|(lamp, left)| lamp.color * *left * lamp.diffuse)
        .sum();
    let all = illuminance / std::f64::consts::PI + e.around;
    e.exposure * e.base * all + e.highlights()
}
