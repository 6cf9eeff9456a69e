//! Reference of `toon/light_fraction.wgsl`.

use std::f64::consts::PI;

use bevy::math::DVec3;
use bevy_comics::ToonLight;

use super::ramp_light::{Tones, angle_of, detail_of, ramp, toned};
use super::surface::{Arriving, Surface};
use super::two_shades::Evenly;
use crate::reference::toon::ambient::brightness;

/// One light's part of all: its fraction of the brightness, times the cosine; and what arrives.
struct Part {
    share: f64,
    lit: f64,
}

/// The tone of the share of all light that arrives. The borders of the shadows of the two strongest
/// lights that have one in this pixel mix the tones that the share has with and without each.
fn tone(light: &ToonLight, s: &Surface, lamps: &[Arriving]) -> DVec3 {
    let bright = |lamp: &Arriving| brightness(full(lamp).to_array()).max(0.0);
    let all = lamps.iter().map(bright).sum::<f64>().max(1e-30);
    let mean = |of: &dyn Fn(&Arriving) -> f64| -> f64 {
        lamps
            .iter()
            .map(|lamp| bright(lamp) * of(lamp))
            .sum::<f64>()
            / all
    };
    let width = mean(&|lamp| angle_of(light, s, lamp).1);
    let detail = match ramp(light).detail {
        Some(_) => mean(&|lamp| detail_of(light, s, lamp)),
        None => 1.0,
    };
    let tones = Tones::new(ramp(light), detail);
    let part = |lamp: &Arriving| Part {
        share: bright(lamp) / all * angle_of(light, s, lamp).0.max(0.0),
        lit: lamp.lit,
    };
    let (mut borders, rest): (Vec<Part>, Vec<Part>) = (lamps.iter().map(part))
        .partition(|part| part.share > 0.0 && part.lit > 0.0 && part.lit < 1.0);
    borders.sort_by(|a, b| b.share.total_cmp(&a.share));
    let filtered = rest.iter().chain(borders.iter().skip(2));
    let filtered: f64 = filtered.map(|part| part.share * part.lit).sum();
    borders.truncate(2);
    let mut sum = DVec3::ZERO;
    for states in 0..1u32 << borders.len() {
        let (mut weight, mut share) = (1.0, filtered);
        for (k, part) in borders.iter().enumerate() {
            if states >> k & 1 == 1 {
                weight *= part.lit;
                share += part.share;
            } else {
                weight *= 1.0 - part.lit;
            }
        }
        sum += weight * tones.at(share, width);
    }
    tones.weakened(light, sum)
}

/// A light without rings and shadows.
fn full(lamp: &Arriving) -> DVec3 {
    lamp.smooth_color * lamp.diffuse
}

/// The tone of the share, in the colour of all light.
pub fn reflected(light: &ToonLight, s: &Surface, lamps: &[Arriving], e: &Evenly) -> DVec3 {
    let [direct, even] = light_of(lamps, e);
    let tone = tone(light, s, lamps);
    strength(light, lamps, e) * (toned(light, e.base, tone, direct, even) + e.highlights())
}

/// Exposed light of all lights, and from all around.
fn light_of(lamps: &[Arriving], e: &Evenly) -> [DVec3; 2] {
    let direct = lamps.iter().map(full).sum::<DVec3>() / PI;
    [direct, e.around].map(|light| e.exposure * light)
}

/// What the light is multiplied by: its brightness becomes that of the light in rings to the power of
/// `keep_intensity`.
pub fn strength(light: &ToonLight, lamps: &[Arriving], e: &Evenly) -> f64 {
    let [direct, even] = light_of(lamps, e);
    let bright = |light: DVec3| brightness(light.to_array());
    let all = (bright(direct) + bright(even)).max(1e-7);
    let rings: f64 = (lamps.iter())
        .map(|lamp| bright(lamp.color * lamp.diffuse).max(0.0))
        .sum();
    let ringed = (e.exposure * rings / PI + bright(even)).max(1e-7);
    ringed.powf(f64::from(ramp(light).keep_intensity)) / all
}
