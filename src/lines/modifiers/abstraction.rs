//! Fewer and fainter lines where the picture is abstract.

use bevy::render::render_resource::ShaderType;

/// How lines follow the abstraction of a view: 0 (all detail) to 1, by the depth map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineAbstraction {
    /// Abstraction at the near end of the depth map, at its far end, and the exponent of the depth
    /// map between them.
    pub at_near: f32,
    /// See `at_near`.
    pub at_far: f32,
    /// See `at_near`.
    pub exponent: f32,
    /// How many times as strong an edge must be at full abstraction to have a line: 1 or more.
    pub threshold: f32,
    /// Factor of the opacity of creases at full abstraction.
    pub crease_opacity: f32,
    /// Lines of an object follow its centre and its
    /// [`ObjectAbstraction`](crate::objects::ObjectAbstraction), see
    /// [`Needs::OBJECT_DEPTHS`](crate::effect::Needs::OBJECT_DEPTHS), which the effect must need.
    pub by_objects: bool,
}

impl LineAbstraction {
    /// As shaders take it.
    /// `flip`: near and far are exchanged.
    pub(crate) fn uniform(self, flip: bool) -> LineAbstractionUniform {
        LineAbstractionUniform {
            at_near: self.at_near,
            at_far: self.at_far,
            exponent: self.exponent,
            threshold: self.threshold.max(1.0),
            crease_opacity: self.crease_opacity,
            by_objects: f32::from(u8::from(self.by_objects)),
            flip: f32::from(u8::from(flip)),
            unused: 0.0,
        }
    }
}

/// `LineAbstraction` of `abstraction.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LineAbstractionUniform {
    at_near: f32,
    at_far: f32,
    exponent: f32,
    threshold: f32,
    crease_opacity: f32,
    by_objects: f32,
    flip: f32,
    unused: f32,
}
