//! Prints the plates of the picture out of register.

use bevy::{
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec2,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectShader, EffectStage, Needs, Variants, ViewFacts},
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
    /// How far the plates of cyan, magenta and yellow stray besides, to each side and up or down:
    /// at random, anew for every page. Black is the plate that the others are laid to. Range 0 to
    /// 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0).unit("px"))]
    pub drift: f32,
    /// Pages per second. Range 0 (a new page at a [`CameraCut`](crate::CameraCut) alone) to 60,
    /// default 0. Plates stand still on a page.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"))]
    pub rate: f32,
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
            drift: 0.0,
            rate: 0.0,
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
            drift: bounded(self.drift, default.drift, 0.0, 8.0),
            rate: bounded(self.rate, default.rate, 0.0, 60.0),
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

    fn variants(&self, _: &ViewFacts, variants: &mut Variants) {
        variants.flag("BLACK_STAYS", self.black_x == 0.0 && self.black_y == 0.0);
    }

    fn uniform(&self, view: &ViewFacts) -> PrintOffsetUniform {
        let scale = self.amount * view.scale_factor;
        let page = hash(view.cuts) ^ view.drawing(self.rate);
        let offset = |plate: u32, x, y| {
            let strays = Vec2::new(stray(page, 2 * plate), stray(page, 2 * plate + 1));
            scale * (Vec2::new(x, y) + self.drift * strays)
        };
        PrintOffsetUniform {
            cyan: offset(0, self.cyan_x, self.cyan_y),
            magenta: offset(1, self.magenta_x, self.magenta_y),
            yellow: offset(2, self.yellow_x, self.yellow_y),
            black: scale * Vec2::new(self.black_x, self.black_y),
            black_generation: self.black_generation,
            unused: 0.0,
            unused_too: Vec2::ZERO,
        }
    }
}

/// The hash of `noise.wgsl`.
fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A random number from -1 to 1 for an axis of a plate on a page.
fn stray(page: u32, axis: u32) -> f32 {
    (hash(page ^ hash(axis)) >> 8) as f32 / (1 << 23) as f32 - 1.0
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
