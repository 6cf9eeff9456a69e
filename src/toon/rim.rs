//! Light along the borders of things.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, NotFinite, color_serde, impl_sanitized, linear_rgb};

/// A rim of light along the edges of an object, as from a light behind it.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rim {
    /// How wide it is. Default: [`RimWidth::Facing`].
    pub width: RimWidth,
    /// The color of the rim before tonemapping, whatever the light is. Components are clamped to
    /// what a display shows; alpha is ignored. Default: white.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the rim over the surface. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub strength: f32,
    /// How far the rim is confined to the side of the brightest light: 0 is all around, 1 only that
    /// side. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub lit_side: f32,
}

/// How wide a [`Rim`] is.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum RimWidth {
    /// Where the surface turns away from the eye: wide on what is round. A flat face is all
    /// rim or none.
    Facing {
        /// The rim is where the cosine between normal and eye is below this. Range 0 to 1, default
        /// 0.35.
        #[reflect(@FieldRange::FRACTION)]
        fraction: f32,
        /// Width of its edge, in the same unit. Range 0 to 1, default 0, which is anti-aliased.
        #[reflect(@FieldRange::FRACTION)]
        softness: f32,
    },
    /// A constant width in physical pixels, or in page pixels on a camera with a
    /// [`PageHeight`](crate::style::PageHeight), along edges beyond which the next surface is at
    /// least 2 % farther away. It needs the depth prepass, which lines, for example, have; without
    /// it, and with OpenGL and WebGL 2, the rim is as [`Facing`](Self::Facing).
    Pixels(
        /// Width in physical or page pixels. Range 1 to 64, default 3.
        #[reflect(@FieldRange::linear(1.0, 64.0).unit("physical px"), @NotFinite(3.0))]
        f32,
    ),
}

impl Default for RimWidth {
    fn default() -> Self {
        Self::Facing {
            fraction: 0.35,
            softness: 0.0,
        }
    }
}

impl Default for Rim {
    fn default() -> Self {
        Self {
            width: RimWidth::default(),
            color: Color::WHITE,
            strength: 1.0,
            lit_side: 1.0,
        }
    }
}

impl_sanitized!(Rim);

/// `Rim` in `rim.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RimUniform {
    color: Vec3,
    strength: f32,
    begin: f32,
    softness: f32,
    pixels: f32,
    lit_side: f32,
}

impl From<&Rim> for RimUniform {
    fn from(rim: &Rim) -> Self {
        let rim = rim.sanitized();
        let (fraction, softness, pixels) = match rim.width {
            RimWidth::Facing { fraction, softness } => (fraction, softness, 0.0),
            // Without a depth prepass, the default.
            RimWidth::Pixels(pixels) => (0.35, 0.0, pixels),
        };
        Self {
            color: linear_rgb(rim.color),
            strength: rim.strength,
            begin: 1.0 - fraction,
            softness,
            pixels,
            lit_side: rim.lit_side,
        }
    }
}
