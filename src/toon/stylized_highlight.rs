//! Highlights in stylized shapes.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, impl_sanitized};

/// Draws the highlight of the brightest light in a stylized shape: a window, a star, a pair of dots
/// (Anjyo and Hiramitsu 2003).
///
/// Shapes keep their form on curved surfaces, move with light and view, and have an anti-aliased
/// edge. Their size is that of the plain highlight, which the roughness of the material and
/// [`highlight_edge`](crate::ToonLight::highlight_edge) give. All other lights draw plain
/// highlights, and so does the brightest one where the second has at least 0.9 of its brightness.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StylizedHighlight {
    /// What is drawn. Default: [`HighlightShape::Disc`].
    pub shape: HighlightShape,
    /// The direction that is up for the shape. Default: [`HighlightFrame::View`].
    pub frame: HighlightFrame,
    /// Multiple of the radius of the plain highlight. Range 0.1 to 8, default 1.
    #[reflect(@FieldRange::logarithmic(0.1, 8.0))]
    pub size: f32,
    /// Where the shape is, in radii of the plain highlight. Range -8 to 8, default 0. It stays
    /// within 63 degrees (a tangent of 2) of the plain highlight.
    #[reflect(@FieldRange::linear(-8.0, 8.0))]
    pub offset: Vec2,
    /// Degrees, counter-clockwise. Range -360 to 360, default 0.
    #[reflect(@FieldRange::linear(-360.0, 360.0).unit("°"))]
    pub rotation: f32,
    /// Length along both axes. Range 0.1 to 10, default 1.
    #[reflect(@FieldRange::logarithmic(0.1, 10.0))]
    pub scale: Vec2,
    /// Divides the shape in two along an axis, or in four along both: the distance of each from
    /// the middle, in its radii. Range 0 to 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0))]
    pub split: Vec2,
    /// How square the corners of the disc, the square, the window and the faithful shape are, from
    /// 0 (round). Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub square: f32,
    /// Width of the bars of a window and of a streak, half the thickness of a crescent, and inner
    /// radius of a star, in radii of the shape. Range 0.02 to 1, default 0.25.
    #[reflect(@FieldRange::linear(0.02, 1.0))]
    pub bar: f32,
    /// Points of a star. Range 3 to 12, default 4.
    #[reflect(@FieldRange::linear(3.0, 12.0))]
    pub points: u32,
    /// How sharp the corners of the faithful shape are. Range 1 to 10, default 2.
    #[reflect(@FieldRange::linear(1.0, 10.0))]
    pub sharpness: u32,
    /// Width of the edge in physical pixels. Range 0 to 8, default 1, which is anti-aliased.
    #[reflect(@FieldRange::linear(0.0, 8.0).unit("physical px"))]
    pub softness: f32,
}

/// The shape of a [`StylizedHighlight`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HighlightShape {
    /// A disc.
    #[default]
    Disc,
    /// A square with round corners.
    Square,
    /// A square with two bars across.
    Window,
    /// A crescent, open to the right.
    Crescent,
    /// A star, with one point upwards.
    Star,
    /// A bar with round ends.
    Streak,
    /// The paper's equations: the half vector is scaled, turned, moved, split and squared, one
    /// after the other. Shapes are discs that this deforms. With much `square`, the formula also
    /// lights bands far away from the highlight.
    Faithful,
}

/// The direction that is up for a [`StylizedHighlight`].
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HighlightFrame {
    /// The picture.
    #[default]
    View,
    /// The direction of the light, which is to the right.
    Light,
    /// The tangents of the mesh, so that it turns with the object. On meshes without tangents it is
    /// [`View`](Self::View).
    Tangent,
    /// The horizon of the world.
    World,
}

impl Default for StylizedHighlight {
    fn default() -> Self {
        Self {
            shape: HighlightShape::default(),
            frame: HighlightFrame::default(),
            size: 1.0,
            offset: Vec2::ZERO,
            rotation: 0.0,
            scale: Vec2::ONE,
            split: Vec2::ZERO,
            square: 0.0,
            bar: 0.25,
            points: 4,
            sharpness: 2,
            softness: 1.0,
        }
    }
}

impl_sanitized!(StylizedHighlight);

impl HighlightFrame {
    pub(super) fn definition(self) -> &'static str {
        match self {
            Self::View => "STYLIZED_HIGHLIGHT_VIEW",
            Self::Light => "STYLIZED_HIGHLIGHT_LIGHT",
            Self::Tangent => "STYLIZED_HIGHLIGHT_TANGENT",
            Self::World => "STYLIZED_HIGHLIGHT_WORLD",
        }
    }
}

/// `StylizedHighlight` in `stylized_highlight.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StylizedHighlightUniform {
    offset: Vec2,
    scale: Vec2,
    split: Vec2,
    turn: Vec2,
    size: f32,
    square: f32,
    bar: f32,
    softness: f32,
    points: f32,
    sharpness: f32,
    shape: u32,
}

impl From<&StylizedHighlight> for StylizedHighlightUniform {
    fn from(stylized_highlight: &StylizedHighlight) -> Self {
        let stylized_highlight = stylized_highlight.sanitized();
        Self {
            offset: stylized_highlight.offset,
            scale: stylized_highlight.scale,
            split: stylized_highlight.split,
            turn: Vec2::from_angle(stylized_highlight.rotation.to_radians()),
            size: stylized_highlight.size,
            square: stylized_highlight.square,
            bar: stylized_highlight.bar,
            softness: stylized_highlight.softness,
            points: stylized_highlight.points as f32,
            sharpness: stylized_highlight.sharpness as f32,
            shape: stylized_highlight.shape as u32,
        }
    }
}
