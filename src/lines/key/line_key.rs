//! The keys that select the variants of the line passes.

use bevy::math::Vec2;

use super::weight_key::WeightKey;
use crate::{
    lines::{
        modifiers::SheetKey,
        request::{LineRequest, Search},
    },
    settings::Equations,
};

/// What selects the shader variants of the passes that find and draw lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct LineKey {
    pub oblique: bool,
    /// Measured silhouettes and creases: those of the corrected equations.
    pub silhouettes: bool,
    pub creases: bool,
    pub object_edges: bool,
    /// Borders of sections are creases.
    pub sections: bool,
    /// The lines are those of marked objects; and whether the depth that hides them is
    /// multisampled.
    pub marks: bool,
    pub multisampled_picture: bool,
    pub ids: bool,
    pub object_styles: bool,
    pub fading: bool,
    /// Edges must be stronger where the picture is abstract.
    pub abstracts: bool,
    /// They are as abstract as their object.
    pub abstracts_objects: bool,
    pub visible_range: bool,
    /// Whether there are silhouettes and creases of the faithful equations.
    pub faithful: [bool; 2],
    /// Cracks are linked to lines; of a part of a key: they are completed after they were
    /// found.
    pub links: bool,
    /// Lines stay where their edges have become weak; and whether the engine's motion
    /// vectors say where they were.
    pub persists: bool,
    pub motion: bool,
    /// Loose ends are extended.
    pub overshoots: bool,
    /// Lines are joined over faces that are thinner than a pixel.
    pub ledges: bool,
    /// Creases and object edges may be parts of silhouettes.
    pub rims: bool,
    /// Gaps in lines are closed.
    pub bridged: bool,
    /// Lines run straight through the steps of pixels.
    pub smooth: bool,
    /// Which factors of width and opacity are not 1.
    pub weight: WeightKey,
    /// The colour of lines depends on the surface that they belong to.
    pub surface: bool,
    /// They take the colour a pixel inside of it, because its rim is mixed with others.
    pub inward: bool,
    /// Lines are displaced.
    pub boils: bool,
    /// What they have of the sheet that they are drawn on.
    pub sheet: SheetKey,
    /// The width changes along a line.
    pub varied: bool,
    /// The depth texture has one pixel per pixel of the viewport.
    pub same_size: bool,
    pub search: Search,
    /// Jumps of the depth map are searched too, with these flags of the map.
    pub jumps: bool,
    pub(super) map_flags: u32,
    /// The device has no compute shaders: the passes draw all pixels, not tiles.
    pub by_fragments: bool,
}

impl LineKey {
    pub fn new(request: &LineRequest, by_fragments: bool) -> Self {
        let lines = &request.settings;
        let forms = [
            lines.silhouettes.map(|s| s.equations),
            lines.creases.map(|c| c.equations),
        ];
        let [silhouettes, creases] = forms.map(|form| form == Some(Equations::Corrected));
        let weight = if by_fragments {
            WeightKey::default()
        } else {
            WeightKey {
                fog: request.fog.is_some(),
                focus: request.focus.is_some(),
                layers: request.layers.is_some(),
                found_borders: request.layers.is_some_and(|layers| layers.finds_borders),
                by_objects: request.reads_places() && request.ids,
                abstracts: request.abstraction.is_some_and(|a| a.crease_opacity < 1.0),
                map: request.widths,
                ..WeightKey::new(lines)
            }
        };
        Self {
            oblique: request.oblique,
            silhouettes,
            creases,
            object_edges: lines.objects.is_some() && request.ids,
            sections: creases && request.sections && request.ids,
            marks: request.marks,
            multisampled_picture: request.marks && request.samples > 1,
            ids: request.ids,
            object_styles: request.object_styles,
            fading: lines.fades(),
            abstracts: request.abstraction.is_some_and(|a| a.threshold > 1.0),
            abstracts_objects: request.abstracts_objects() && !by_fragments,
            visible_range: request.visible_range,
            faithful: forms.map(|form| form == Some(Equations::Faithful)),
            links: lines.links() && !by_fragments,
            persists: lines.persists() && !by_fragments,
            motion: lines.persists() && request.motion,
            overshoots: lines.overshoots() && !by_fragments,
            ledges: lines.joins() && !by_fragments,
            rims: silhouettes
                && (creases || lines.objects.is_some() && request.ids)
                && lines.links()
                && !by_fragments,
            bridged: lines.gap_closing > 0 && !by_fragments,
            smooth: lines.smooth && !by_fragments,
            weight,
            surface: request.needs_owners(),
            inward: request.needs_owners() && request.samples > 1,
            boils: lines.boil.moves(),
            sheet: request.sheet.key(),
            varied: weight.varies(),
            same_size: request.view.depth_scale == Vec2::ONE,
            search: request.search(),
            jumps: request.jumps.is_some(),
            map_flags: request.map_flags,
            by_fragments,
        }
    }

