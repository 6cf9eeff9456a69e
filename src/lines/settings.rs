//! The settings of the service of lines: which lines it finds, and their ink.

use bevy::{math::Vec3, render::render_resource::ShaderType};

use super::{
    boil::LineBoil,
    color::LineColor,
    fog::LineFog,
    kinds::{Creases, LineResponse, ObjectEdges, Silhouettes, ramp},
    sheet::Sheet,
    weight::LineWeight,
};
use crate::settings::{Form, linear_rgb};

/// Lines that an effect requests ([`Effect::lines`](crate::Effect::lines)). Every
/// number must be in the range that [`Outlines`](crate::Outlines) documents for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineSettings {
    /// Lines where a surface ends in front of another or of the sky; `None` for none.
    pub silhouettes: Option<Silhouettes>,
    /// Lines where a surface bends sharply; `None` for none.
    pub creases: Option<Creases>,
    /// Lines where two objects meet; `None` for none.
    pub objects: Option<ObjectEdges>,
    /// Width of the lines in logical pixels.
    pub width: f32,
    /// Fraction of the width that is lost at the far end of the depth map.
    pub width_fade: f32,
    /// Fraction of the opacity that is lost at the far end of the depth map.
    pub opacity_fade: f32,
    /// How far lines continue along weak edges, in logical pixels; 0: not at all.
    pub continuity: f32,
    /// Response from which an edge is weak but continues a line, as a fraction of the
    /// kind's edge limit.
    pub continuity_level: f32,
    /// Pieces of line of fewer borders of pixels than this are left out.
    pub specks: u32,
    /// Gaps of at most this many borders of pixels are closed; at most 3.
    pub bridge: u32,
    /// For how many frames lines stay where their edges have become weak; at most 8.
    pub persistence: u32,
    /// By how much loose ends of lines are extended, in logical pixels.
    pub overshoot: f32,
    /// What a line loses where an edge is weak.
    pub response: LineResponse,
    /// Whether lines run straight through the steps of pixels.
    pub smooth: bool,
    /// How wide lines are in different places.
    pub weight: LineWeight,
    /// Fraction of an area that lines may cover where they crowd; 1: no limit.
    pub budget: f32,
    /// How lines move.
    pub boil: LineBoil,
    /// Where the colour of lines comes from.
    pub color: LineColor,
    /// Fraction of each frame in lines that remember the frames before; 1: they do not.
    pub memory: f32,
    /// What happens to lines in the engine's distance fog.
    pub fog: LineFog,
}

/// Most borders of pixels that a line continues along weak edges, and most pixels that it
/// overshoots by.
const LONGEST: i32 = 64;

impl LineSettings {
    /// No kind of line, and no factor that changes lines.
    pub const NONE: Self = Self {
        silhouettes: None,
        creases: None,
        objects: None,
        width: 2.0,
        width_fade: 0.0,
        opacity_fade: 0.0,
        continuity: 8.0,
        continuity_level: 0.5,
        specks: 3,
        bridge: 0,
        persistence: 0,
        overshoot: 0.0,
        response: LineResponse::Width,
        smooth: true,
        weight: LineWeight::EVEN,
        budget: 1.0,
        boil: LineBoil::STILL,
        color: LineColor::Ink,
        memory: 0.125,
        fog: LineFog::Fade,
    };

