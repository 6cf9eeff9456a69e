//! Defaults and clamps of [`Halftone`].

use bevy::color::Color;

use super::{Halftone, HalftoneMode, ScreenAnchor, ScreenSampling, ScreenShape};
use crate::settings::{bounded, displayable};

impl Default for Halftone {
    fn default() -> Self {
        Self {
            mode: HalftoneMode::Cmyk,
            shape: ScreenShape::Euclidean,
            period: 6.0,
            black_generation: 0.7,
            gain: 0.0,
            tints: 0,
            shadows: 0.0,
            highlights: 1.0,
            sampling: ScreenSampling::Pixel,
            near: 1.0,
            far: 1.0,
            below: 1.0,
            anchor: ScreenAnchor::View,
            cyan: Color::srgb_u8(0x00, 0xad, 0xef),
            magenta: Color::srgb_u8(0xed, 0x00, 0x8c),
            yellow: Color::srgb_u8(0xff, 0xf2, 0x00),
            black: Color::srgb_u8(0x21, 0x1f, 0x1e),
            paper: Color::srgb_u8(0xfd, 0xf9, 0xf0),
            cyan_angle: 15.0,
            magenta_angle: 75.0,
            yellow_angle: 0.0,
            black_angle: 45.0,
            opacity: 1.0,
        }
    }
}

impl Halftone {
    pub(super) fn clamped(self) -> Self {
        let default = Self::default();
        let fraction = |value, default| bounded(value, default, 0.0, 1.0);
        let angle = |value, default| bounded(value, default, -180.0, 180.0);
        Self {
            period: bounded(self.period, default.period, 2.5, 40.0),
            black_generation: fraction(self.black_generation, default.black_generation),
            gain: bounded(self.gain, default.gain, 0.0, 0.3),
            tints: self.tints.min(12),
            shadows: bounded(self.shadows, default.shadows, 0.0, 0.9),
            highlights: bounded(self.highlights, default.highlights, 0.1, 1.0),
            near: fraction(self.near, default.near),
            far: fraction(self.far, default.far),
            below: fraction(self.below, default.below),
            cyan: displayable(self.cyan, default.cyan),
            magenta: displayable(self.magenta, default.magenta),
            yellow: displayable(self.yellow, default.yellow),
            black: displayable(self.black, default.black),
            paper: displayable(self.paper, default.paper),
            cyan_angle: angle(self.cyan_angle, default.cyan_angle),
            magenta_angle: angle(self.magenta_angle, default.magenta_angle),
            yellow_angle: angle(self.yellow_angle, default.yellow_angle),
            black_angle: angle(self.black_angle, default.black_angle),
            opacity: fraction(self.opacity, default.opacity),
            ..self
        }
    }
}