    /// Whether there are lines along cracks, besides those of the faithful equations.
    pub fn has_cracks(&self) -> bool {
        self.silhouettes || self.creases || self.object_edges
    }

    /// Whether the cracks are completed after they were found.
    pub fn settles(&self) -> bool {
        self.links || self.smooth || self.weight.any()
    }

    pub fn has_faithful(&self) -> bool {
        self.faithful.contains(&true)
    }

    /// The part that the search for blocks with cracks depends on.
    pub fn for_walk(self) -> Self {
        Self {
            ids: self.object_edges || self.sections,
            object_styles: false,
            fading: false,
            abstracts: false,
            abstracts_objects: false,
            visible_range: self.jumps && self.visible_range,
            links: false,
            bridged: self.bridged,
            jumps: self.jumps,
            map_flags: if self.jumps { self.map_flags } else { 0 },
            ..self.for_find()
        }
    }

    /// The part that finding depends on.
    pub fn for_find(self) -> Self {
        Self {
            oblique: self.oblique,
            silhouettes: self.silhouettes,
            creases: self.creases,
            object_edges: self.object_edges,
            sections: self.sections,
            marks: self.marks,
            multisampled_picture: self.multisampled_picture,
            ids: self.object_edges || self.object_styles || self.sections || self.abstracts_objects,
            object_styles: self.object_styles,
            fading: self.fading,
            abstracts: self.abstracts,
            abstracts_objects: self.abstracts_objects,
            visible_range: (self.fading || self.abstracts) && self.visible_range,
            links: self.settles(),
            ledges: self.ledges,
            same_size: self.same_size,
            by_fragments: self.by_fragments,
            ..Self::default()
        }
    }

    /// The part that the faithful equations depend on.
    pub fn for_faithful(self) -> Self {
        Self {
            oblique: self.oblique,
            ids: self.ids,
            object_styles: self.object_styles,
            fading: self.fading,
            visible_range: self.fading && self.visible_range,
            faithful: self.faithful,
            surface: self.surface,
            same_size: self.same_size,
            ..Self::default()
        }
    }

    /// The part that completing cracks depends on.
    pub fn for_settle(self) -> Self {
        let weight = self.weight;
        let reads_map = weight.perspective || weight.layers || weight.abstracts;
        Self {
            ledges: self.ledges,
            rims: self.rims,
            bridged: self.bridged,
            smooth: self.smooth,
            creases: self.creases && self.smooth,
            weight,
            ids: (weight.outer || weight.by_objects) && self.ids,
            oblique: (weight.any() || self.rims || self.creases && self.smooth) && self.oblique,
            visible_range: reads_map && self.visible_range,
            ..Self::default()
        }
    }

    /// Whether the places of objects in the depth map are read, of a key for a pass.
    pub fn reads_places(&self) -> bool {
        self.weight.by_objects || self.abstracts_objects
    }

    /// Whether completing cracks reads depth, of a key for that pass.
    pub fn reads_depth(&self) -> bool {
        self.creases || self.rims || self.weight.any()
    }

    /// The part that keeping the lines of the last frames depends on.
    pub fn for_persist(self) -> Self {
        Self {
            motion: self.motion,
            oblique: self.motion && self.oblique,
            ..Self::default()
        }
    }

    /// The part that extending loose ends depends on.
    pub fn for_ends(self) -> Self {
        Self {
            varied: self.varied,
            bridged: self.bridged && self.has_owners(),
            ..Self::default()
        }
    }

    /// The part that drawing the strokes beyond loose ends depends on.
    pub fn for_strokes(self) -> Self {
        Self {
            ids: self.object_styles,
            object_styles: self.object_styles,
            boils: self.boils,
            sheet: self.sheet,
            surface: self.surface,
            inward: self.inward,
            weight: WeightKey {
                taper: self.weight.taper,
                ..WeightKey::default()
            },
            ..Self::default()
        }
    }

    /// The part that the search in columns depends on.
    pub fn for_columns(self) -> Self {
        Self {
            links: self.settles(),
            smooth: self.smooth,
            varied: self.varied,
            by_fragments: self.by_fragments,
            ..Self::default()
        }
    }

    /// Whether drawing must know the pixel that owns a line.
    pub(super) fn has_owners(&self) -> bool {
        self.object_styles || self.surface
    }

    /// The part that drawing depends on.
    pub fn for_draw(self) -> Self {
        Self {
            ids: self.object_styles,
            object_styles: self.object_styles,
            search: self.search,
            links: self.settles() && self.search != Search::Columns,
            boils: self.boils,
            sheet: self.sheet,
            surface: self.surface,
            inward: self.inward,
            bridged: self.bridged && self.has_owners(),
            smooth: self.smooth && self.search != Search::Columns,
            varied: self.varied && self.search != Search::Columns,
            by_fragments: self.by_fragments,
            ..Self::default()
        }
    }
}
