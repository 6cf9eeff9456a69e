//! Fewer and fainter lines where the picture is simpler.

use bevy::{math::Vec2, render::render_resource::ShaderType};

/// How lines are simplified by the depth map: from 0 (not at all) to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSimplification {
    /// Simplification at the near end of the depth map, at its far end, and the exponent of the
    /// depth map between them.
    pub at_near: f32,
    /// See `at_near`.
    pub at_far: f32,
    /// See `at_near`.
    pub exponent: f32,
    /// How many times as strong an edge must be at full simplification to have a line: 1 or more.
    pub threshold: f32,
    /// Factor of the opacity of creases at full simplification.
    pub crease_opacity: f32,
    /// Lines of an object follow its center and its
    /// [`ObjectSimplification`](crate::objects::ObjectSimplification), see
    /// [`Needs::OBJECT_DEPTHS`](crate::effect::Needs::OBJECT_DEPTHS), which the effect must need.
    pub by_objects: bool,
}

impl LineSimplification {
    /// As shaders take it.
    pub(crate) fn uniform(self) -> LineSimplificationUniform {
        LineSimplificationUniform {
            at_near: self.at_near,
            at_far: self.at_far,
            exponent: self.exponent,
            threshold: self.threshold.max(1.0),
            crease_opacity: self.crease_opacity,
            by_objects: f32::from(u8::from(self.by_objects)),
            unused_pair: Vec2::ZERO,
        }
    }
}

/// `LineSimplification` of `simplification.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LineSimplificationUniform {
    at_near: f32,
    at_far: f32,
    exponent: f32,
    threshold: f32,
    crease_opacity: f32,
    by_objects: f32,
    unused_pair: Vec2,
}
