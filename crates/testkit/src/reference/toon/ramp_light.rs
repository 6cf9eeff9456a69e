//! Reference of `toon/ramp_light.wgsl`.

use bevy::math::DVec3;
use bevy_comics::{
    ToonLight,
    toon::{DetailAxis, Ramp, RampBlend},
};

use super::super::{
    Rgb,
    color::{linear_to_oklab, oklab_to_linear},
    detail,
    light::edge_at,
    mix,
};
use super::reflect::shadows;
use super::surface::{Arriving, Surface, biased_cosine, biased_over_pixel};

/// The tones of a ramp at a detail, lowest first: colour, place and softness.
pub struct Tones(Vec<(DVec3, f64, f64)>);

impl Tones {
    /// The tones at a detail from 0 (the second ramp) to 1.
    pub fn new(ramp: &Ramp, detail: f64) -> Self {
        let plain = ramp.detail.as_ref().map(|detail| &detail.plain);
        let of = |(k, stop): (usize, &bevy_comics::toon::RampStop)| {
            let linear = |color: bevy::color::Color| -> Rgb {
                let color = color.to_linear();
                [color.red, color.green, color.blue].map(f64::from)
            };
            let [at, softness] = [stop.at, stop.softness].map(f64::from);
            let Some(other) = plain.map(|plain| plain[k]) else {
                return (DVec3::from_array(linear(stop.color)), at, softness);
            };
            let [a, b] = [other.color, stop.color].map(|c| linear_to_oklab(linear(c)));
            let color = oklab_to_linear(std::array::from_fn(|c| mix(a[c], b[c], detail)));
            (
                DVec3::from_array(color).max(DVec3::ZERO),
                mix(f64::from(other.at), at, detail),
                mix(f64::from(other.softness), softness, detail),
            )
        };
        Self(ramp.stops.iter().enumerate().map(of).collect())
    }

    fn edges(&self, arriving: f64, width: f64) -> impl Iterator<Item = (DVec3, f64)> {
        let edge = move |&(color, at, softness): &(DVec3, f64, f64)| {
            (color, edge_at(at, arriving, softness.max(width)))
        };
        self.0.iter().skip(1).map(edge)
    }

    /// The tone where a part of the light arrives.
    pub fn at(&self, arriving: f64, width: f64) -> DVec3 {
        let above = |below: DVec3, (color, edge): (DVec3, f64)| below.lerp(color, edge);
        self.edges(arriving, width).fold(self.0[0].0, above)
    }

    /// The same, where something else keeps `1 - lit` of the light away: a mixture with the tone of
    /// the shadow. Where a pixel has the border of the shadow and an edge, the darker one counts.
    pub fn shadowed(&self, arriving: f64, width: f64, lit: f64) -> DVec3 {
        let highest = (self.edges(arriving, width)).fold(0.0, |most, (_, edge)| edge.max(most));
        let kept = match highest > 0.0 {
            true => lit.min(highest) / highest,
            false => 0.0,
        };
        self.0[0].0.lerp(self.at(arriving, width), kept)
    }

    /// A tone of which shadows take away only a part.
    pub fn weakened(&self, light: &ToonLight, tone: DVec3) -> DVec3 {
        let [backface, projected] = shadows(light);
        let full = self.at(1.0, 0.0);
        full.lerp(tone, backface.max(projected).min(1.0))
    }
}

/// The ramp of a light that has one.
pub fn ramp(light: &ToonLight) -> &Ramp {
    light.ramp.as_ref().expect("a ramp")
}

/// Cosine between normal and light, and its change over a pixel.
pub fn angle_of(light: &ToonLight, s: &Surface, lamp: &Arriving) -> (f64, f64) {
    match shadows(light)[0] > 0.0 {
        true => (
            biased_cosine(s, lamp.to_light),
            biased_over_pixel(s, lamp.to_light),
        ),
        false => (1.0, 0.0),
    }
}

/// Detail of the ramp in a light.
pub fn detail_of(light: &ToonLight, s: &Surface, lamp: &Arriving) -> f64 {
    match ramp(light).detail.as_ref().map(|detail| detail.axis) {
        Some(axis @ DetailAxis::Highlight { .. }) => {
            let mirrored = 2.0 * s.normal.dot(lamp.to_light) * s.normal - lamp.to_light;
            detail::detail(axis, mirrored.dot(s.to_eye))
        }
        _ => s.detail,
    }
}

/// The tone of one light at an angle and its change over a pixel.
pub fn tone_of(light: &ToonLight, angle: (f64, f64), lit: f64, detail: f64) -> DVec3 {
    let tones = Tones::new(ramp(light), detail);
    tones.weakened(light, tones.shadowed(angle.0, angle.1, lit))
}

/// The colour of a surface in a tone, under lights and light from all around.
pub fn toned(light: &ToonLight, base: DVec3, tone: DVec3, direct: DVec3, even: DVec3) -> DVec3 {
    match ramp(light).blend {
        RampBlend::Absolute => tone * (direct + even),
        _ => base * (tone * direct + even),
    }
}
