//! Draws lines of equal depth, height or distance (Saito and Takahashi 1990).

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::{BlendField, FieldRange, clamp_fields, clamp_or_default, color_serde, linear_rgb},
};

/// Draws lines of equal depth, height or distance over all surfaces: the contour lines of a
/// map, the rings of a sonar (Saito and Takahashi 1990).
///
/// Lines fade out where they are closer than 4 physical pixels, and where they would be more than
/// 500 pixels apart, so a floor at exactly the height of a line is not filled with ink, within the
/// precision of depth (a few ten-millionths of the distance). They lie on the geometry of the depth
/// prepass; in multisampled views, on that of the first sample. Under temporal anti-aliasing they
/// shake by up to half a pixel.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct IsoLines {
    /// What is equal along a line. Default: [`IsoField::Height`].
    pub field: IsoField,
    /// Difference of two neighboring lines: world units, or a fraction of the depth map's
    /// range. Range 0.001 to 1000, default 0.5.
    #[reflect(@FieldRange::logarithmic(1e-3, 1e3))]
    pub step: f32,
    /// The point that [`IsoField::Distance`] is measured from, in world units, from the true origin
    /// ([`WorldOrigin`](crate::cameras::WorldOrigin)). Components are clamped to -1e6 to 1e6.
    /// Default: the origin.
    pub center: Vec3,
    /// Width of a line in logical pixels. Range 0.5 to 16, default 1.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Every so many lines, one is heavier, counted from the line of value 0. Range 0 (none) to 20,
    /// default 5.
    #[reflect(@FieldRange::linear(0.0, 20.0), @BlendField::Switch)]
    pub major: u32,
    /// Width of the heavier lines in logical pixels. Range 0.5 to 16, default 2.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub major_width: f32,
    /// Color of the lines. Default: black. Components are clamped to what a display shows;
    /// alpha is ignored.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the lines. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

/// What is equal along a line of [`IsoLines`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum IsoField {
    /// The depth map.
    Depth,
    /// The height above the world's true origin: y.
    #[default]
    Height,
    /// The distance from [`IsoLines::center`].
    Distance,
}

impl Default for IsoLines {
    fn default() -> Self {
        Self {
            field: IsoField::Height,
            step: 0.5,
            center: Vec3::ZERO,
            width: 1.0,
            major: 5,
            major_width: 2.0,
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

impl Effect for IsoLines {
    const NAME: &'static str = "iso_lines";
    const STAGE: EffectStage = EffectStage::Ink;
    const SHADER: EffectShader = shader!("iso_lines", "IsoLines");
    type Uniform = IsoLinesUniform;

    fn sanitized(self) -> Self {
        let component = |value| clamp_or_default(value, 0.0, -1e6, 1e6);
        Self {
            center: Vec3::from(self.center.to_array().map(component)),
            ..clamp_fields(self)
        }
    }

    fades_by!(opacity);

    fn needs(&self) -> Needs {
        match self.field {
            IsoField::Depth => Needs::MAP | Needs::DEPTH,
            IsoField::Height => Needs::DEPTH,
            IsoField::Distance => Needs::DEPTH | Needs::WORLD_ORIGIN,
        }
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.number("FIELD", self.field as u32);
    }

    fn uniform(&self, view: &EffectContext) -> IsoLinesUniform {
        let half = |width: f32| 0.5 * width * view.scale_factor;
        let arm = view.world_origin + view.eye.as_dvec3() - self.center.as_dvec3();
        let offset = match self.field {
            IsoField::Depth => 0.0,
            IsoField::Height => view.world_origin.y,
            IsoField::Distance => arm.length(),
        };
        // After so much, the lines are the same.
        let cycle = f64::from(self.step) * f64::from(self.major.max(1));
        IsoLinesUniform {
            world_from_clip: view.world_from_clip,
            color: linear_rgb(self.color),
            opacity: self.opacity,
            center: self.center,
            step: self.step,
            half_width: half(self.width),
            major_half_width: half(self.major_width),
            major: self.major as i32,
            field: self.field as u32,
            eye: view.eye,
            offset: offset.rem_euclid(cycle) as f32,
            arm: arm.as_vec3(),
        }
    }
}

/// The uniform: `IsoLines` in `iso_lines.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct IsoLinesUniform {
    world_from_clip: Mat4,
    color: Vec3,
    opacity: f32,
    center: Vec3,
    step: f32,
    half_width: f32,
    major_half_width: f32,
    major: i32,
    field: u32,
    eye: Vec3,
    offset: f32,
    arm: Vec3,
}
