//! Lines of near, middle and far.

use bevy::{
    math::{Vec2, Vec3},
    render::render_resource::ShaderType,
};

/// Lines have another width and opacity in near, middle and far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePlanes {
    /// Factors of the width of lines whose surface is near, in the middle, far: 0 to 1.
    pub widths: [f32; 3],
    /// The same of their opacity.
    pub opacities: [f32; 3],
    /// The depth map at the borders between near and middle, and between middle and far.
    pub borders: [f32; 2],
    /// The borders are those of [`Needs::DEPTH_BORDERS`](crate::Needs::DEPTH_BORDERS), if any are
    /// known, which the effect must need.
    pub finds_borders: bool,
    /// A surface is where its object is, see
    /// [`Needs::OBJECT_DEPTHS`](crate::Needs::OBJECT_DEPTHS), which the effect must need.
    pub by_objects: bool,
    /// Width of both borders in the depth map.
    pub softness: f32,
}

impl LinePlanes {
    /// As shaders take it.
    pub(crate) fn uniform(self) -> LinePlanesUniform {
        LinePlanesUniform {
            widths: Vec3::from(self.widths),
            softness: self.softness,
            opacities: Vec3::from(self.opacities),
            unused: 0.0,
            borders: Vec2::from(self.borders),
            unused_pair: Vec2::ZERO,
        }
    }
}

/// `LinePlanes` of `plane_lines.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LinePlanesUniform {
    widths: Vec3,
    softness: f32,
    opacities: Vec3,
    unused: f32,
    borders: Vec2,
    unused_pair: Vec2,
}
