//! What a key defines in the shaders of each pass.

use bevy::shader::ShaderDefVal;

use super::line_key::LineKey;
use crate::{gpu::definitions, lines::request::Search};

impl LineKey {
    fn common(&self) -> impl Iterator<Item = ShaderDefVal> + use<> {
        definitions([
            (self.same_size, "SAME_SIZE"),
            (self.oblique, "OBLIQUE"),
            (self.ids, "OBJECT_IDS"),
            (self.object_styles, "OBJECT_STYLES"),
        ])
    }

    pub fn find_defs(&self) -> Vec<ShaderDefVal> {
        let completed = self.links.then(|| "COMPLETED".into());
        let mut defs = self.crack_defs(self.silhouettes || self.creases);
        defs.extend(completed);
        defs
    }

    pub fn settle_defs(&self) -> Vec<ShaderDefVal> {
        let weight = &self.weight;
        self.common()
            .chain(definitions([
                (self.ledges, "LEDGES"),
                (self.bridged, "BRIDGED"),
                (self.smooth, "SMOOTH"),
                (self.creases, "FOLDS"),
                (weight.any(), "WEIGHT"),
                (self.reads_depth(), "DEPTH"),
                (self.rims, "RIMS"),
                (self.reads_depth(), "EDITS"),
                (weight.kinds, "KIND_WEIGHT"),
                (weight.light, "LIGHT_WEIGHT"),
                (weight.light, "NORMALS"),
                (weight.map, "WIDTH_MAP"),
                (weight.light || weight.map, "SURFACE_WEIGHT"),
                (weight.perspective, "PERSPECTIVE_WEIGHT"),
                (self.visible_range, "VISIBLE_RANGE"),
                (weight.nib_roundness, "NIB_WEIGHT"),
                (weight.taper, "TAPER_WEIGHT"),
                (weight.budget, "BUDGET"),
                (weight.fog, "FOG"),
                (weight.focus, "IN_FOCUS"),
                (weight.layers, "IN_LAYERS"),
                (weight.found_borders, "DEPTH_BORDERS"),
                (weight.by_objects, "OBJECT_DEPTHS"),
                (weight.abstracts, "ABSTRACT_CREASES"),
            ]))
            .collect()
    }

    pub fn persist_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(definitions([
                (self.motion, "MOTION"),
                (self.motion, "DEPTH"),
            ]))
            .collect()
    }

    pub fn ends_defs(&self) -> Vec<ShaderDefVal> {
        definitions([
            (true, "BLOCKS"),
            (true, "SMOOTH"),
            (self.varied, "VARIED"),
            (self.bridged, "BRIDGED"),
        ])
        .collect()
    }

    pub fn strokes_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(definitions([
                (self.boils, "BOIL"),
                (self.sheet.spreads, "SPREAD"),
                (self.sheet.streaks, "STREAKS"),
                (self.surface, "SURFACE"),
                (self.inward, "INWARD"),
                (self.weight.taper, "TAPER"),
            ]))
            .collect()
    }

    /// `excess`: the excess of steps in depth is computed. It excludes creases too.
    fn crack_defs(&self, excess: bool) -> Vec<ShaderDefVal> {
        self.common()
            .chain(definitions([
                (true, "DEPTH"),
                (excess, "EXCESS"),
                (self.silhouettes, "SILHOUETTES"),
                (self.creases, "CREASES"),
                (self.creases, "NORMALS"),
                (self.object_edges, "OBJECT_EDGES"),
                (self.ledges, "LEDGES"),
                (self.sections, "SECTIONS"),
                (self.marks, "MARKS"),
                (self.multisampled_picture, "MULTISAMPLED_PICTURE"),
                (self.abstracts, "ABSTRACT_LINES"),
                (self.abstracts_objects, "OBJECT_DEPTHS"),
                (self.fading, "FADING"),
                (self.visible_range, "VISIBLE_RANGE"),
            ]))
            .collect()
    }

    pub fn walk_defs(&self) -> Vec<ShaderDefVal> {
        let flags = ShaderDefVal::UInt("MAP_FLAGS".into(), self.map_flags);
        self.crack_defs(self.silhouettes || self.ledges)
            .into_iter()
            .chain(definitions([
                (true, "BOUNDS"),
                (self.has_cracks(), "CRACKS"),
                (self.bridged, "BRIDGED"),
                (self.jumps, "JUMPS"),
            ]))
            .chain(self.jumps.then_some(flags))
            .collect()
    }

    pub fn faithful_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(definitions([
                (true, "DEPTH"),
                (self.faithful[0], "FAITHFUL_SILHOUETTES"),
                (self.faithful[1], "FAITHFUL_CREASES"),
                (self.faithful[1], "NORMALS"),
                (self.fading, "FADING"),
                (self.visible_range, "VISIBLE_RANGE"),
            ]))
            .collect()
    }

    pub fn draw_defs(&self) -> Vec<ShaderDefVal> {
        self.common()
            .chain(definitions([
                (self.search == Search::Neighbours, "NEIGHBOURS"),
                (self.search == Search::Columns, "COLUMNS"),
                (!self.by_fragments, "BLOCKS"),
                (self.links, "COMPLETED"),
                (self.smooth, "SMOOTH"),
                (self.varied, "VARIED"),
                (self.boils, "BOIL"),
                (self.sheet.spreads, "SPREAD"),
                (self.sheet.streaks, "STREAKS"),
                (self.surface, "SURFACE"),
                (self.inward, "INWARD"),
                (self.has_owners(), "OWNERS"),
                (self.bridged, "BRIDGED"),
            ]))
            .collect()
    }
}
