//! How wide lines are in different places: the settings, and what the shaders read of them.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    objects::LARGEST_FACTOR,
    settings::{FieldRange, impl_sanitized},
};

/// Varies the width of lines from place to place. Each setting is or determines a factor of the
/// line's width; the factors are multiplied. With the defaults, all are 1.
///
/// They apply to corrected lines, on devices with compute shaders. The ideas are those of ink
/// drawing: thick outside and thin inside, heavy in the shade, tapered where a line ends. The light
/// is that of the surface in front; of creases and object edges, the mean over both sides. The
/// middle of a line whose width changes is exactly the edge; that of an even line of odd width is
/// half a pixel further in.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LineWeight {
    /// Width of silhouettes in front of the sky or of another object, as a multiple of the
    /// lines' width. Meshes of one `OutlineGroup` are one object. Without the crate's
    /// feature `objects`, only in front of the sky. Range 0 to 4, default 1.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub outer: f32,
    /// Width of silhouettes in front of another part of the same object. Range 0 to 4,
    /// default 1.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub inner: f32,
    /// Width of creases. Range 0 to 4, default 1.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub crease: f32,
    /// Width of edges between objects, where there is no silhouette. Range 0 to 4, default
    /// 1.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub object: f32,
    /// By what fraction lines are wider on surfaces that face away from the light. The
    /// light is the [`KeyLight`](crate::KeyLight), else the brightest directional light,
    /// else one from above. The normal prepass is added to the camera. Range 0 to 2,
    /// default 0.
    #[reflect(@FieldRange::linear(0.0, 2.0))]
    pub shade: f32,
    /// By what fraction lines are narrower on surfaces that face the light; at 1, the
    /// light side has no lines. The normal prepass is added to the camera. Range 0 to 1,
    /// default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub lit: f32,
    /// How much the width follows distance in a perspective view: 0: lines are equally wide
    /// at all distances; 1: as if drawn on the surfaces. The width is unchanged halfway
    /// between the ends of the depth map's range; it at most doubles, and at least an eighth
    /// of it is left. Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub perspective: f32,
    /// Width of lines along the edge of the pen's nib, as a fraction of that across it: 1 is
    /// a round pen. Needs `smooth` lines. Range 0.1 to 1, default 1.
    #[reflect(@FieldRange::linear(0.1, 1.0))]
    pub nib_roundness: f32,
    /// Direction of the edge of the nib, counterclockwise from a horizontal line in the
    /// picture, in degrees. Range 0 to 180, default 40.
    #[reflect(@FieldRange::linear(0.0, 180.0).unit("°"))]
    pub nib_angle: f32,
    /// Length over which a line becomes thinner towards a loose end, in logical pixels,
    /// counted along the borders of pixels. Lines that meet others have no loose end.
    /// At most 64 physical pixels. Range 0 (blunt ends) to 48, default 0.
    #[reflect(@FieldRange::linear(0.0, 48.0).unit("px"))]
    pub taper: f32,
    /// By what fraction lines become wider and narrower, as if the pen was pressed harder
    /// here and there; the mean width stays. The places are fixed to the object: they move,
    /// turn and grow with it, but do not follow skins and morph targets. Needs the crate's
    /// feature `objects`; object ids are drawn. Range 0 (even) to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub pressure: f32,
    /// Length over which the pressure changes, in logical pixels, whatever the distance of
    /// the object. Range 10 to 500, default 60.
    #[reflect(@FieldRange::logarithmic(10.0, 500.0).unit("px"))]
    pub pressure_length: f32,
}

/// The most by which [`LineWeight::perspective`] multiplies a width: that of `weight.wgsl`.
const NEAREST: f32 = 2.0;
/// Most cracks that the end of a line is looked for in.
const LONGEST_TAPER: f32 = 64.0;

impl LineWeight {
    /// Lines of even width.
    pub const EVEN: Self = Self {
        outer: 1.0,
        inner: 1.0,
        crease: 1.0,
        object: 1.0,
        shade: 0.0,
        lit: 0.0,
        perspective: 0.0,
        nib_roundness: 1.0,
        nib_angle: 40.0,
        taper: 0.0,
        pressure: 0.0,
        pressure_length: 60.0,
    };

    /// Whether widths depend on the normals of surfaces.
    pub(crate) fn reads_normals(&self) -> bool {
        self.shade > 0.0 || self.lit > 0.0
    }

    /// Whether widths depend on the objects on both sides of a silhouette.
    pub(crate) fn reads_ids(&self) -> bool {
        self.outer != self.inner
    }

    /// The largest factor of any line. `vertex_widths`: the vertices of some mesh say how
    /// wide its lines are.
    pub(crate) fn largest(&self, vertex_widths: bool) -> f32 {
        let kinds = [self.outer, self.inner, self.crease, self.object];
        let kind = kinds.into_iter().fold(0.0, f32::max);
        let nearest = if self.perspective > 0.0 { NEAREST } else { 1.0 };
        let drawn = if vertex_widths {
            LARGEST_FACTOR
        } else {
            1.0 + self.pressure
        };
        kind * (1.0 + self.shade) * nearest * drawn
    }

    /// The settings as shaders take them. `scale`: pixels of the grid per logical pixel;
    /// `to_light`: unit vector; `least_radius`: of areas with a budget, in pixels of the viewport.
    pub(crate) fn uniform(
        &self,
        scale: f32,
        to_light: Vec3,
        (budget, least_radius): (f32, f32),
    ) -> WeightUniform {
        let angle = self.nib_angle.to_radians();
        WeightUniform {
            outer: self.outer,
            inner: self.inner,
            crease: self.crease,
            object: self.object,
            to_light,
            shade: self.shade,
            // The picture's y goes down.
            nib_edge: Vec2::new(angle.cos(), -angle.sin()),
            nib_roundness: self.nib_roundness,
            lit: self.lit,
            perspective: self.perspective,
            taper: (self.taper * scale).min(LONGEST_TAPER),
            budget,
            least_radius,
        }
    }
}

impl_sanitized!(LineWeight);

impl Default for LineWeight {
    fn default() -> Self {
        Self::EVEN
    }
}

/// `Weight` of `weight.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WeightUniform {
    outer: f32,
    inner: f32,
    crease: f32,
    object: f32,
    to_light: Vec3,
    shade: f32,
    nib_edge: Vec2,
    nib_roundness: f32,
    lit: f32,
    perspective: f32,
    taper: f32,
    budget: f32,
    least_radius: f32,
}
