//! The modes of [`Halftone`](super::Halftone).

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

/// Which plates a [`Halftone`](crate::Halftone) prints.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
#[repr(u32)]
pub enum HalftoneMode {
    /// Cyan, magenta, yellow and black.
    #[default]
    Cmyk = 0,
    /// One plate, in the black ink, by the darkness of the picture.
    Spot = 1,
    /// Two plates by the darkness of the picture: the cyan ink, which is solid where the
    /// picture is as dark as that ink, and from there on the black ink.
    Duotone = 2,
    /// Lights of red, green and blue on a black ground: a screen, not a print.
    Rgb = 3,
}

/// What a screen of a [`Halftone`](crate::Halftone) consists of.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
#[repr(u32)]
pub enum ScreenShape {
    /// Discs that grow until they overlap: Ben-Day dots.
    Round = 0,
    /// Discs in the lights, a checkerboard in the middle tones, holes in the shadows.
    #[default]
    Euclidean = 1,
    /// Lines that grow wider.
    Line = 2,
    /// Diamonds that touch at half the tone.
    Diamond = 3,
    /// Lines in two directions.
    Cross = 4,
    /// Square grains in an even, irregular distribution (blue noise; void and cluster,
    /// Ulichney 1993). Angles do not matter.
    Stochastic = 5,
}

/// Where a [`Halftone`](crate::Halftone) reads the tone of a dot.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ScreenSampling {
    /// At every pixel: dots are cut off at the edges of things, so details stay sharp.
    #[default]
    Pixel,
    /// At four places of the cell: dots are whole. Reads the picture four times for each
    /// plate, and draws it in two passes. [`ScreenShape::Stochastic`] reads pixels.
    Cell,
}

/// Where the screens of a [`Halftone`](crate::Halftone) are fixed.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ScreenAnchor {
    /// At the middle of the viewport: each view is a page.
    #[default]
    View,
    /// At the middle of the render target: in a split screen, the screens of all views are
    /// one.
    Window,
    /// At the objects with a [`PatternAnchor`](crate::objects::PatternAnchor): dots move, turn and
    /// grow with each of them. Elsewhere as [`ScreenAnchor::View`]. While there are such objects,
    /// object ids are drawn, which needs the crate's feature `objects`. Grains of
    /// [`ScreenShape::Stochastic`] move, but neither turn nor grow.
    Object,
}