    /// The lines of marked objects: their styles say which kinds, and how wide they are.
    #[cfg(feature = "objects")]
    pub(crate) const MARKS: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        objects: Some(ObjectEdges {
            color: bevy::color::Color::BLACK,
            opacity: 1.0,
        }),
        width: 0.5,
        fog: LineFog::Ignore,
        ..Self::NONE
    };

    /// The settings without the kinds that are invisible: those of opacity 0, and
    /// object edges if the crate is built without the feature `objects`.
    #[must_use]
    pub fn visible(self) -> Self {
        Self {
            silhouettes: self.silhouettes.filter(|s| s.opacity > 0.0),
            creases: self.creases.filter(|c| c.opacity > 0.0),
            objects: self
                .objects
                .filter(|o| o.opacity > 0.0 && cfg!(feature = "objects")),
            ..self
        }
    }

    /// Whether all kinds of line are `None`.
    pub fn is_empty(&self) -> bool {
        self.silhouettes.is_none() && self.creases.is_none() && self.objects.is_none()
    }

    /// Whether cracks are linked to lines, added, or left out if they are not part of one.
    pub(crate) fn links(&self) -> bool {
        self.continuity > 0.0 || self.specks > 1 || self.bridge > 0
    }

    /// Whether lines are joined where a face between two creases is thinner than a pixel.
    pub(crate) fn joins(&self) -> bool {
        self.continuity > 0.0 && self.has_measured_creases()
    }

    /// Whether lines stay where their edges have become weak. Without continuity there are
    /// no weak edges.
    pub(crate) fn persists(&self) -> bool {
        self.persistence > 0 && self.continuity > 0.0
    }

    /// Whether loose ends of lines are extended.
    pub(crate) fn overshoots(&self) -> bool {
        self.overshoot > 0.0 && self.smooth
    }

    /// By how much loose ends are extended, in pixels of the grid, of which there are `scale`
    /// per logical pixel.
    pub(crate) fn extension(&self, scale: f32) -> f32 {
        if self.overshoots() {
            (self.overshoot * scale).min(LONGEST as f32)
        } else {
            0.0
        }
    }

    /// Borders of pixels that a line continues along weak edges. `scale`: pixels of the
    /// grid per logical pixel.
    pub(crate) fn steps(&self, scale: f32) -> i32 {
        ((self.continuity * scale).ceil() as i32).min(LONGEST)
    }

    /// Borders of pixels that a piece of line must have. `scale`: see [`steps`](Self::steps).
    pub(crate) fn specks(&self, scale: f32) -> i32 {
        match self.specks {
            0 | 1 => 1,
            specks => ((specks as f32 * scale).ceil() as i32).clamp(1, LONGEST),
        }
    }

    /// Whether width or opacity decreases along the depth map, which is then read.
    pub fn fades(&self) -> bool {
        self.width_fade > 0.0 || self.opacity_fade > 0.0
    }

    /// Whether there are creases of the corrected form.
    pub(crate) fn has_measured_creases(&self) -> bool {
        self.creases.is_some_and(|c| c.form == Form::Corrected)
    }

    /// Whether any kind has the faithful form, whose ink is not found along cracks.
    pub(crate) fn has_faithful(&self) -> bool {
        self.silhouettes.is_some_and(|s| s.form == Form::Faithful)
            || self.creases.is_some_and(|c| c.form == Form::Faithful)
    }

    /// Whether any kind uses `width`. The faithful forms have their own width.
    pub(crate) fn has_wide_lines(&self) -> bool {
        self.objects.is_some()
            || self.silhouettes.is_some_and(|s| s.form != Form::Faithful)
            || self.creases.is_some_and(|c| c.form != Form::Faithful)
    }

    /// Distance in physical pixels within which lines are searched around a pixel.
    /// `scale` is physical pixels per logical pixel. `sheet`: what the lines are drawn on. `widest_object` is the width of
    /// the widest line of any `OutlineStyle`, in logical pixels. `vertex_widths`: the
    /// vertices of some mesh say how wide its lines are.
    pub(crate) fn reach(
        &self,
        scale: f32,
        (widest_object, vertex_widths): (f32, bool),
        sheet: Option<Sheet>,
    ) -> i32 {
        let widest = self.widest(widest_object, vertex_widths);
        if widest == 0.0 {
            return 0;
        }
        let half_width = 0.5 * widest * scale;
        super::reach(sheet.map_or(half_width, |sheet| sheet.largest(half_width)))
    }

    /// Width in logical pixels of the widest line that there can be; the parameters are those
    /// of [`reach`](Self::reach).
    pub(crate) fn widest(&self, widest_object: f32, vertex_widths: bool) -> f32 {
        let own = if self.has_wide_lines() {
            self.width
        } else {
            0.0
        };
        // Without compute shaders, all weights are 1.
        own.max(widest_object) * self.weight.largest(vertex_widths).max(1.0)
    }

    /// The jump in depth from which one surface hides another, instead of meeting it:
    /// the threshold of measured silhouettes. That of the faithful form has another
    /// meaning.
    fn jump(&self) -> f32 {
        let measured = self.silhouettes.filter(|s| s.form == Form::Corrected);
        measured.unwrap_or_default().threshold
    }

    /// The settings as shaders take them. `scale` is physical pixels per logical
    /// pixel, `reference` that of `DepthProjection::jump_reference`.
    pub(crate) fn uniform(&self, scale: f32, reference: [f32; 2]) -> LinesUniform {
        let s = self.silhouettes.unwrap_or_default();
        let c = self.creases.unwrap_or_default();
        let o = self.objects.unwrap_or_default();
        let continues = self.continuity > 0.0;
        // The faithful forms do not know weak edges.
        let ends = |form, limit, softness| {
            let weak = continues && form == Form::Corrected;
            ramp(
                limit,
                softness,
                weak.then_some(self.continuity_level * limit),
            )
        };
        let [silhouette_low, silhouette_high] = ends(s.form, s.edge_limit, s.softness);
        let [crease_low, crease_high] = ends(c.form, c.edge_limit, c.softness);
        let [ink_part, width_part] = self.response.parts();
        let [surface_darken, surface_saturate] = self.color.factors();
        let limit = |limit| if continues { limit } else { 0.0 };
        LinesUniform {
            silhouette_color: linear_rgb(s.color),
            silhouette_opacity: s.opacity,
            crease_color: linear_rgb(c.color),
            crease_opacity: c.opacity,
            object_color: linear_rgb(o.color),
            object_opacity: o.opacity,
            silhouette_low,
            silhouette_high,
            silhouette_k: s.k(),
            silhouette_faithful: u32::from(s.form == Form::Faithful),
            crease_low,
            crease_high,
            crease_k: c.k(),
            crease_faithful: u32::from(c.form == Form::Faithful),
            half_width: 0.5 * self.width * scale,
            scale,
            width_fade: self.width_fade,
            opacity_fade: self.opacity_fade,
            reference_factor: reference[0],
            reference_constant: reference[1],
            jump: self.jump(),
            ink_part,
            width_part,
            silhouette_limit: limit(s.edge_limit),
            crease_limit: limit(c.edge_limit),
            surface_darken,
            surface_saturate,
            unused_x: 0.0,
            unused_y: 0.0,
            unused_z: 0.0,
        }
    }
}

