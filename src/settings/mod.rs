//! What all settings have in common: ranges, clamps, blending, colors in files.

mod blend;
mod bounds;
mod clamp;
pub mod color_serde;
mod equations;
mod field;
mod parts;
#[cfg(test)]
pub(crate) mod tests;

pub(crate) use blend::{Blend, blend_fields, crossfade, crossfade_weight, mix_fields, same_modes};
pub use blend::{blend_color, blend_ratio};
pub use bounds::{clamp_color, clamp_option_or_default, clamp_or_default, clamp_vec2_or_default};
pub(crate) use clamp::{clamp_fields, impl_sanitized};
pub use equations::Equations;
pub(crate) use field::NotFinite;
pub use field::{BlendField, FieldRange, HueWheel};

use bevy::prelude::*;

/// Red, green and blue of a color in linear light, without alpha: as shaders take it.
pub fn linear_rgb(color: Color) -> Vec3 {
    color.to_linear().to_vec3()
}

/// Lightness, a and b of a color in `OKLab`, without alpha: as shaders take it.
pub fn oklab(color: Color) -> Vec3 {
    Oklaba::from(color).to_vec3()
}
