//! How convex and concave creases are drawn.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::settings::{
    Blend, BlendField, FieldRange, NotFinite, blend_fields, color_serde, impl_sanitized, linear_rgb,
};

/// How convex or concave creases are drawn: [`Creases::convex`] or [`Creases::concave`]. The
/// default is a highlight: the color of the surface, lightened.
///
/// An edge is convex where the surface bends away from the camera, as at the edges of a box, and
/// where a part stands in front of another one. It is concave where the surface bends towards the
/// camera, as in the corners of a room; lines in flat surfaces count as concave. Which of the two
/// an edge is follows from the depths of two pixels on either side, so both faces must be at least
/// 2 pixels wide. Needs compute shaders: other devices draw all creases alike, and so do the
/// faithful equations. A crease that is also an edge between two objects is neither convex nor
/// concave: it is drawn as an object edge, or like the other creases.
///
/// [`Creases::convex`]: crate::lines::Creases::convex
/// [`Creases::concave`]: crate::lines::Creases::concave
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EdgeStyle {
    /// Color of the lines. Default: [`EdgeColor::HIGHLIGHT`].
    #[reflect(@BlendField::Fields)]
    pub color: EdgeColor,
    /// Width of the lines, as a multiple of the others'. Range 0 to 4, default 1.
    #[reflect(@FieldRange::linear(0.0, 4.0), @NotFinite(1.0))]
    pub width: f32,
    /// Opacity of the lines, as a fraction of the other creases'. Range 0 (no lines) to 1, default 1.
    #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
    pub opacity: f32,
    /// The fraction of the opacity that is left where neither side of the edge faces the light, which is
    /// the [`KeyLight`](crate::KeyLight), else the brightest directional light, else one from
    /// above. Cast shadows do not count. Below 1, the normal prepass is added to the camera.
    /// Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
    pub unlit_opacity: f32,
}

impl EdgeStyle {
    /// The default.
    pub const HIGHLIGHT: Self = Self {
        color: EdgeColor::HIGHLIGHT,
        width: 1.0,
        opacity: 1.0,
        unlit_opacity: 1.0,
    };

    fn uniform(&self) -> EdgeUniform {
        let (color, source, lighten, saturate) = match self.color {
            EdgeColor::Ink { color } => (linear_rgb(color), INK, 0.0, 1.0),
            EdgeColor::Surface { lighten, saturate } => (Vec3::ZERO, SURFACE, lighten, saturate),
        };
        EdgeUniform {
            color,
            source,
            lighten,
            saturate,
            width: self.width,
            opacity: self.opacity,
            unlit_opacity: self.unlit_opacity,
            unused: Vec3::ZERO,
        }
    }

    /// Between two styles; without one, creases have a color in full.
    pub(super) fn between(
        a: Option<Self>,
        b: Option<Self>,
        colors: [Color; 2],
        t: f32,
    ) -> Option<Self> {
        let plain = |color| Self {
            color: EdgeColor::Ink { color },
            ..Self::HIGHLIGHT
        };
        let [from, to] = colors.map(plain);
        a.or(b)?;
        Self::blend(Some(a.unwrap_or(from)), Some(b.unwrap_or(to)), t)
    }
}

impl_sanitized!(EdgeStyle, EdgeColor);

impl Default for EdgeStyle {
    fn default() -> Self {
        Self::HIGHLIGHT
    }
}

impl Blend for EdgeStyle {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        blend_fields(self, other, t)
    }
}

/// Where the color of convex or concave creases comes from. Objects whose `OutlineStyle` has a color
/// keep that.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
pub enum EdgeColor {
    /// A color of their own.
    Ink {
        /// The color, clamped to what a display shows; its alpha is not used.
        #[serde(with = "color_serde")]
        color: Color,
    },
    /// The surface that the line belongs to, after the effects that change colors. So it is darker
    /// in shadow, whatever casts it. In multisampled views, a few pixels of slanted lines mix in what
    /// lies behind.
    Surface {
        /// How much lighter the line is than the surface, in Oklab: 1 is as light as white, with half
        /// of the chroma; -1 is black. Range -1 to 1, 0.35 if it is not finite.
        #[reflect(@FieldRange::linear(-1.0, 1.0), @NotFinite(0.35))]
        lighten: f32,
        /// Factor of the chroma in Oklab. Range 0 (gray) to 2, 1 if it is not finite.
        #[reflect(@FieldRange::linear(0.0, 2.0), @NotFinite(1.0))]
        saturate: f32,
    },
}

impl EdgeColor {
    /// The surface, lighter: the default.
    pub const HIGHLIGHT: Self = Self::Surface {
        lighten: 0.35,
        saturate: 1.0,
    };

    /// Whether the color depends on the surface below.
    pub(crate) fn is_surface(self) -> bool {
        matches!(self, Self::Surface { .. })
    }
}

impl Default for EdgeColor {
    fn default() -> Self {
        Self::HIGHLIGHT
    }
}

/// Values of `EdgeUniform::source`.
const OTHERS: u32 = 0;
const INK: u32 = 1;
const SURFACE: u32 = 2;

/// `EdgeInk` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EdgeUniform {
    color: Vec3,
    source: u32,
    lighten: f32,
    saturate: f32,
    width: f32,
    opacity: f32,
    unlit_opacity: f32,
    unused: Vec3,
}

impl EdgeUniform {
    /// Without a style, lines are like the others.
    pub fn new(style: Option<EdgeStyle>) -> Self {
        let others = || Self {
            source: OTHERS,
            ..EdgeStyle::HIGHLIGHT.uniform()
        };
        style.map_or_else(others, |style| style.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creases without a style of their own are drawn in full, not left out.
    #[test]
    fn a_style_comes_and_goes_without_a_jump() {
        let style = Some(EdgeStyle::HIGHLIGHT);
        let colors = [Color::srgb(0.1, 0.2, 0.3), Color::BLACK];
        let at = |a, b, t| EdgeStyle::between(a, b, colors, t).expect("a style");
        let color = |color| EdgeColor::Ink { color };
        let first = at(None, style, 0.0);
        assert_eq!((first.color, first.opacity), (color(colors[0]), 1.0));
        assert!(at(None, style, 0.49).opacity < 0.1 && at(None, style, 0.51).opacity < 0.1);
        assert_eq!(at(None, style, 1.0), EdgeStyle::HIGHLIGHT);
        let last = at(style, None, 1.0);
        assert_eq!((last.color, last.opacity), (color(colors[1]), 1.0));
        assert_eq!(EdgeStyle::between(None, None, colors, 0.5), None);
    }
}
