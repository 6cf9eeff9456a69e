//! What all settings have in common: ranges, clamps, blending, colours in files.

mod blend;
mod bounds;
mod field;
pub mod file_color;
mod form;
#[cfg(test)]
pub(crate) mod tests;

pub(crate) use blend::{Blend, dip};
pub use blend::{blend_color, blend_ratio};
pub(crate) use bounds::ordered_planes;
pub use bounds::{bounded, bounded_option, displayable};
pub use field::{BlendField, FieldRange, HueWheel};
pub use form::Form;

use bevy::{
    color::{Color, ColorToComponents, Oklaba},
    math::Vec3,
};

/// Red, green and blue of a colour in linear light, without alpha: as shaders take it.
pub fn linear_rgb(color: Color) -> Vec3 {
    color.to_linear().to_vec3()
}

/// Lightness, a and b of a colour in `OKLab`, without alpha: as shaders take it.
pub fn oklab(color: Color) -> Vec3 {
    Oklaba::from(color).to_vec3()
}
