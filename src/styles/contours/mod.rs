//! Lines where the depth map jumps (\[CS\] 3.2).

use bevy::{
    color::{Color, ColorToComponents},
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec3,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use super::{FieldRange, file_color};
use crate::sanitize::{bounded, displayable};

/// Draws a line wherever the depth map jumps: around objects, and between near
/// and far ones.
///
/// Contours see what the depth prepass sees: opaque and alpha-masked geometry.
/// A transparent surface is coloured, and outlined, by the depth behind it.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Contours {
    /// The detector. Default: [`ContourOperator::Prewitt`].
    pub operator: ContourOperator,
    /// What it detects. Default: [`ContourForm::PlaneAware`].
    pub form: ContourForm,
    /// The response at which a line is half drawn, in units of the depth map:
    /// in the plane-aware form 0.02 is a jump of 2 % of the visible range. The
    /// faithful form applies it to the raw kernels, which answer a straight
    /// jump of 0.02 with 0.06 (Prewitt, Laplace), 0.08 (Sobel) or 0.028
    /// (Roberts). Range 1e-6 to 100, default 0.02.
    #[reflect(@FieldRange::logarithmic(1e-6, 100.0))]
    pub threshold: f32,
    /// Width of a line in logical pixels, half on either side of the jump.
    /// Range 0.5 to 16, default 2.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// How gradually a line sets in around the threshold: 0 draws it hard, 1
    /// lets it grow from nothing to twice the threshold. Range 0 to 1,
    /// default 0.5.
    #[reflect(@FieldRange::SHARE)]
    pub softness: f32,
    /// Colour of the line. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the line. Range 0 (none, and the pass leaves the style out)
    /// to 1. Default 1.
    #[reflect(@FieldRange::SHARE)]
    pub opacity: f32,
    /// Share of the opacity that is lost at the far end of the depth map.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::SHARE)]
    pub fade: f32,
}

/// The edge detectors of the depth map.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash)]
pub enum ContourOperator {
    /// First differences of three rows and columns (\[CS\]): even lines.
    #[default]
    Prewitt,
    /// As Prewitt, the middle weighted double: a little crisper.
    Sobel,
    /// Second differences of all eight neighbours (\[CS\]): stresses corners and
    /// thin things.
    Laplace,
    /// Differences along the diagonals alone: lighter, more broken lines.
    Roberts,
}

/// What a contour is.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash)]
pub enum ContourForm {
    /// A departure from the plane through the pixel. Raw depth is affine over
    /// any plane, so no plane, however grazing, has a line of its own.
    #[default]
    PlaneAware,
    /// Any change of the depth map, slopes included, as the paper draws it.
    Faithful,
}

impl Default for Contours {
    fn default() -> Self {
        Self {
            operator: ContourOperator::default(),
            form: ContourForm::default(),
            threshold: 0.02,
            width: 2.0,
            softness: 0.5,
            color: Color::BLACK,
            opacity: 1.0,
            fade: 0.0,
        }
    }
}

impl Contours {
    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            threshold: bounded(self.threshold, default.threshold, 1e-6, 100.0),
            width: bounded(self.width, default.width, 0.5, 16.0),
            softness: bounded(self.softness, default.softness, 0.0, 1.0),
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
            fade: bounded(self.fade, default.fade, 0.0, 1.0),
            ..self
        }
    }

    pub(crate) fn is_negligible(&self) -> bool {
        self.opacity == 0.0
    }

    /// `scale` is physical pixels per logical pixel.
    pub(crate) fn uniform(&self, scale: f32) -> ContoursUniform {
        // smoothstep needs its ends apart: a hard line rises over a thousandth.
        let half_ramp = self.threshold * self.softness.max(1e-3);
        ContoursUniform {
            color: Vec3::from_array(self.color.to_linear().to_f32_array_no_alpha()),
            opacity: self.opacity,
            low: self.threshold - half_ramp,
            high: self.threshold + half_ramp,
            radius: (0.5 * self.width * scale).clamp(0.125, 64.0),
            fade: self.fade,
            operator_kind: match self.operator {
                ContourOperator::Prewitt => 0,
                ContourOperator::Sobel => 1,
                ContourOperator::Laplace => 2,
                ContourOperator::Roberts => 3,
            },
            faithful: u32::from(self.form == ContourForm::Faithful),
        }
    }
}

/// `Contours` of `contours.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ContoursUniform {
    color: Vec3,
    opacity: f32,
    low: f32,
    high: f32,
    pub(crate) radius: f32,
    pub(crate) fade: f32,
    pub(crate) operator_kind: u32,
    pub(crate) faithful: u32,
}
