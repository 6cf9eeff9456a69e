//! The range that the tones of a picture are brought to.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    depth::RangeSmoothing,
    settings::{BlendField, FieldRange},
};

/// Brings the tones of the picture into one range before effects divide them or shade by them, so
/// that a style fits any exposure: noon, a night, a cave.
///
/// The lightness that 5 % of the picture is darker than becomes 0.1, the lightness that 5 % is
/// lighter than becomes 0.9, and all others follow on a straight line. Colors keep their hues.
/// Lightness is the square root of the luminance of the unstyled picture, after tonemapping: what
/// tonemapping presses together, and what a picture of 8 bits cuts off, does not come apart again.
/// On an [`Hdr`](bevy::camera::Hdr) camera with `Tonemapping::None`, a scene has the same tones at
/// any exposure.
///
/// It applies while an effect of the camera divides tones or shades by them: [`ToneBands`],
/// [`ToneRamp`], [`TwoTone`], [`BlackFlats`] with a `value`, [`Halftone`], [`Hatching`] by the
/// picture, [`DepthLayers`] with `bands`. Otherwise it is left out, with the reason
/// [`NoToneStyle`]. While the strongest of these effects has a strength below 0.25, it fades with
/// that. All other effects read the picture in this range too. Objects with `NoStyle`,
/// [`StyleWeight`] and [`SplitView`] show the picture as it was.
///
/// A quarter of the pixels of the viewport are counted on the GPU. Both ends of the range are
/// smoothed over time as the visible range is: the state is one per camera, and starts anew after
/// a [`CameraCut`] and when the size of the view changes. Black pixels and those of opacity below 0.5 do not
/// count. Without compute shaders, it is left out.
///
/// [`ToneBands`]: crate::ToneBands
/// [`ToneRamp`]: crate::ToneRamp
/// [`TwoTone`]: crate::TwoTone
/// [`BlackFlats`]: crate::BlackFlats
/// [`Halftone`]: crate::Halftone
/// [`Hatching`]: crate::Hatching
/// [`DepthLayers`]: crate::DepthLayers
/// [`NoToneStyle`]: crate::diagnostics::SkipReason::NoToneStyle
/// [`StyleWeight`]: crate::StyleWeight
/// [`SplitView`]: crate::SplitView
/// [`CameraCut`]: crate::CameraCut
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ToneRange {
    /// Fraction of the pixels that are darker than the dark end of the picture's range, and fraction
    /// of those that are lighter than the light end. Range 0 to 0.2, default 0.05: percentiles 5 and 95.
    #[reflect(@FieldRange::linear(0.0, 0.2))]
    pub outliers: f32,
    /// Lightness that the dark end becomes. Range 0 to 0.4, default 0.1.
    #[reflect(@FieldRange::linear(0.0, 0.4))]
    pub dark: f32,
    /// Lightness that the light end becomes. Range 0.6 to 1, default 0.9.
    #[reflect(@FieldRange::linear(0.6, 1.0))]
    pub light: f32,
    /// Largest factor of lightness, so that noise and dither stay small. Range 1 to 32, default 8:
    /// light that is 6 stops too low.
    ///
    /// Where more would be needed, the picture has less contrast than `dark` to `light`: it moves no
    /// farther than into that range, so that a flat gray wall stays gray, and black stays black.
    #[reflect(@FieldRange::logarithmic(1.0, 32.0))]
    pub max_gain: f32,
    /// How both ends follow the picture; `None`: at once. Its octaves are stops, factors of two of
    /// light, and its `outliers` have no effect. Default: [`RangeSmoothing::default`].
    #[reflect(@BlendField::Fields)]
    pub smoothing: Option<RangeSmoothing>,
    /// Fraction of the change that is applied. Range 0 (the effect is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
}

impl Default for ToneRange {
    fn default() -> Self {
        Self {
            outliers: 0.05,
            dark: 0.1,
            light: 0.9,
            max_gain: 8.0,
            smoothing: Some(RangeSmoothing::default()),
            amount: 1.0,
        }
    }
}

/// Strength of the effects that divide tones from which on tones are wholly in their range.
const FULL: f32 = 0.25;

impl ToneRange {
    /// The same for effects that divide tones, of which the strongest has a strength from 0 to 1.
    /// Where these fade out, so does it.
    #[must_use]
    pub(crate) fn for_strength(self, strength: f32) -> Self {
        Self {
            amount: self.amount * (strength / FULL).min(1.0),
            ..self
        }
    }

    /// How both ends are found and followed.
    pub(super) fn followed(self) -> RangeSmoothing {
        RangeSmoothing {
            outliers: self.outliers,
            ..self.smoothing.unwrap_or(RangeSmoothing::OFF)
        }
    }

    /// The settings for shaders.
    pub(crate) fn packed(self) -> ToneRangeUniform {
        ToneRangeUniform {
            dark: self.dark,
            light: self.light,
            max_gain: self.max_gain,
            amount: self.amount,
        }
    }
}

/// `ToneRange` of `tones.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ToneRangeUniform {
    dark: f32,
    light: f32,
    max_gain: f32,
    amount: f32,
}
