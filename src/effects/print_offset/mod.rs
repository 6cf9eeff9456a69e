//! Prints the plates of the picture out of register.

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec2,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Needs, ViewFacts},
    settings::{FieldRange, bounded},
};

/// Prints the plates of cyan, magenta, yellow and black out of register: colours miss
/// their outlines by a hair, as in cheap print.
///
/// The colours of the picture are separated into four plates, each of which is moved. Lines
/// and areas of ink are drawn afterwards, in their places. Beside a
/// [`Halftone`](crate::Halftone), the moved colours are screened. What is brighter than
/// white is printed as white. The effect draws the picture in two passes.
///
/// Offsets are in logical pixels, to the right and down. The range of each is -32 to 32.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PrintOffset {
    /// How far the cyan plate is to the right. Default: 0.8.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub cyan_x: f32,
    /// How far the cyan plate is down. Default: 0.3.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub cyan_y: f32,
    /// How far the magenta plate is to the right. Default: -0.5.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub magenta_x: f32,
    /// How far the magenta plate is down. Default: 0.6.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub magenta_y: f32,
    /// How far the yellow plate is to the right. Default: 0.2.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub yellow_x: f32,
    /// How far the yellow plate is down. Default: -0.7.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub yellow_y: f32,
    /// How far the black plate is to the right. Default: 0.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub black_x: f32,
    /// How far the black plate is down. Default: 0.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub black_y: f32,
    /// Fraction of the darkness that cyan, magenta and yellow share which is in the black
    /// plate. Range 0 (greys have coloured edges) to 1 (greys are moved as one), default 0.7.
    #[reflect(@FieldRange::FRACTION)]
    pub black_generation: f32,
    /// Factor of all offsets. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

impl Default for PrintOffset {
    fn default() -> Self {
        Self {
            cyan_x: 0.8,
            cyan_y: 0.3,
            magenta_x: -0.5,
            magenta_y: 0.6,
            yellow_x: 0.2,
            yellow_y: -0.7,
            black_x: 0.0,
            black_y: 0.0,
            black_generation: 0.7,
            amount: 1.0,
        }
    }
}

impl Effect for PrintOffset {
    const NAME: &'static str = "print_offset";
    const STAGE: EffectStage = EffectStage::Print;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::print_offset",
        source: include_str!("print_offset.wgsl"),
        settings: Some("PrintOffset"),
    };
    type Uniform = PrintOffsetUniform;

    fn sanitized(self) -> Self {
        let default = Self::default();
        let offset = |value, default| bounded(value, default, -32.0, 32.0);
        let fraction = |value, default| bounded(value, default, 0.0, 1.0);
        Self {
            cyan_x: offset(self.cyan_x, default.cyan_x),
            cyan_y: offset(self.cyan_y, default.cyan_y),
            magenta_x: offset(self.magenta_x, default.magenta_x),
            magenta_y: offset(self.magenta_y, default.magenta_y),
            yellow_x: offset(self.yellow_x, default.yellow_x),
            yellow_y: offset(self.yellow_y, default.yellow_y),
            black_x: offset(self.black_x, default.black_x),
            black_y: offset(self.black_y, default.black_y),
            black_generation: fraction(self.black_generation, default.black_generation),
            amount: fraction(self.amount, default.amount),
        }
    }

    fn strength(&self) -> f32 {
        self.amount
    }

    fn faded(self, fraction: f32) -> Self {
        let amount = self.amount * fraction;
        Self { amount, ..self }
    }

    fn needs(&self) -> Needs {
        Needs::PICTURE
    }

    fn uniform(&self, view: &ViewFacts) -> PrintOffsetUniform {
        let scale = self.amount * view.scale_factor;
        let offset = |x, y| scale * Vec2::new(x, y);
        PrintOffsetUniform {
            cyan: offset(self.cyan_x, self.cyan_y),
            magenta: offset(self.magenta_x, self.magenta_y),
            yellow: offset(self.yellow_x, self.yellow_y),
            black: offset(self.black_x, self.black_y),
            black_generation: self.black_generation,
            unused: 0.0,
            unused_too: Vec2::ZERO,
        }
    }
}

/// The uniform: `PrintOffset` in `print_offset.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct PrintOffsetUniform {
    cyan: Vec2,
    magenta: Vec2,
    yellow: Vec2,
    black: Vec2,
    black_generation: f32,
    unused: f32,
    unused_too: Vec2,
}
