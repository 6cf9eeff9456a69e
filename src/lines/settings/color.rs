//! Where the color of lines comes from.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, NotFinite, impl_sanitized};

/// Where the color of lines comes from. Objects whose `OutlineStyle` has a color keep that.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
pub enum LineColor {
    /// The kinds of line have colors of their own: [`Silhouettes::color`] and the others.
    ///
    /// [`Silhouettes::color`]: crate::lines::Silhouettes::color
    #[default]
    Ink,
    /// The surface that a line belongs to, after the effects that change colors (a "color
    /// hold" of cel animation). Faithful lines take the color below them. In
    /// multisampled views, a few pixels of slanted lines mix in what lies behind.
    Surface {
        /// Factor of the luminance. Range 0 (black) to 1, 0.35 if it is not finite.
        #[reflect(@FieldRange::FRACTION, @NotFinite(0.35))]
        darken: f32,
        /// Factor of the distance from gray. Range 0 (gray) to 2, 1.2 if it is not finite.
        #[reflect(@FieldRange::linear(0.0, 2.0), @NotFinite(1.2))]
        saturate: f32,
    },
}

impl LineColor {
    /// A darker and more saturated version of the surface.
    pub const SURFACE: Self = Self::Surface {
        darken: 0.35,
        saturate: 1.2,
    };

    /// Whether lines have the color of surfaces.
    pub(crate) fn is_surface(self) -> bool {
        matches!(self, Self::Surface { .. })
    }

    /// The factors of luminance, negative for ink, and of the distance from gray.
    pub(crate) fn factors(self) -> [f32; 2] {
        match self {
            Self::Ink => [-1.0, 1.0],
            Self::Surface { darken, saturate } => [darken, saturate],
        }
    }
}

impl_sanitized!(LineColor);
