//! Outlines of the geometry ([CL] 2.1, after Decaudin): silhouettes from depth,
//! creases from normals, edges between objects from their ids.

pub(crate) mod kinds;

use bevy::{
    color::ColorToComponents,
    ecs::{component::Component, reflect::ReflectComponent},
    math::Vec3,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

pub use kinds::{Creases, EdgeForm, ObjectEdges, Silhouettes};

use super::FieldRange;
use crate::sanitize::bounded;

/// Draws the outlines of things: where one surface hides another, where a
/// surface folds, where two objects touch.
///
/// The three kinds are found separately and the strongest is drawn
/// (\[CL\] Eq. 5). They are measured so that the same settings fit a tabletop
/// and a landscape, whatever the near and far planes; the papers' own form is
/// [`EdgeForm::Faithful`], kind by kind.
///
/// What has no depth in the prepass has no outline: transparent surfaces are
/// drawn over by the lines of what lies behind them. [`ContourStyle`] and
/// [`NoContours`] change the lines of single objects.
///
/// [`ContourStyle`]: crate::ContourStyle
/// [`NoContours`]: crate::NoContours
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Lines where a surface ends in front of another or of the sky.
    /// `None` draws none. Default: [`Silhouettes::default`].
    pub silhouettes: Option<Silhouettes>,
    /// Lines where a surface folds. `None` draws none and spares the normal
    /// prepass. Default: [`Creases::default`].
    pub creases: Option<Creases>,
    /// Lines where two objects meet, whatever their depth and normals. `None`
    /// draws none. Needs the crate's feature `objects`, without which the lines
    /// are missing. Default: [`ObjectEdges::default`].
    pub objects: Option<ObjectEdges>,
    /// Width of the lines in logical pixels. Range 0.5 to 16, default 2.
    /// [`EdgeForm::Faithful`] lines have the paper's four columns instead.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Share of the width that is lost at the far end of the depth map.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::SHARE)]
    pub width_fade: f32,
    /// Share of the opacity that is lost at the far end of the depth map.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::SHARE)]
    pub opacity_fade: f32,
}

impl Default for Outlines {
    fn default() -> Self {
        Self {
            silhouettes: Some(Silhouettes::default()),
            creases: Some(Creases::default()),
            objects: Some(ObjectEdges::default()),
            width: 2.0,
            width_fade: 0.0,
            opacity_fade: 0.0,
        }
    }
}

impl Outlines {
    /// Silhouettes alone, as \[CL\] draws them.
    pub const SILHOUETTES: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        creases: None,
        objects: None,
        width: 2.0,
        width_fade: 0.0,
        opacity_fade: 0.0,
    };

    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            silhouettes: self.silhouettes.map(Silhouettes::sanitized),
            creases: self.creases.map(Creases::sanitized),
            objects: self.objects.map(ObjectEdges::sanitized),
            width: bounded(self.width, default.width, 0.5, 16.0),
            width_fade: bounded(self.width_fade, default.width_fade, 0.0, 1.0),
            opacity_fade: bounded(self.opacity_fade, default.opacity_fade, 0.0, 1.0),
        }
    }

    /// The kinds that can be seen: those without opacity are taken out, and
    /// object edges where the crate is built without ids.
    pub(crate) fn effective(self) -> Self {
        Self {
            silhouettes: self.silhouettes.filter(|s| s.opacity > 0.0),
            creases: self.creases.filter(|c| c.opacity > 0.0),
            objects: self
                .objects
                .filter(|o| o.opacity > 0.0 && cfg!(feature = "objects")),
            ..self
        }
    }

    pub(crate) fn is_negligible(&self) -> bool {
        let e = self.effective();
        e.silhouettes.is_none() && e.creases.is_none() && e.objects.is_none()
    }

    /// Whether any kind has lines of a width of their own.
    pub(crate) fn has_wide_lines(&self) -> bool {
        self.objects.is_some()
            || self
                .silhouettes
                .is_some_and(|s| s.form != EdgeForm::Faithful)
            || self.creases.is_some_and(|c| c.form != EdgeForm::Faithful)
    }

    /// `scale` is physical pixels per logical pixel; `reference` turns the
    /// largest raw depth nearby into what a silhouette's jump is measured
    /// against: (factor, constant).
    pub(crate) fn uniform(&self, scale: f32, reference: [f32; 2], reach: i32) -> OutlinesUniform {
        let s = self.silhouettes.unwrap_or_default();
        let c = self.creases.unwrap_or_default();
        let o = self.objects.unwrap_or_default();
        let rgb =
            |color: bevy::color::Color| Vec3::from_array(color.to_linear().to_f32_array_no_alpha());
        let [silhouette_low, silhouette_high] = kinds::ramp(s.edge_limit, s.softness);
        let [crease_low, crease_high] = kinds::ramp(c.edge_limit, c.softness);
        OutlinesUniform {
            silhouette_color: rgb(s.color),
            silhouette_opacity: s.opacity,
            crease_color: rgb(c.color),
            crease_opacity: c.opacity,
            object_color: rgb(o.color),
            object_opacity: o.opacity,
            silhouette_low,
            silhouette_high,
            silhouette_k: s.k(),
            silhouette_faithful: u32::from(s.form == EdgeForm::Faithful),
            crease_low,
            crease_high,
            crease_k: c.k(),
            crease_faithful: u32::from(c.form == EdgeForm::Faithful),
            half_width: 0.5 * self.width * scale,
            scale,
            width_fade: self.width_fade,
            opacity_fade: self.opacity_fade,
            reference_factor: reference[0],
            reference_constant: reference[1],
            reach,
            unused: 0,
        }
    }
}

/// `Outlines` of `outlines.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct OutlinesUniform {
    silhouette_color: Vec3,
    silhouette_opacity: f32,
    crease_color: Vec3,
    crease_opacity: f32,
    object_color: Vec3,
    object_opacity: f32,
    silhouette_low: f32,
    silhouette_high: f32,
    silhouette_k: f32,
    silhouette_faithful: u32,
    crease_low: f32,
    crease_high: f32,
    crease_k: f32,
    crease_faithful: u32,
    half_width: f32,
    scale: f32,
    width_fade: f32,
    opacity_fade: f32,
    reference_factor: f32,
    reference_constant: f32,
    pub(crate) reach: i32,
    unused: u32,
}
