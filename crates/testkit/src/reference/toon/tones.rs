//! The tones of a ramp: reference of `toon/ramp.wgsl`.

use bevy::{color::Color, math::DVec3};
use bevy_comics::toon::{Ramp, RampStop};

use super::super::{
    Rgb,
    color::{linear_to_oklab, oklab_to_linear},
    light::edge_at,
    mix,
};

struct Stop {
    color: DVec3,
    at: f64,
    softness: f64,
}

/// The tones of a ramp, lowest first.
pub struct Tones(Vec<Stop>);

fn rgb(color: Color) -> Rgb {
    let color = color.to_linear();
    [color.red, color.green, color.blue].map(f64::from)
}

/// A stop between two, with the color between in Oklab.
fn between(plain: &RampStop, full: &RampStop, detail: f64) -> Stop {
    let [a, b] = [plain, full].map(|stop| linear_to_oklab(rgb(stop.color)));
    let color = oklab_to_linear(std::array::from_fn(|c| mix(a[c], b[c], detail)));
    let number = |plain: f32, full: f32| mix(plain.into(), full.into(), detail);
    Stop {
        color: DVec3::from_array(color).max(DVec3::ZERO),
        at: number(plain.at, full.at),
        softness: number(plain.softness, full.softness),
    }
}

impl Tones {
    /// The tones at a detail from 0 (the second ramp, if there is one) to 1.
    pub fn new(ramp: &Ramp, detail: f64) -> Self {
        let of = |(k, stop): (usize, &RampStop)| match &ramp.detail {
            Some(second) => between(&second.plain[k], stop, detail),
            None => Stop {
                color: DVec3::from_array(rgb(stop.color)),
                at: stop.at.into(),
                softness: stop.softness.into(),
            },
        };
        Self(ramp.stops.iter().enumerate().map(of).collect())
    }

    /// The colors above the lowest one, and how much of each there is over the one below.
    fn edges(&self, arriving: f64, width: f64) -> impl Iterator<Item = (DVec3, f64)> {
        let edge = move |stop: &Stop| edge_at(stop.at, arriving, stop.softness.max(width));
        self.0
            .iter()
            .skip(1)
            .map(move |stop| (stop.color, edge(stop)))
    }

    /// The tone where a part of the light arrives, which changes by `width` over a pixel.
    pub fn at(&self, arriving: f64, width: f64) -> DVec3 {
        let above = |below: DVec3, (color, edge): (DVec3, f64)| below.lerp(color, edge);
        self.edges(arriving, width).fold(self.0[0].color, above)
    }

    /// The same, where something else keeps `1 - lit` of the light away: a mixture with the tone of
    /// the shadow. Where a pixel has the border of the shadow and an edge, the darker one counts.
    pub fn shadowed(&self, arriving: f64, width: f64, lit: f64) -> DVec3 {
        let edges = self.edges(arriving, width);
        let highest = edges.fold(0.0, |most, (_, edge)| edge.max(most));
        let kept = match highest > 0.0 {
            true => lit.min(highest) / highest,
            false => 0.0,
        };
        self.0[0].color.lerp(self.at(arriving, width), kept)
    }
}
