//! What of the numbers is compiled into the fused pass.

use bevy::{math::Vec2, shader::ShaderDefVal};

use super::ComicsUniform;
use crate::outlining::GATHER_REACH;

/// The modes of the styles, which are compiled in: an adapter that runs on the
/// CPU executes both sides of a branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Modes {
    map: u32,
    desaturation: [u32; 2],
    colorization: [u32; 2],
    contours: [u32; 2],
    /// Contours that are a whole number of pixels wide on either side.
    whole_contours: bool,
    /// Those that one ring of taps draws.
    single_ring: bool,
    /// Contours that do not fade.
    steady_contours: bool,
    tone_bands: u32,
    /// How far around a pixel lines are looked for without a flood.
    reach: u32,
    /// A sketch that covers only a part of the picture.
    sketch_fades: bool,
    /// Something of the original is seen.
    finish: bool,
    /// A pixel of the depth is a pixel of the picture.
    same_size: bool,
}

impl Modes {
    pub fn of(uniform: &ComicsUniform) -> Self {
        let ComicsUniform {
            depth_scale,
            depth,
            desaturation,
            colorization,
            contours,
            tone_bands,
            outlines,
            sketch,
            finish,
            ..
        } = uniform;
        Self {
            map: depth.flags,
            desaturation: [desaturation.curve, desaturation.faithful],
            colorization: [colorization.mode, colorization.faithful],
            contours: [contours.operator_kind, contours.faithful],
            whole_contours: contours.radius.fract() == 0.0,
            single_ring: contours.radius == 1.0 || contours.radius == 2.0,
            steady_contours: contours.fade == 0.0,
            tone_bands: tone_bands.faithful,
            reach: outlines.reach.clamp(0, GATHER_REACH) as u32,
            sketch_fades: sketch.amount < 1.0,
            finish: finish.weight < 1.0 || finish.split > 0.0,
            same_size: *depth_scale == Vec2::ONE,
        }
    }

    pub fn shader_defs(self) -> impl Iterator<Item = ShaderDefVal> {
        let numbers = [
            ("MAP_FLAGS", self.map),
            ("DESATURATION_CURVE", self.desaturation[0]),
            ("DESATURATION_FAITHFUL", self.desaturation[1]),
            ("COLORIZATION_MODE", self.colorization[0]),
            ("COLORIZATION_FAITHFUL", self.colorization[1]),
            ("CONTOUR_OPERATOR", self.contours[0]),
            ("CONTOUR_FAITHFUL", self.contours[1]),
            ("TONE_BANDS_FAITHFUL", self.tone_bands),
            ("LINE_REACH", self.reach),
        ];
        let flags = [
            (true, "MODES"),
            (self.same_size, "SAME_SIZE"),
            (self.sketch_fades, "SKETCH_FADES"),
            (self.finish, "FINISH"),
            (self.whole_contours, "WHOLE_CONTOURS"),
            (self.single_ring, "SINGLE_RING"),
            (self.steady_contours, "STEADY_CONTOURS"),
        ];
        let flags = flags
            .into_iter()
            .filter(|(on, _)| *on)
            .map(|(_, name)| name.into());
        numbers
            .into_iter()
            .map(|(name, value)| ShaderDefVal::UInt(name.into(), value))
            .chain(flags)
    }
}
