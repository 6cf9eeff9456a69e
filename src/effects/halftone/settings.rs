//! Defaults and clamps of [`Halftone`].

use bevy::color::Color;

use super::{Halftone, HalftoneMode, ScreenAnchor, ScreenSampling, ScreenShape};

impl Default for Halftone {
    fn default() -> Self {
        Self {
            mode: HalftoneMode::Cmyk,
            shape: ScreenShape::Euclidean,
            cell_size: 6.0,
            black_generation: 0.7,
            gain: 0.0,
            tints: 0,
            solid_below: 0.0,
            bare_above: 1.0,
            sampling: ScreenSampling::Pixel,
            at_near: 1.0,
            at_far: 1.0,
            shadows_only_below: 1.0,
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

impl Halftone {}
