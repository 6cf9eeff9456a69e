//! The settings of the three kinds of outline: silhouettes, creases, object edges.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::edges::EdgeStyle;
use crate::settings::{Blend, Equations, FieldRange, color_serde, impl_sanitized, mix_fields};

/// Outlines where a surface ends in front of another one or of the sky.
///
/// They are found in the raw depth buffer. Raw depth is affine over a plane on the
/// screen, so a plane has no silhouette inside of it, at any angle to the camera.
/// \[CL\] Eq. 1 and 2.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Silhouettes {
    /// How a jump in depth is measured, and how wide its line is.
    /// [`Equations::Corrected`] does not depend on the world's unit, the clipping planes
    /// or the camera's rotation, and draws a line of the given width along the edge.
    /// With [`Equations::Faithful`] the response depends on the near plane and the scale
    /// of the world, and the line is the four columns of pixels that respond.
    /// Default: [`Equations::Corrected`]. Faithful: \[CL\] Eq. 1 and 2 on the depth
    /// buffer.
    pub equations: Equations,
    /// Sets how large a jump in depth must be to draw a line; the lower, the more
    /// lines. Range 1e-6 to 1, default 0.02. At this jump the response is 1.
    ///
    /// Corrected: a fraction of the distance to the surface behind, or of 1.2 times
    /// the height of the view under an orthographic projection; useful values are
    /// 0.005 to 0.1. Faithful: the detection threshold `k_p` of \[CL\] Eq. 2, on a
    /// depth buffer of 0 to 1.
    #[reflect(@FieldRange::logarithmic(1e-6, 1.0))]
    pub threshold: f32,
    /// Sets how strong an edge must be to be inked; the higher, the fewer faint
    /// lines. It is the response at which a line has half of its ink. Range 0.01 to
    /// 0.99, default 0.5. The edge-limit-value of \[CL\].
    #[reflect(@FieldRange::linear(0.01, 0.99))]
    pub edge_limit: f32,
    /// Softness of the transition at `edge_limit`, as a fraction of the widest
    /// transition: 0 is a hard step; 1 lets the ink follow the response, which suits
    /// a sketch. Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Color of the line, clamped to what a display shows; its alpha is not used.
    /// Default: black.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the line. Range 0 (this kind of line is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

impl Silhouettes {
    pub(crate) const DEFAULT: Self = Self {
        equations: Equations::Corrected,
        threshold: 0.02,
        edge_limit: 0.5,
        softness: 0.5,
        color: Color::BLACK,
        opacity: 1.0,
    };

    /// `k` of Eq. 2. The corrected equations halve the threshold, because a straight edge
    /// of height h has `g_max - g_min = h / 2`.
    pub(crate) fn k(&self) -> f32 {
        match self.equations {
            Equations::Corrected => 0.5 * self.threshold,
            Equations::Faithful => self.threshold,
        }
    }
}

impl Default for Silhouettes {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Outlines where a surface bends sharply. The normal prepass is added to the camera if
/// they are found in it, see [`CreaseSource`]. Decaudin's creases, which \[CL\] leaves out.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Creases {
    /// How a crease is measured, and how wide its line is. [`Equations::Corrected`] uses
    /// the angle between the normals of its two sides and draws a line of the given
    /// width. With [`Equations::Faithful`] the response depends on the direction of the
    /// world's axes, and the line is the pixels that respond.
    /// Default: [`Equations::Corrected`]. Faithful: \[CL\] Eq. 1 and 2 on each component
    /// of the normal.
    pub equations: Equations,
    /// Where creases are found. Default: [`CreaseSource::Both`].
    pub source: CreaseSource,
    /// Sets how sharply a surface must bend to draw a line; the lower, the more
    /// lines. It is the angle between the normals of the two sides, in degrees, at
    /// which the response is 1. Range 3 to 180, default 40. Of normals only: at the edges of
    /// meshes it is 50 degrees, or that of their `MeshSections`. Faithful: `k_p` of
    /// \[CL\] Eq. 2 is the sine of half of the angle.
    #[reflect(@FieldRange::linear(3.0, 180.0).unit("°"))]
    pub angle: f32,
    /// Whether normals alone make creases, such as those of normal maps. Otherwise depth must bend
    /// there too. [`CreaseSource::Meshes`] and the faithful equations do not read it. Default: false.
    pub normal_maps: bool,
    /// Sets how strong an edge must be to be inked; the higher, the fewer faint
    /// lines. It is the response at which a line has half of its ink. Range 0.01 to
    /// 0.99, default 0.5. The edge-limit-value of \[CL\].
    #[reflect(@FieldRange::linear(0.01, 0.99))]
    pub edge_limit: f32,
    /// Softness of the transition at `edge_limit`, as in [`Silhouettes::softness`].
    /// Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Color of the line, clamped to what a display shows; its alpha is not used.
    /// Default: black.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the line. Range 0 (this kind of line is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
    /// How convex edges are drawn, such as those of a box: as a highlight, for instance. `None`:
    /// like the others, with `color` and [`LineColor`](crate::lines::LineColor). Default: `None`.
    pub convex: Option<EdgeStyle>,
    /// How concave edges are drawn, such as those in the corners of a room. `None`: like the others.
    /// Default: `None`.
    pub concave: Option<EdgeStyle>,
}

