//! Reference of `toon/per_light.wgsl`.

use std::f64::consts::PI;

use bevy::math::DVec3;
use bevy_comics::{ToonLight, toon::RampBlend};

use super::ramp_light::{angle_of, detail_of, ramp, tone_of};
use super::surface::{Arriving, Surface};
use super::two_shades::Evenly;
use crate::reference::toon::ambient::brightness;

/// The sum of all lights, each in its own tone. A ramp of absolute colours also colours light from
/// all around: in the mean of the tones by the brightness of their lights, or in the tone of shade.
pub fn reflected(light: &ToonLight, s: &Surface, lamps: &[Arriving], e: &Evenly) -> DVec3 {
    let tone = |lamp: &Arriving| {
        let angle = angle_of(light, s, lamp);
        tone_of(light, angle, lamp.lit, detail_of(light, s, lamp))
    };
    let weight = |lamp: &Arriving| brightness((lamp.color * lamp.diffuse).to_array()).max(0.0);
    let direct: DVec3 = (lamps.iter())
        .map(|lamp| lamp.color * lamp.diffuse * tone(lamp) / PI)
        .sum();
    let color = match ramp(light).blend {
        RampBlend::Absolute => {
            let bright: f64 = lamps.iter().map(weight).sum();
            let sum: DVec3 = lamps.iter().map(|lamp| weight(lamp) * tone(lamp)).sum();
            let mean = match bright > 0.0 {
                true => sum / bright,
                false => tone_of(light, (0.0, 0.0), 1.0, 1.0),
            };
            direct + mean * e.around
        }
        _ => e.base * (direct + e.around),
    };
    e.exposure * color + e.highlights()
}
