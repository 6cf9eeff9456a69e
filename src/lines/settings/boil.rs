//! Lines that are drawn again several times a second.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    clock::animation_seed,
    settings::{BlendField, FieldRange, impl_sanitized},
};

/// Displaces lines by noise that changes several times a second, as if each drawing of an
/// animated film had been inked anew ("boiling" lines).
///
/// The noise is fixed to the picture, so lines slide through it while the camera moves. Between two
/// drawings it stands still. Faithful lines do not boil. Narrow lines cost about twice as much when
/// they boil.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LineBoil {
    /// Largest displacement per axis in logical pixels. Wide dark lines that jump far flicker,
    /// which can harm sensitive viewers. So the displacement times the width of the widest line is
    /// limited to 8 square pixels: a line of 4 pixels moves by up to 2, one of 16 by up to 0.5.
    /// Range 0 (off) to 3, default 0.
    #[reflect(@FieldRange::linear(0.0, 3.0).unit("px"))]
    pub amplitude: f32,
    // Waves and drawings switch: in between, every frame would be another drawing.
    /// Length of the waves of a line in logical pixels. Range 20 to 120, default 60.
    #[reflect(@FieldRange::linear(20.0, 120.0).unit("px"), @BlendField::Switch)]
    pub wavelength: f32,
    /// Drawings per second. Films that are animated "on twos" have 12. Range 0 (one drawing
    /// for all time) to 60, default 12.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"), @BlendField::Switch)]
    pub rate: f32,
}

/// The largest product of displacement and width, in square logical pixels.
const MOST_MOVED: f32 = 8.0;

impl LineBoil {
    /// Lines that stand still.
    pub const STILL: Self = Self {
        amplitude: 0.0,
        wavelength: 60.0,
        rate: 12.0,
    };

    /// Whether lines are displaced.
    pub(crate) fn moves(&self) -> bool {
        self.amplitude > 0.0
    }

    /// The largest displacement of lines of which the widest has a width, both in logical
    /// pixels.
    fn limited(&self, widest: f32) -> f32 {
        self.amplitude.min(MOST_MOVED / widest.max(1.0))
    }

    /// The settings as shaders take them. `scale`: physical pixels per logical pixel;
    /// `widest`: width of the widest line in logical pixels.
    pub(crate) fn uniform(&self, scale: f32, seconds: f64, widest: f32) -> BoilUniform {
        BoilUniform {
            amplitude: self.limited(widest) * scale,
            wavelength: self.wavelength * scale,
            animation_seed: animation_seed(seconds, self.rate),
            unused: 0,
        }
    }
}

impl_sanitized!(LineBoil);

impl Default for LineBoil {
    fn default() -> Self {
        Self::STILL
    }
}

/// `Boil` of `boil.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BoilUniform {
    pub amplitude: f32,
    wavelength: f32,
    animation_seed: u32,
    unused: u32,
}
