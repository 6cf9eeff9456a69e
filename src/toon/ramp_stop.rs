//! Where a tone of a ramp begins.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, color_serde};

/// Where a tone of a [`Ramp`](super::Ramp) begins.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RampStop {
    /// How much light arrives where the tone begins: the middle of the edge. The tone of the
    /// lowest stop has no edge. Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub at: f32,
    /// Color of the tone. Components are clamped to what a display shows; alpha is ignored.
    /// Default: white.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Width of the edge, as a fraction of the whole light. 0: as hard as pixels allow. Range
    /// 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
}

impl Default for RampStop {
    fn default() -> Self {
        Self {
            at: 0.0,
            color: Color::WHITE,
            softness: 0.0,
        }
    }
}

impl RampStop {
    /// A tone with a hard edge.
    #[must_use]
    pub fn new(at: f32, color: impl Into<Color>) -> Self {
        Self {
            at,
            color: color.into(),
            softness: 0.0,
        }
    }

    /// The same with a soft edge.
    #[must_use]
    pub fn soft(self, softness: f32) -> Self {
        Self { softness, ..self }
    }
}
