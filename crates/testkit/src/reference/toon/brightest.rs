//! Reference of `toon/brightest.wgsl`.

use std::f64::consts::PI;

use bevy::math::DVec3;
use bevy_comics::ToonLight;

use super::ramp_light::{angle_of, detail_of, tone_of, toned};
use super::surface::{Arriving, Surface};
use super::two_shades::Evenly;
use crate::reference::toon::ambient::brightness;

/// The first of the brightest lights in its tone, and half of all others from all around.
pub fn reflected(light: &ToonLight, s: &Surface, lamps: &[Arriving], e: &Evenly) -> DVec3 {
    let color = |lamp: &Arriving| lamp.color * lamp.diffuse;
    let bright = |lamp: &Arriving| brightness(color(lamp).to_array());
    let most = lamps.iter().map(bright).fold(0.0, f64::max);
    let key = lamps
        .iter()
        .position(|lamp| bright(lamp) == most && most > 0.0);
    let others: DVec3 = (lamps.iter().enumerate())
        .filter(|(k, _)| Some(*k) != key)
        .map(|(_, lamp)| color(lamp))
        .sum();
    let even = 0.5 * others / PI + e.around;
    let (direct, tone) = match key.map(|k| &lamps[k]) {
        Some(lamp) => {
            let detail = detail_of(light, s, lamp);
            let tone = tone_of(light, angle_of(light, s, lamp), lamp.lit, detail);
            (color(lamp) / PI, tone)
        }
        // No light: the tone of shade.
        None => (DVec3::ZERO, tone_of(light, (0.0, 0.0), 0.0, 0.0)),
    };
    e.exposure * toned(light, e.base, tone, direct, even) + e.highlights()
}
