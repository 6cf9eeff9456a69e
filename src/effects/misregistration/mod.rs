//! Prints the plates of the picture out of register.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    effect::{Effect, EffectContext, EffectShader, EffectStage, Needs, Variants},
    settings::FieldRange,
};

/// Prints the plates of cyan, magenta, yellow and black out of register: colors miss
/// their outlines by a hair, as in cheap print.
///
/// The colors of the picture are separated into four plates, each of which is moved. Lines
/// and areas of ink are drawn afterwards, in their places. Beside a
/// [`Halftone`](crate::Halftone), the moved colors are screened. What is brighter than
/// white is printed as white. The effect draws the picture in two passes.
///
/// Offsets are in logical pixels, to the right and down. Range of each component -32 to 32.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Misregistration {
    /// Offset of the cyan plate. Default: (0.8, 0.3).
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub cyan: Vec2,
    /// Offset of the magenta plate. Default: (-0.5, 0.6).
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub magenta: Vec2,
    /// Offset of the yellow plate. Default: (0.2, -0.7).
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub yellow: Vec2,
    /// Offset of the black plate. Default: none.
    #[reflect(@FieldRange::linear(-32.0, 32.0).unit("px"))]
    pub black: Vec2,
    /// Fraction of the darkness that cyan, magenta and yellow share which is in the black
    /// plate. Range 0 (grays have colored edges) to 1 (grays are moved as one), default 0.7.
    #[reflect(@FieldRange::FRACTION)]
    pub black_generation: f32,
    /// Largest additional random offset of the cyan, magenta and yellow plates, per axis, chosen
    /// anew for every page. The black plate does not drift: the others are aligned to it. Range 0
    /// to 8, default 0.
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

impl Default for Misregistration {
    fn default() -> Self {
        Self {
            cyan: Vec2::new(0.8, 0.3),
            magenta: Vec2::new(-0.5, 0.6),
            yellow: Vec2::new(0.2, -0.7),
            black: Vec2::ZERO,
            black_generation: 0.7,
            drift: 0.0,
            rate: 0.0,
            amount: 1.0,
        }
    }
}

impl Effect for Misregistration {
    const NAME: &'static str = "misregistration";
    const STAGE: EffectStage = EffectStage::Print;
    const SHADER: EffectShader = shader!("misregistration", "Misregistration");
    type Uniform = MisregistrationUniform;

    fades_by!(amount);

    fn needs(&self) -> Needs {
        Needs::PICTURE
    }

    fn variants(&self, _: &EffectContext, variants: &mut Variants) {
        variants.flag("BLACK_STAYS", self.black == Vec2::ZERO);
    }

    fn uniform(&self, view: &EffectContext) -> MisregistrationUniform {
        let scale = self.amount * view.scale_factor;
        let page = hash(view.cuts) ^ view.animation_seed(self.rate);
        let offset = |plate: u32, offset: Vec2| {
            let strays = Vec2::new(stray(page, 2 * plate), stray(page, 2 * plate + 1));
            scale * (offset + self.drift * strays)
        };
        MisregistrationUniform {
            cyan: offset(0, self.cyan),
            magenta: offset(1, self.magenta),
            yellow: offset(2, self.yellow),
            black: scale * self.black,
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

/// The uniform: `Misregistration` in `misregistration.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct MisregistrationUniform {
    cyan: Vec2,
    magenta: Vec2,
    yellow: Vec2,
    black: Vec2,
    black_generation: f32,
    unused: f32,
    unused_too: Vec2,
}
