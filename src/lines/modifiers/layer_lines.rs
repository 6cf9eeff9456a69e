//! Lines of near, middle and far.

use bevy::{prelude::*, render::render_resource::ShaderType};

/// Lines have another width, opacity and color in near, middle and far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineLayers {
    /// Factors of the width of lines whose surface is near, in the middle, far: 0 to 1.
    pub widths: [f32; 3],
    /// The same of their opacity.
    pub opacities: [f32; 3],
    /// Colors of lines whose surface is near, in the middle, far.
    pub colors: [LinearRgba; 3],
    /// How much of the color of lines comes from `colors`: 0 to 1.
    pub color_amounts: [f32; 3],
    /// The depth map at the borders between near and middle, and between middle and far.
    pub borders: [f32; 2],
    /// The borders are those of [`Needs::DEPTH_BORDERS`](crate::effect::Needs::DEPTH_BORDERS), if
    /// any are known, which the effect must need.
    pub finds_borders: bool,
    /// A surface is where its object is, see
    /// [`Needs::OBJECT_DEPTHS`](crate::effect::Needs::OBJECT_DEPTHS), which the effect must need.
    pub by_objects: bool,
    /// Width of both borders in the depth map.
    pub softness: f32,
}

impl LineLayers {
    /// Whether lines have colors of their own somewhere.
    pub(crate) fn has_colors(&self) -> bool {
        self.color_amounts != [0.0; 3]
    }

    /// As shaders take it.
    pub(crate) fn uniform(self) -> LineLayersUniform {
        let ink = |layer: usize| {
            let LinearRgba {
                red, green, blue, ..
            } = self.colors[layer];
            let amount = self.color_amounts[layer];
            (Vec3::new(red, green, blue) * amount).extend(amount)
        };
        LineLayersUniform {
            near_ink: ink(0),
            middle_ink: ink(1),
            far_ink: ink(2),
            widths: Vec3::from(self.widths),
            softness: self.softness,
            opacities: Vec3::from(self.opacities),
            by_objects: f32::from(u8::from(self.by_objects)),
            borders: Vec2::from(self.borders),
            unused_pair: Vec2::ZERO,
        }
    }
}

/// `LineLayers` of `layer_lines.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LineLayersUniform {
    near_ink: Vec4,
    middle_ink: Vec4,
    far_ink: Vec4,
    widths: Vec3,
    softness: f32,
    opacities: Vec3,
    by_objects: f32,
    borders: Vec2,
    unused_pair: Vec2,
}