/// Places where the depth map D departs from planes. At other places, every two opposite
/// neighbours at the same distance, at most `radius`, have D less than `least` away from
/// a plane through the pixel between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapJumps {
    /// Smallest departure of D that counts.
    pub least: f32,
    /// Largest distance in physical pixels.
    pub radius: f32,
}

impl MapJumps {
    /// Places that satisfy either of two conditions.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            radius: self.radius.max(other.radius),
        }
    }
}

/// `Lines` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LinesUniform {
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
    jump: f32,
    ink_part: f32,
    width_part: f32,
    silhouette_limit: f32,
    crease_limit: f32,
    surface_darken: f32,
    surface_saturate: f32,
    unused_x: f32,
    unused_y: f32,
    unused_z: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether two surfaces meet at a crease does not depend on the form of silhouettes,
    /// nor on the threshold of the faithful form.
    #[test]
    fn creases_are_the_same_beside_faithful_silhouettes() {
        let jump = |silhouettes| {
            let settings = LineSettings {
                silhouettes,
                creases: Some(Creases::default()),
                ..LineSettings::NONE
            };
            settings.uniform(1.0, [1.0, 0.0]).jump
        };
        let faithful = |threshold| Silhouettes {
            form: Form::Faithful,
            threshold,
            ..Silhouettes::default()
        };
        let want = jump(Some(Silhouettes::default()));
        assert_eq!(jump(None), want);
        for threshold in [1e-6, 1e-4, 0.5, 1.0] {
            assert_eq!(jump(Some(faithful(threshold))), want);
        }
    }
}
