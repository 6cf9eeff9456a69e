//! How lines fade into the engine's distance fog.

use bevy::{
    math::{Mat4, Vec2, Vec3, Vec4},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::depth::{ProjectionKind, frame::DepthProjection};

/// What happens to lines in the engine's `DistanceFog`, if the camera has it.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum LineFog {
    /// Nothing: lines are as strong in the fog as elsewhere.
    Ignore,
    /// They fade by the fog in front of the surface that they belong to. Needs compute
    /// shaders; other fog (volumetric, or drawn by materials of the game) is not known.
    #[default]
    Fade,
}

/// The distance fog of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ViewFog {
    /// 0: linear, 1: exponential, 2: exponential squared, 3: atmospheric.
    pub falloff: u32,
    /// Linear: start and end; exponential: density; atmospheric: extinction by channel.
    pub numbers: Vec3,
    /// Opacity of its colour.
    pub most: f32,
}

impl ViewFog {
    /// The fog as shaders take it.
    pub fn uniform(&self, projection: &DepthProjection, clip_from_view: &Mat4) -> FogUniform {
        let m = clip_from_view;
        let orthographic = projection.kind() == ProjectionKind::Orthographic;
        let shift = if orthographic {
            -Vec2::new(m.w_axis.x, m.w_axis.y)
        } else {
            Vec2::new(m.z_axis.x, m.z_axis.y)
        };
        let scale = Vec2::new(m.x_axis.x, m.y_axis.y).recip();
        let scale = if scale.is_finite() { scale } else { Vec2::ZERO };
        let shift = shift * scale;
        FogUniform {
            ray: Vec4::new(scale.x, scale.y, shift.x, shift.y),
            axis: projection.axis(),
            orthographic: u32::from(orthographic),
            falloff: self.falloff,
            numbers: self.numbers,
            most: self.most,
        }
    }
}

/// `Fog` of `fog.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FogUniform {
    ray: Vec4,
    axis: Vec2,
    orthographic: u32,
    falloff: u32,
    numbers: Vec3,
    most: f32,
}