/// What creases are found by.
///
/// The edges of meshes are exact: lines along faces that are thinner than a pixel, such as those of
/// window frames, have no gaps. For them every mesh is divided once, in a background task (see
/// [`MeshTasks`](crate::objects::MeshTasks)), where two triangles bend by 50 degrees and the
/// normals of their common vertices differ by 15 degrees. Such an edge is a crease only where the
/// picture confirms it: where the surface bends by 10 degrees, or has a step in depth. Left out are
/// meshes that are skinned, morphed, transparent or alpha-masked, have more than a million
/// triangles, are mostly small parts, such as grass, or change again and again.
/// [`MeshSections`](crate::objects::MeshSections) divides single meshes without these rules, and
/// `MeshSections::NONE` leaves them out; a mesh with `ATTRIBUTE_MESH_SECTION` has the sections of
/// its author.
///
/// Meshes are divided on devices with `PRIMITIVE_INDEX`, which browsers do not have; on the others
/// every source is [`Normals`](Self::Normals). Faithful creases are found in normals only.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum CreaseSource {
    /// In the normals of pixels, where depth bends too (see [`Creases::normal_maps`]), and at the borders
    /// of the meshes with [`MeshSections`](crate::objects::MeshSections).
    Normals,
    /// At the edges of meshes. Normals are not read, so normal maps have no creases, and the camera
    /// needs no normal prepass, but for [`LineEdge::Hard`], which chooses its side by normals, and
    /// [`EdgeStyle::unlit_opacity`]. Meshes that are left out have no creases.
    Meshes,
    /// In the normals of pixels, and at the edges of meshes.
    #[default]
    Both,
}

impl Creases {
    pub(crate) const DEFAULT: Self = Self {
        equations: Equations::Corrected,
        source: CreaseSource::Both,
        angle: 40.0,
        normal_maps: false,
        edge_limit: 0.5,
        softness: 0.5,
        color: Color::BLACK,
        opacity: 1.0,
        convex: None,
        concave: None,
    };

    /// The styles of convex and concave edges, if they have any.
    pub(crate) fn edge_styles(&self) -> impl Iterator<Item = EdgeStyle> {
        let measured = self.equations == Equations::Corrected;
        let styles = [self.convex, self.concave].into_iter().flatten();
        styles.filter(move |_| measured)
    }

    /// `k_n = sin(angle / 2)`, and at least the noise of normals with 10 bits per
    /// component.
    pub(crate) fn k(&self) -> f32 {
        (0.5 * self.angle.to_radians()).sin().max(0.02)
    }
}

impl Default for Creases {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Outlines where two objects meet, even if depth and normal are the same there. An
/// object is a mesh entity, the primitives of one glTF node, or an `OutlineGroup`. Its id
/// is drawn in an additional pass.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectEdges {
    /// Color of the line, clamped to what a display shows; its alpha is not used.
    /// Default: black.
    #[serde(with = "color_serde")]
    pub color: Color,
    /// Opacity of the line. Range 0 (this kind of line is left out) to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

impl ObjectEdges {
    pub(crate) const DEFAULT: Self = Self {
        color: Color::BLACK,
        opacity: 1.0,
    };
}

impl Default for ObjectEdges {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What a line loses where an edge is weak.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum LineResponse {
    /// Ink: weak edges have faint lines of full width.
    Ink,
    /// Width: weak edges have thin lines of full ink, like those of a pen that is
    /// lifted. Lines thinner than 0.6 physical pixels are fainter instead.
    #[default]
    Width,
    /// Ink and width.
    Both,
}

impl LineResponse {
    /// Whether ink and width are lost, as 0 or 1.
    pub(crate) fn parts(self) -> [f32; 2] {
        match self {
            Self::Ink => [1.0, 0.0],
            Self::Width => [0.0, 1.0],
            Self::Both => [1.0, 1.0],
        }
    }
}

/// Which pixels a line inks.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
pub enum LineEdge {
    /// Those that it covers, each by the part that it covers.
    #[default]
    Smooth,
    /// Whole pixels, as in pixel art: rows of pixels along an edge, on the side of the surface in
    /// front, as many as the line is wide in whole physical pixels, at least 1. Where neither
    /// surface is in front, a line stays on one side all along. Such lines ignore `smooth` and
    /// `overshoot`, and are meant for `Msaa::Off`.
    Hard,
}

/// The responses at which ink begins and at which it is full. `weakest`: the response from
/// which lines continue, if they do.
pub(crate) fn ramp(limit: f32, softness: f32, weakest: Option<f32>) -> [f32; 2] {
    // smoothstep needs different ends: a hard step uses a softness of 0.001.
    let half = softness.max(1e-3) * limit.min(1.0 - limit);
    let low = limit - half;
    [low.min(weakest.unwrap_or(low)), limit + half]
}

impl_sanitized!(Silhouettes, Creases, ObjectEdges);

impl Blend for Silhouettes {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }
}

impl Blend for Creases {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn same_modes(&self, other: &Self) -> bool {
        let modes = |c: &Self| (c.equations, c.source, c.normal_maps);
        modes(self) == modes(other)
    }

    fn mixed(&self, other: &Self, t: f32) -> Self {
        let colors = [self.color, other.color];
        Self {
            convex: EdgeStyle::between(self.convex, other.convex, colors, t),
            concave: EdgeStyle::between(self.concave, other.concave, colors, t),
            ..mix_fields(self, other, t)
        }
    }
}

impl Blend for ObjectEdges {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }
}
