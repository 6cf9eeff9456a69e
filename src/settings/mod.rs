//! What all settings share: documented ranges, clamps, colours in files.

mod blend;
mod bounds;
mod field;
pub mod file_color;
mod form;
#[cfg(test)]
mod tests;

pub(crate) use blend::{Blend, dip};
pub use blend::{blend_color, blend_ratio};
pub(crate) use bounds::ordered_planes;
pub use bounds::{bounded, bounded_option, displayable};
pub use field::{BlendField, FieldRange, HueWheel};
pub use form::Form;

use bevy::{
    color::{Color, ColorToComponents},
    math::Vec3,
};

/// The linear components of a colour, without its alpha, as a shader takes them.
pub fn linear_rgb(color: Color) -> Vec3 {
    color.to_linear().to_vec3()
}
