//! What makes a line: the three kinds of outline.

use bevy::{
    color::Color,
    math::FloatExt,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use crate::settings::{
    Blend, FieldRange, Form, blend_color, blend_ratio, bounded, displayable, file_color,
};

/// Outlines where a surface ends before another one (\[CL\] Eq. 1, 2).
///
/// The filter is run on the raw depth buffer, which is affine over any plane:
/// no plane, however grazing, has a silhouette of its own.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Silhouettes {
    /// How the jump is measured. [`Form::Corrected`] does not depend on the
    /// world's units, the clipping planes or the camera's rotation, and draws a
    /// line of the given width along the edge. [`Form::Faithful`] is \[CL\]
    /// Eq. 1 and 2 on the depth buffer as it is: the response depends on the
    /// near plane and the scale of the world, and the line is the four columns
    /// of pixels that respond. Default: [`Form::Corrected`].
    pub form: Form,
    /// The detection threshold `k_p` of Eq. 2; the lower, the more lines.
    /// Corrected: the jump in depth, as a share of the distance, that is a full
    /// line (a straight edge answers with half its jump); under an orthographic
    /// projection a share of 1.2 times the height of the view. Faithful: the
    /// paper's number on the buffer of 0 to 1. Range 1e-6 to 1; in the corrected
    /// form 0.005 to 0.1 is useful. Default 0.02.
    #[reflect(@FieldRange::logarithmic(1e-6, 1.0))]
    pub threshold: f32,
    /// The paper's edge-limit-value: the response, 0 to 1, above which there is
    /// a line. Range 0.01 to 0.99, default 0.5.
    #[reflect(@FieldRange::linear(0.01, 0.99))]
    pub edge_limit: f32,
    /// Softness of that limit: 0 is a hard step, 1 lets the ink follow the
    /// response, as a sketch wants it. Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Colour of the line. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the line. Range 0 (the kind is left out) to 1. Default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

impl Silhouettes {
    pub(crate) const DEFAULT: Self = Self {
        form: Form::Corrected,
        threshold: 0.02,
        edge_limit: 0.5,
        softness: 0.5,
        color: Color::BLACK,
        opacity: 1.0,
    };

    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::DEFAULT;
        Self {
            form: self.form,
            threshold: bounded(self.threshold, default.threshold, 1e-6, 1.0),
            edge_limit: bounded(self.edge_limit, default.edge_limit, 0.01, 0.99),
            softness: bounded(self.softness, default.softness, 0.0, 1.0),
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
        }
    }

    /// `k` of Eq. 2. A straight step of height h makes `g_max - g_min = h / 2`.
    pub(crate) fn k(&self) -> f32 {
        match self.form {
            Form::Corrected => 0.5 * self.threshold,
            Form::Faithful => self.threshold,
        }
    }
}

impl Default for Silhouettes {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Outlines where a surface folds: Decaudin's creases, which \[CL\] leaves out.
/// Needs the normal prepass, which the camera gets.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Creases {
    /// How the crease is measured. [`Form::Corrected`] uses the angle between
    /// the normals of its two sides. [`Form::Faithful`] is \[CL\] Eq. 1 and 2 on
    /// each component of the normal: the response depends on the direction of
    /// the world's axes. Default: [`Form::Corrected`].
    pub form: Form,
    /// The fold that is a full line, degrees between the normals of its two
    /// sides. Range 3 to 180, default 40. Faithful: `k_p` of Eq. 2 is the sine
    /// of half of it, applied to every component of the normal.
    #[reflect(@FieldRange::linear(3.0, 180.0).unit("°"))]
    pub angle: f32,
    /// As [`Silhouettes::edge_limit`]. Range 0.01 to 0.99, default 0.5.
    #[reflect(@FieldRange::linear(0.01, 0.99))]
    pub edge_limit: f32,
    /// As [`Silhouettes::softness`]. Range 0 to 1, default 0.5.
    #[reflect(@FieldRange::FRACTION)]
    pub softness: f32,
    /// Colour of the line. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the line. Range 0 (the kind is left out) to 1. Default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

impl Creases {
    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            form: self.form,
            angle: bounded(self.angle, default.angle, 3.0, 180.0),
            edge_limit: bounded(self.edge_limit, default.edge_limit, 0.01, 0.99),
            softness: bounded(self.softness, default.softness, 0.0, 1.0),
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
        }
    }

    /// `k_n = sin(angle / 2)`, and never below what ten bits a component blur.
    pub(crate) fn k(&self) -> f32 {
        (0.5 * self.angle.to_radians()).sin().max(0.02)
    }
}

impl Default for Creases {
    fn default() -> Self {
        Self {
            form: Form::Corrected,
            angle: 40.0,
            edge_limit: 0.5,
            softness: 0.5,
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

/// Outlines where two objects meet, even at the same depth and slope. Objects
/// are mesh entities; their ids are drawn in a pass of their own.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ObjectEdges {
    /// Colour of the line. Clamped to what a display shows; its alpha is not
    /// used. Default: black.
    #[serde(with = "file_color")]
    pub color: Color,
    /// Opacity of the line. Range 0 (the kind is left out) to 1. Default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
}

impl ObjectEdges {
    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            color: displayable(self.color, default.color),
            opacity: bounded(self.opacity, default.opacity, 0.0, 1.0),
        }
    }
}

impl Default for ObjectEdges {
    fn default() -> Self {
        Self {
            color: Color::BLACK,
            opacity: 1.0,
        }
    }
}

/// Where ink begins and where it is full, for a limit on the response.
pub(crate) fn ramp(limit: f32, softness: f32) -> [f32; 2] {
    // smoothstep needs its ends apart: a hard step rises over a thousandth.
    let half = softness.max(1e-3) * limit.min(1.0 - limit);
    [limit - half, limit + half]
}

impl Blend for Silhouettes {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn same_modes(&self, other: &Self) -> bool {
        self.form == other.form
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        Self {
            form: self.form,
            threshold: blend_ratio(self.threshold, other.threshold, t),
            edge_limit: self.edge_limit.lerp(other.edge_limit, t),
            softness: self.softness.lerp(other.softness, t),
            color: blend_color(self.color, other.color, t),
            opacity: self.opacity.lerp(other.opacity, t),
        }
    }
}

impl Blend for Creases {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn same_modes(&self, other: &Self) -> bool {
        self.form == other.form
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        Self {
            form: self.form,
            angle: self.angle.lerp(other.angle, t),
            edge_limit: self.edge_limit.lerp(other.edge_limit, t),
            softness: self.softness.lerp(other.softness, t),
            color: blend_color(self.color, other.color, t),
            opacity: self.opacity.lerp(other.opacity, t),
        }
    }
}

impl Blend for ObjectEdges {
    fn faded(self, fraction: f32) -> Self {
        let opacity = self.opacity * fraction;
        Self { opacity, ..self }
    }

    fn same_modes(&self, _: &Self) -> bool {
        true
    }

    fn mixed(self, other: Self, t: f32) -> Self {
        Self {
            color: blend_color(self.color, other.color, t),
            opacity: self.opacity.lerp(other.opacity, t),
        }
    }
}
