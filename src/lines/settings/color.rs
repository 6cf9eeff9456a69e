//! Where the colour of lines comes from.

use bevy::{
    math::FloatExt,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, clamp_or_default};

/// Where the colour of lines comes from. Objects whose `OutlineStyle` has a colour keep that.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
pub enum LineColor {
    /// The kinds of line have colours of their own: [`Silhouettes::color`] and the others.
    ///
    /// [`Silhouettes::color`]: crate::lines::Silhouettes::color
    #[default]
    Ink,
    /// The surface that a line belongs to, after the effects that change colours (a "colour
    /// hold" of cel animation). Faithful lines take the colour below them. In
    /// multisampled views, a few pixels of slanted lines mix in what lies behind.
    Surface {
        /// Factor of the luminance. Range 0 (black) to 1, 0.35 if it is not finite.
        #[reflect(@FieldRange::FRACTION)]
        darken: f32,
        /// Factor of the distance from grey. Range 0 (grey) to 2, 1.2 if it is not finite.
        #[reflect(@FieldRange::linear(0.0, 2.0))]
        saturate: f32,
    },
}

impl LineColor {
    /// A darker and more saturated version of the surface.
    pub const SURFACE: Self = Self::Surface {
        darken: 0.35,
        saturate: 1.2,
    };

    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        match self {
            Self::Ink => Self::Ink,
            Self::Surface { darken, saturate } => Self::Surface {
                darken: clamp_or_default(darken, 0.35, 0.0, 1.0),
                saturate: clamp_or_default(saturate, 1.2, 0.0, 2.0),
            },
        }
    }

    /// The settings between two, at `t` from 0 to 1. Between ink and surface, it changes at
    /// once, halfway.
    #[must_use]
    pub fn mixed(self, other: Self, t: f32) -> Self {
        match (self, other) {
            (
                Self::Surface { darken, saturate },
                Self::Surface {
                    darken: other_darken,
                    saturate: other_saturate,
                },
            ) => Self::Surface {
                darken: darken.lerp(other_darken, t),
                saturate: saturate.lerp(other_saturate, t),
            },
            _ if t < 0.5 => self,
            _ => other,
        }
    }

    /// Whether lines have the colour of surfaces.
    pub(crate) fn is_surface(self) -> bool {
        matches!(self, Self::Surface { .. })
    }

    /// The factors of luminance, negative for ink, and of the distance from grey.
    pub(crate) fn factors(self) -> [f32; 2] {
        match self {
            Self::Ink => [-1.0, 1.0],
            Self::Surface { darken, saturate } => [darken, saturate],
        }
    }
}
