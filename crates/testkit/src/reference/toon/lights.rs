//! Reference of `toon/lights.wgsl`.

use bevy::math::DVec3;
use bevy_comics::ToonLight;

use super::super::{
    light::{edge_at, flat_falloff},
    rect,
};
use super::surface::{Arriving, Surface, pixel_size};

/// A lamp of the engine, as its shader has it.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    pub at: DVec3,
    /// Luminous intensity.
    pub color: DVec3,
    /// Where its light ends; 0: nowhere.
    pub range: f64,
    pub cone: Option<Cone>,
}

/// The cone of a spot light: its axis, and the cosines of its two angles.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    pub axis: DVec3,
    pub inner: f64,
    pub outer: f64,
}

/// Hard border of a shadow, from the filtered shadow at a pixel and at its neighbours.
pub fn hard_shadow(here: f64, change: f64) -> f64 {
    match here > 0.0 && here < 1.0 {
        true => edge_at(0.5, here, change),
        false => here,
    }
}

/// Light of a lamp at a surface, without shadows.
pub fn clustered_light(light: &ToonLight, s: &Surface, lamp: &Lamp, exposure: f64) -> Arriving {
    let offset = lamp.at - s.position;
    let distance = offset.length();
    let per_range = match lamp.range > 0.0 {
        true => lamp.range.powi(-2),
        false => 0.0,
    };
    let pixel = pixel_size(&s.foot);
    let falloff = |light: &ToonLight| {
        let brightest = lamp.color.max_element() * exposure;
        flat_falloff(light, distance * distance, per_range, brightest, pixel)
    };
    let smooth = ToonLight {
        falloff: 0.0,
        ..light.clone()
    };
    let to_light = offset / distance;
    let through = lamp.cone.map_or(1.0, |cone| {
        let width = cone.inner - cone.outer;
        let inside = ((-cone.axis).dot(to_light) - cone.outer) / width;
        edge_at(0.5, inside, pixel / distance / width)
    });
    Arriving {
        color: through * falloff(light) * lamp.color,
        smooth_color: through * falloff(&smooth) * lamp.color,
        to_light,
        to_highlight: to_light,
        per_distance: distance.recip(),
        lit: 1.0,
        diffuse: 1.0,
        shine: 1.0,
    }
}

/// A rectangle that shines to one side.
#[derive(Clone, Copy, Debug)]
pub struct RectLamp {
    pub at: DVec3,
    /// Luminance.
    pub color: DVec3,
    pub right: DVec3,
    pub up: DVec3,
    pub size: [f64; 2],
    pub range: f64,
}

/// Light of a rectangle at a surface, as the sum of `cells` times `cells` parts; nothing behind it.
pub fn rect_light_at(s: &Surface, lamp: &RectLamp, cells: usize) -> Arriving {
    let at = s.position - lamp.at;
    let [right, up] = [
        0.5 * lamp.size[0] * lamp.right,
        0.5 * lamp.size[1] * lamp.up,
    ];
    let lit = Arriving {
        lit: 1.0,
        diffuse: 1.0,
        ..Arriving::default()
    };
    if lamp.up.cross(lamp.right).dot(at) <= 0.0 {
        return lit;
    }
    let [a, b, c] = [right, up, at].map(|v| v.to_array());
    let vector = DVec3::from_array(rect::rect_light(a, b, c, cells));
    let end = (1.0 - (at.length() / lamp.range).powi(4)).clamp(0.0, 1.0);
    let color = std::f64::consts::PI * lamp.color * vector.length() * end * end;
    let mirrored = 2.0 * s.normal.dot(s.to_eye) * s.normal - s.to_eye;
    let shown = rect::mirrored(a, b, c, mirrored.to_array());
    let to_place = DVec3::from_array(shown) - at;
    Arriving {
        color,
        smooth_color: color,
        to_light: vector.normalize_or_zero(),
        to_highlight: to_place.normalize(),
        per_distance: to_place.length().recip(),
        shine: 1.0,
        ..lit
    }
}
