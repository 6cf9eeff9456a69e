//! Reference of `toon/specular.wgsl`.

use bevy::math::DVec3;
use bevy_comics::ToonLight;

use super::reflect::highlight_of;
use super::surface::{Arriving, Surface};
use crate::reference::toon::ambient::brightness;

/// A light, its colour in highlights, and what shadows leave of it.
#[derive(Clone, Copy, Debug)]
pub struct Lit {
    pub lamp: Arriving,
    pub color: DVec3,
    pub left: f64,
}

/// The brightest light: the first of several.
pub fn key(lamps: &[Lit]) -> Option<usize> {
    let most = (lamps.iter().map(bright)).fold(0.0, f64::max);
    lamps
        .iter()
        .position(|lit| bright(lit) == most && most > 0.0)
}

fn bright(lit: &Lit) -> f64 {
    brightness(lit.lamp.smooth_color.to_array()) * lit.lamp.shine
}

/// Light of all highlights, times pi. `sign` is the strength of the sign of a light, if there is one:
/// the brightest light draws it if it is at least a tenth brighter than all others, a plain highlight
/// if it is not, and a mixture between.
pub fn shine(
    light: &ToonLight,
    s: &Surface,
    lamps: &[Lit],
    sign: Option<&dyn Fn(&Arriving) -> f64>,
) -> DVec3 {
    let plain = |lit: &Lit| highlight_of(light, s, &lit.lamp, lit.left);
    let key = key(lamps);
    let of = |(k, lit): (usize, &Lit)| {
        let highlight = match sign {
            Some(sign) if key == Some(k) => {
                let others = lamps.iter().enumerate().filter(|(other, _)| *other != k);
                let next = others.map(|(_, lit)| bright(lit)).fold(0.0, f64::max);
                let alone = (10.0 * (1.0 - next / bright(lit))).clamp(0.0, 1.0);
                let sign = if alone > 0.0 { sign(&lit.lamp) } else { 0.0 };
                plain(lit).mul_add(1.0 - alone, alone * lit.left * sign)
            }
            _ => plain(lit),
        };
        lit.color * highlight
    };
    lamps.iter().enumerate().map(of).sum()
}
