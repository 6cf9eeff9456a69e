//! The settings of lines: which lines are found, and their ink.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::{
    boil::LineBoil,
    color::LineColor,
    edges::EdgeStyle,
    fog::LineFog,
    kinds::{CreaseSource, Creases, LineEdge, LineResponse, ObjectEdges, Silhouettes},
    weight::LineWeight,
};
use crate::{
    lines::modifiers::Sheet,
    settings::{BlendField, Equations, FieldRange},
};

/// Draws outlines: silhouettes, where one surface hides another; creases, where a
/// surface bends sharply; and edges between objects (\[CL\] 2.1).
///
/// The three kinds are found separately, and where they overlap the strongest is
/// drawn. By default the same settings fit a tabletop and a landscape, whatever the
/// near and far planes. `Equations::Faithful`, which silhouettes and creases have each,
/// computes the paper's equations instead.
///
/// Geometry that is not in the depth prepass has no outlines: over a transparent
/// surface, the lines of the geometry behind it are drawn, unless it has the component
/// `DepthWrite`. The components `OutlineStyle` and `NoOutlines` change the lines of single
/// objects.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Component, Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Outlines {
    /// Draws lines where a surface ends in front of another one or of the sky;
    /// `None` draws none. Default: [`Silhouettes::default`].
    pub silhouettes: Option<Silhouettes>,
    /// Draws lines along creases; `None` draws none and saves the normal prepass.
    /// Default: [`Creases::default`].
    pub creases: Option<Creases>,
    /// Draws lines where two objects meet, whatever their depths and normals; `None`
    /// draws none. Without the crate's feature `objects`, none are drawn either.
    /// Default: [`ObjectEdges::default`].
    pub objects: Option<ObjectEdges>,
    /// Width of the lines in logical pixels. Range 0.5 to 16, default 2. Faithful lines
    /// are four physical pixels wide instead.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Fraction of the width that is lost at the far end of the depth map. Range 0 to
    /// 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub width_fade: f32,
    /// Fraction of the opacity that is lost at the far end of the depth map. Range 0
    /// to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity_fade: f32,
    /// How far lines continue along weak edges, in logical pixels: an edge that responds
    /// below `edge_limit`, but not below `hysteresis_ratio`, has a line if it continues
    /// one (hysteresis, Canny 1986). At most 64 physical pixels. Range 0 (not at all) to
    /// 32, default 8.
    #[reflect(@FieldRange::linear(0.0, 32.0).unit("px"))]
    pub hysteresis: f32,
    /// Response from which an edge continues a line, as a fraction of the kind's
    /// `edge_limit`. Range 0.1 to 1 (only what responds above the limit), default 0.5.
    #[reflect(@FieldRange::linear(0.1, 1.0))]
    pub hysteresis_ratio: f32,
    /// Removes lines along fewer borders of pixels than this, at scale factor 1, which are noise.
    /// Closed lines, and pieces that meet other lines, stay, however short they are. Range 1
    /// (leaves out nothing) to 8, default 7.
    #[reflect(@FieldRange::linear(1.0, 8.0))]
    pub min_length: u32,
    /// Closes gaps in lines of up to this many physical pixels along a row or column, such as those
    /// along wires that are thinner than a pixel. Real gaps are closed too. Needs compute shaders.
    /// Range 0 (closes none) to 3, default 0. Morphological closing along the line.
    #[reflect(@FieldRange::linear(0.0, 3.0).unit("physical px"))]
    pub gap_closing: u32,
    /// How many frames a line stays after its edge has become weak (hysteresis in time), so that
    /// lines flicker less in motion: an edge that responds below `edge_limit`, but not below
    /// `hysteresis_ratio`, keeps its line if there was one at most a pixel away in the last frame.
    /// Faster motion is followed where the engine draws motion vectors, in views with one sample.
    /// Lines are forgotten at a `CameraCut`. Needs `hysteresis` and compute shaders. Range 0 (off)
    /// to 8, default 0.
    #[reflect(@FieldRange::linear(0.0, 8.0))]
    pub hold_frames: u32,
    /// What a line loses where an edge is weak. Default: [`LineResponse::Width`].
    pub response: LineResponse,
    /// Whether lines run straight through the steps of pixels; otherwise they follow the
    /// borders of pixels. Needs compute shaders. Default: `true`.
    pub smooth: bool,
    /// Which pixels a line inks. Default: [`LineEdge::Smooth`].
    pub edge: LineEdge,
    /// How far lines extend straight beyond their loose ends, as in an architect's sketch, in
    /// logical pixels; at most by their own length. Closed lines and lines that meet others have no
    /// loose ends. With `weight.taper`, lines become thinner towards the end of the stroke. Needs
    /// `smooth` lines. At most 64 physical pixels. Range 0 (off) to 16, default 0.
    #[reflect(@FieldRange::linear(0.0, 16.0).unit("px"))]
    pub overshoot: f32,
    /// How wide lines are in different places. Default: [`LineWeight::EVEN`].
    #[reflect(@BlendField::Fields)]
    pub weight: LineWeight,
    /// Fraction of an area that lines may cover where they crowd, as on foliage or in the distance:
    /// there they are thinner, and below 0.6 physical pixels fainter. Density is measured within
    /// `2 * width / ink_budget` of a line (at least 16 and at most 1024 physical pixels; on a page at
    /// least 16 page pixels too), with most weight in the middle, so single lines, pairs, crossings
    /// and branches keep their width. Faithful lines have no budget. Needs compute shaders. Range
    /// 0.05 to 1 (no limit), default 0.35.
    #[reflect(@FieldRange::linear(0.05, 1.0))]
    pub ink_budget: f32,
    /// How lines move: as if each drawing of a film had been inked anew. Default:
    /// [`LineBoil::STILL`].
    #[reflect(@BlendField::Fields)]
    pub boil: LineBoil,
    /// Where the color of lines comes from. Default: [`LineColor::Ink`].
    #[reflect(@BlendField::Fields)]
    pub color: LineColor,
    /// Weight of the previous frames under temporal anti-aliasing, whose jitter lines would
    /// otherwise follow. History is rejected where lines move fast, where something else comes into
    /// view, and at a `CameraCut`. Lines that boil have no history, and neither have views without
    /// the engine's motion vectors. Range 0 (no history) to 31/32, default 7/8.
    #[reflect(@FieldRange::linear(0.0, 0.96875))]
    pub history_weight: f32,
    /// What happens to lines in the engine's `DistanceFog`, if the camera has it. Default:
    /// [`LineFog::Fade`].
    pub fog: LineFog,
}

