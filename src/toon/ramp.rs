//! Tones of a toon material by how much light arrives.

use bevy::{prelude::*, render::render_resource::ShaderType, shader::ShaderDefVal};
use serde::{Deserialize, Serialize};

use super::{RampDetail, RampStop};
use crate::settings::{FieldRange, clamp_fields, linear_rgb, oklab};

/// The tones of a [`ToonMaterial`](crate::ToonMaterial), from shade to light (Lake et al.
/// 2000).
///
/// A ramp maps an amount of light, from 0 to 1, to a tone; [`mode`](Ramp::mode) says how that
/// amount is measured. Each [`RampStop`] begins a tone. Edges between tones are anti-aliased, and
/// as soft as wanted. The border of a cast shadow goes straight from the lit tone to the first
/// tone, without the tones in between.
///
/// [`form_shadows`], [`cast_shadows`] and [`shadow_strength`] work as without a ramp:
/// where shadows take away only a part of the light, the tone is a mixture with the tone of
/// full light. [`shadow_threshold`] is where highlights end.
///
/// An image can take the place of the stops: [`ToonLight::ramp_map`](crate::ToonLight::ramp_map).
///
/// [`form_shadows`]: crate::ToonLight::form_shadows
/// [`cast_shadows`]: crate::ToonLight::cast_shadows
/// [`shadow_strength`]: crate::ToonLight::shadow_strength
/// [`shadow_threshold`]: crate::ToonLight::shadow_threshold
#[derive(Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Ramp {
    /// The tones and where they begin, in any order: at most [`Ramp::MOST_STOPS`]; further ones are
    /// ignored. Default: a violet shade, and full light from 0.25 on. So surfaces are lit where the
    /// key light reaches them at an angle of 75 degrees or less, and in shade where only a second
    /// light of less than a third of its strength does.
    #[reflect(@FieldRange::linear(1.0, 8.0))]
    pub stops: Vec<RampStop>,
    /// What the ramp is applied to. Default: [`RampMode::LightFraction`].
    pub mode: RampMode,
    /// What the colors of the stops are. Default: [`RampBlend::Multiply`].
    pub blend: RampBlend,
    /// How much of the strength of the light is kept in [`RampMode::LightFraction`]: the exponent
    /// of the luminance. 0: all places are equally bright, whatever the lights and the exposure
    /// are. 1: as bright as they are lit. Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub keep_intensity: f32,
    /// A second ramp, and where it is used. Default: `None`.
    pub detail: Option<RampDetail>,
}

/// What a [`Ramp`] is applied to.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RampMode {
    /// The fraction of all light that arrives: 1 on a surface that faces every light and lies in no
    /// shadow. Lights do not add up to more tones than the ramp has, and the exposure does not
    /// change them.
    #[default]
    LightFraction,
    /// The cosine of the angle between normal and light, for each light; then the sum. Black at 0
    /// and white from `shadow_threshold` on give the light without a ramp.
    PerLight,
    /// The cosine for the brightest light at each place. All other lights have no shape: half of
    /// each, its mean over all directions, arrives everywhere.
    Brightest,
}

/// What the colors of a [`Ramp`] are.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum RampBlend {
    /// Factors of the light: white leaves it as it is. Ambient light is added in full.
    #[default]
    Multiply,
    /// Colors of the surface, in place of its base color. Light and ambient light shine on
    /// them.
    Absolute,
}

impl Default for Ramp {
    fn default() -> Self {
        Self::new([
            RampStop::new(0.0, Color::linear_rgb(0.42, 0.40, 0.55)),
            RampStop::new(0.25, Color::WHITE),
        ])
    }
}

impl Ramp {
    /// The largest number of stops.
    pub const MOST_STOPS: usize = 8;

    /// A ramp of these stops, otherwise with default settings.
    #[must_use]
    pub fn new(stops: impl IntoIterator<Item = RampStop>) -> Self {
        Self {
            stops: stops.into_iter().collect(),
            mode: RampMode::default(),
            blend: RampBlend::default(),
            keep_intensity: 0.5,
            detail: None,
        }
    }

    /// The settings that are used: at most [`Ramp::MOST_STOPS`] stops, sorted; every number is
    /// clamped to its documented range, and a number that is not finite is replaced by its
    /// default. A ramp without stops becomes the default one.
    #[must_use]
    pub fn sanitized(mut self) -> Self {
        self.stops = sanitized(self.stops, || Self::default().stops);
        if let Some(detail) = &mut self.detail {
            let plain = std::mem::take(&mut detail.plain);
            detail.plain = sanitized(plain, || RampDetail::default().plain);
        }
        clamp_fields(self)
    }

    /// Stops of the longer of both ramps.
    fn pairs(&self) -> usize {
        let plain = self.detail.as_ref().map_or(0, |detail| detail.plain.len());
        self.stops.len().max(plain)
    }
}

/// At most [`Ramp::MOST_STOPS`] stops, sorted and in their ranges; the `default` ones if there are
/// none.
fn sanitized(mut stops: Vec<RampStop>, default: fn() -> Vec<RampStop>) -> Vec<RampStop> {
    if stops.is_empty() {
        stops = default();
    }
    stops.truncate(Ramp::MOST_STOPS);
    for stop in &mut stops {
        *stop = clamp_fields(*stop);
    }
    stops.sort_by(|a, b| a.at.total_cmp(&b.at));
    stops
}