impl Default for Outlines {
    fn default() -> Self {
        Self {
            silhouettes: Some(Silhouettes::default()),
            creases: Some(Creases::default()),
            objects: Some(ObjectEdges::default()),
            ..Self::NONE
        }
    }
}

impl Outlines {
    /// No kind of line; everything else has its default.
    pub const NONE: Self = Self {
        silhouettes: None,
        creases: None,
        objects: None,
        width: 2.0,
        width_fade: 0.0,
        opacity_fade: 0.0,
        hysteresis: 8.0,
        hysteresis_ratio: 0.5,
        min_length: 7,
        gap_closing: 0,
        hold_frames: 0,
        overshoot: 0.0,
        response: LineResponse::Width,
        smooth: true,
        edge: LineEdge::Smooth,
        weight: LineWeight::EVEN,
        ink_budget: 0.35,
        boil: LineBoil::STILL,
        color: LineColor::Ink,
        history_weight: 0.875,
        fog: LineFog::Fade,
    };

    /// Silhouettes only, the one kind that \[CL\] 3.2 implements, with the corrected equations.
    pub const SILHOUETTES: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        ..Self::NONE
    };

    /// Lines of pixel art: black pixels on one side of each edge, without grays, for a camera with
    /// `Msaa::Off` that draws to a small image.
    pub const PIXELS: Self = Self {
        silhouettes: Some(Silhouettes {
            softness: 0.0,
            ..Silhouettes::DEFAULT
        }),
        creases: Some(Creases {
            softness: 0.0,
            ..Creases::DEFAULT
        }),
        objects: Some(ObjectEdges::DEFAULT),
        width: 1.0,
        hysteresis: 0.0,
        min_length: 1,
        smooth: false,
        edge: LineEdge::Hard,
        ink_budget: 1.0,
        ..Self::NONE
    };
}

/// The largest half width of a line in physical pixels: that of `pack_width` in
/// `edge.wgsl`.
const LARGEST_HALF_WIDTH: f32 = 31.0;

/// Distance within which lines of this half width are searched around a pixel, both in
/// physical pixels.
fn reach(half_width: f32) -> i32 {
    (half_width.min(LARGEST_HALF_WIDTH) + 1.0).ceil() as i32 - 1
}

/// Most borders of pixels that a line continues along weak edges, and most pixels that it
/// overshoots by.
const LONGEST: i32 = 64;

impl Outlines {
    /// No kind of line, and no factor that changes lines.
    pub(crate) const BARE: Self = Self {
        min_length: 3,
        ink_budget: 1.0,
        ..Self::NONE
    };

    /// The lines of highlighted objects: their styles say which kinds, and how wide they are.
    #[cfg(feature = "objects")]
    pub(crate) const HIGHLIGHTS: Self = Self {
        silhouettes: Some(Silhouettes::DEFAULT),
        objects: Some(ObjectEdges {
            color: Color::BLACK,
            opacity: 1.0,
        }),
        width: 0.5,
        fog: LineFog::Ignore,
        ..Self::BARE
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
        self.hysteresis > 0.0 || self.min_length > 1 || self.gap_closing > 0
    }