/// `Stop` in `ramp.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
struct StopUniform {
    color: Vec3,
    at: f32,
    plain_color: Vec3,
    plain_at: f32,
    softness: f32,
    plain_softness: f32,
}

/// `Ramp` in `ramp.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RampUniform {
    keep_intensity: f32,
    stops: [StopUniform; Ramp::MOST_STOPS],
}

impl From<&Ramp> for RampUniform {
    fn from(ramp: &Ramp) -> Self {
        let ramp = ramp.clone().sanitized();
        let mut stops = [StopUniform::default(); Ramp::MOST_STOPS];
        for (k, to) in stops[..ramp.pairs()].iter_mut().enumerate() {
            let partner = ramp.detail.as_ref().map(|detail| &detail.plain[..]);
            let stop = paired(&ramp.stops, partner.unwrap_or_default(), k);
            *to = StopUniform {
                color: linear_rgb(stop.color),
                at: stop.at,
                softness: stop.softness,
                ..default()
            };
            if let Some(detail) = &ramp.detail {
                let plain = paired(&detail.plain, &ramp.stops, k);
                to.color = oklab(stop.color);
                to.plain_color = oklab(plain.color);
                to.plain_at = plain.at;
                to.plain_softness = plain.softness;
            }
        }
        Self {
            keep_intensity: ramp.keep_intensity,
            stops,
        }
    }
}

/// A stop; beyond the last one, its tone again at the place of the partner's stop, where nothing
/// changes.
fn paired(stops: &[RampStop], partner: &[RampStop], k: usize) -> RampStop {
    if let Some(stop) = stops.get(k) {
        return *stop;
    }
    let last = stops.last().copied().unwrap_or_default();
    let other = partner.get(k).copied().unwrap_or_default();
    RampStop {
        at: last.at.max(other.at),
        softness: other.softness,
        ..last
    }
}

/// The part of a ramp that selects a variant of the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct RampKey {
    mode: RampMode,
    blend: RampBlend,
    /// Stops of the longer ramp; one if an image takes their place.
    stops: u8,
    /// The tones are those of an image.
    painted: bool,
    /// The shader definition of the axis.
    axis: Option<&'static str>,
}

impl RampKey {
    pub(super) fn new(ramp: &Ramp, painted: bool) -> Self {
        let ramp = ramp.clone().sanitized();
        Self {
            mode: ramp.mode,
            blend: ramp.blend,
            stops: if painted { 1 } else { ramp.pairs() as u8 },
            painted,
            axis: ramp.detail.map(|detail| detail.axis.definition()),
        }
    }

    pub(super) fn definitions(self) -> impl Iterator<Item = ShaderDefVal> {
        let mode = match self.mode {
            RampMode::LightFraction => "RAMP_LIGHT_FRACTION",
            RampMode::PerLight => "RAMP_PER_LIGHT",
            RampMode::Brightest => "RAMP_BRIGHTEST",
        };
        let blend = (self.blend == RampBlend::Absolute).then_some("RAMP_ABSOLUTE");
        let detail = self.axis.map(|_| "RAMP_DETAIL");
        let map = self.painted.then_some("RAMP_MAP");
        let flags = [Some(mode), blend, detail, self.axis, map];
        let stops = ShaderDefVal::UInt("RAMP_STOPS".into(), u32::from(self.stops));
        flags
            .into_iter()
            .flatten()
            .map(ShaderDefVal::from)
            .chain([stops])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_are_sorted_clamped_and_at_most_eight() {
        let ramp = |stops: Vec<RampStop>, plain| Ramp {
            detail: Some(RampDetail {
                plain,
                ..RampDetail::default()
            }),
            ..Ramp::new(stops)
        };
        let stop = |k: u32| RampStop::new(1.0 - 0.1 * k as f32, Color::WHITE);
        let stops: Vec<_> = (0..20).map(stop).collect();
        let default = ramp(Ramp::default().stops, RampDetail::default().plain);
        assert_eq!(ramp(Vec::new(), Vec::new()).sanitized(), default);
        let ramp = ramp(stops.clone(), stops).sanitized();
        assert_eq!(Some(&ramp.stops), ramp.detail.as_ref().map(|d| &d.plain));
        assert_eq!(ramp.stops.len(), Ramp::MOST_STOPS);
        assert!(ramp.stops.is_sorted_by(|a, b| a.at <= b.at));
        let bad = RampStop {
            at: f32::NAN,
            color: Color::linear_rgb(9.0, f32::NAN, 0.0),
            softness: f32::INFINITY,
        };
        let mut ramp = Ramp::new([bad, RampStop::new(-3.0, Color::BLACK).soft(7.0)]);
        ramp.keep_intensity = f32::NAN;
        let ramp = ramp.sanitized();
        assert_eq!(ramp.stops[0], RampStop::default());
        assert_eq!(ramp.stops[1], RampStop::new(0.0, Color::BLACK).soft(1.0));
        assert_eq!(ramp.keep_intensity, 0.5);
    }
}