    /// Whether lines are joined where a face between two creases is thinner than a pixel.
    pub(crate) fn joins(&self) -> bool {
        self.hysteresis > 0.0 && self.has_measured_creases()
    }

    /// Whether lines stay where their edges have become weak. Without hysteresis there are
    /// no weak edges.
    pub(crate) fn holds_lines(&self) -> bool {
        self.hold_frames > 0 && self.hysteresis > 0.0
    }

    /// Whether lines run straight through the steps of pixels.
    pub(crate) fn is_smooth(&self) -> bool {
        self.smooth && self.edge == LineEdge::Smooth
    }

    /// Whether loose ends of lines are extended.
    pub(crate) fn overshoots(&self) -> bool {
        self.overshoot > 0.0 && self.is_smooth()
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
        ((self.hysteresis * scale).ceil() as i32).min(LONGEST)
    }

    /// Borders of pixels that a piece of line must have. `scale`: see [`steps`](Self::steps).
    pub(crate) fn min_length(&self, scale: f32) -> i32 {
        match self.min_length {
            0 | 1 => 1,
            min_length => ((min_length as f32 * scale).ceil() as i32).clamp(1, LONGEST),
        }
    }

    /// Whether width or opacity decreases along the depth map, which is then read.
    pub fn fades(&self) -> bool {
        self.width_fade > 0.0 || self.opacity_fade > 0.0
    }

    /// Whether there are creases of the corrected equations.
    pub(crate) fn has_measured_creases(&self) -> bool {
        self.creases
            .is_some_and(|c| c.equations == Equations::Corrected)
    }

    /// Whether creases are found at the edges of all meshes.
    pub(crate) fn divides_meshes(&self) -> bool {
        self.has_measured_creases()
            && (self.creases).is_some_and(|creases| creases.source != CreaseSource::Normals)
    }

    /// Whether convex and concave creases differ.
    pub(crate) fn has_edge_styles(&self) -> bool {
        self.creases
            .is_some_and(|creases| creases.edge_styles().next().is_some())
    }

    /// Whether the light on creases is read.
    pub(crate) fn has_lit_edges(&self) -> bool {
        let lit = |style: EdgeStyle| style.unlit_opacity < 1.0;
        self.creases
            .is_some_and(|creases| creases.edge_styles().any(lit))
    }

    /// Whether the color of some lines is that of the surface that they belong to.
    pub(crate) fn has_surface_colors(&self) -> bool {
        let edge = |style: EdgeStyle| style.color.is_surface();
        self.color.is_surface()
            || self
                .creases
                .is_some_and(|creases| creases.edge_styles().any(edge))
    }

    /// Whether completing lines reads normals.
    pub(crate) fn needs_normals(&self) -> bool {
        self.weight.reads_normals() || self.has_lit_edges()
    }

    /// Whether finding lines reads normals. Hard lines choose their side by them.
    pub(crate) fn finds_by_normals(&self) -> bool {
        self.creases.is_some_and(|creases| {
            creases.equations == Equations::Faithful
                || creases.source != CreaseSource::Meshes
                || self.edge == LineEdge::Hard
        })
    }

    /// Whether depth must bend where normals make a crease.
    pub(crate) fn finds_bends(&self) -> bool {
        let by_normals = |c: &Creases| c.source != CreaseSource::Meshes && !c.normal_maps;
        self.creases.as_ref().is_some_and(by_normals)
    }

    /// The equations of silhouettes and of creases, if there are any.
    pub(crate) fn equations(&self) -> [Option<Equations>; 2] {
        [
            self.silhouettes.map(|s| s.equations),
            self.creases.map(|c| c.equations),
        ]
    }

    /// Whether any kind has the faithful equations, whose ink is not found along cracks.
    pub(crate) fn has_faithful(&self) -> bool {
        self.equations().contains(&Some(Equations::Faithful))
    }

    /// Whether any kind uses `width`. The faithful lines have their own width.
    pub(crate) fn has_wide_lines(&self) -> bool {
        self.objects.is_some() || self.equations().contains(&Some(Equations::Corrected))
    }

    /// Distance in physical pixels within which lines are searched around a pixel. `scale` is
    /// physical pixels per logical pixel. `sheet`: what the lines are drawn on. `widest_object` is
    /// the width of the widest line of any `OutlineStyle`, in logical pixels. `vertex_widths`: the
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
        match self.edge {
            LineEdge::Smooth => reach(sheet.map_or(half_width, |sheet| sheet.largest(half_width))),
            LineEdge::Hard => (2.0 * half_width.min(LARGEST_HALF_WIDTH)).round() as i32,
        }
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
        let edges = self.creases.iter().flat_map(Creases::edge_styles);
        let edge = edges.map(|style| style.width).fold(1.0, f32::max);
        own.max(widest_object) * edge * self.weight.largest(vertex_widths).max(1.0)
    }
}
