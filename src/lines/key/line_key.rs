//! The keys that select the variants of the line passes.

use bevy::{math::Vec2, shader::ShaderDefVal};
use bitflags::bitflags;

use crate::{
    lines::{
        request::{LineRequest, Search},
        settings::LineEdge,
    },
    settings::Equations,
};

bitflags! {
    /// What selects the shader variants of the passes that find and draw lines. The key of a view
    /// has what its lines need; its parts, such as [`LineKey::for_find`], have what is compiled
    /// into one pass: their names are shader definitions. The two bits above them are flags of the
    /// depth map.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub(crate) struct LineKey: u128 {
        /// The depth texture has one pixel per pixel of the viewport.
        const SAME_SIZE = 1;
        const OBLIQUE = 1 << 1;
        const DEPTH = 1 << 2;
        const NORMALS = 1 << 3;
        const OBJECT_IDS = 1 << 4;
        const OBJECT_STYLES = 1 << 5;
        /// The depths of objects in the depth map are read.
        const OBJECT_DEPTHS = 1 << 6;
        const VISIBLE_RANGE = 1 << 7;

        /// There are lines along cracks: those that follow, of the corrected equations.
        const CRACKS = 1 << 8;
        const SILHOUETTES = 1 << 9;
        const CREASES = 1 << 10;
        const OBJECT_EDGES = 1 << 11;
        /// Borders of sections are creases.
        const SECTIONS = 1 << 12;
        /// The lines are those of highlighted objects; and whether the depth that hides them is
        /// multisampled.
        const HIGHLIGHTS = 1 << 13;
        const MULTISAMPLED_PICTURE = 1 << 14;
        /// The excess of steps in depth is computed. It excludes creases too.
        const EXCESS = 1 << 15;
        const FADING = 1 << 16;
        /// Edges must be stronger where lines are simpler; and whether they are as simple as their
        /// object.
        const SIMPLIFIED_LINES = 1 << 17;
        const FINDS_BY_OBJECTS = 1 << 18;
        /// Blocks are searched whose cells may have cracks.
        const BOUNDS = 1 << 19;
        /// Jumps of the depth map are searched too, with the flags of the map.
        const JUMPS = 1 << 20;
        const FAITHFUL_SILHOUETTES = 1 << 21;
        const FAITHFUL_CREASES = 1 << 22;

        /// Cracks are completed after they were found.
        const COMPLETED = 1 << 23;
        /// Lines stay where their edges have become weak; and whether the engine's motion vectors
        /// say where they were.
        const HOLDS = 1 << 24;
        const MOTION = 1 << 25;
        /// Loose ends are extended.
        const OVERSHOOTS = 1 << 26;
        /// Lines are joined over faces that are thinner than a pixel.
        const LEDGES = 1 << 27;
        /// Creases and object edges may be parts of silhouettes.
        const RIMS = 1 << 28;
        /// Gaps in lines are closed.
        const CLOSED_GAPS = 1 << 29;
        /// Lines run straight through the steps of pixels; creases where their two sides meet.
        const SMOOTH = 1 << 30;
        const FOLDS = 1 << 31;
        /// Completing cracks changes the cracks that it keeps.
        const EDITS = 1 << 32;

        /// Some factor of width or opacity is not 1: one of those that follow.
        const WEIGHT = 1 << 33;
        const KIND_WEIGHT = 1 << 34;
        /// Silhouettes in front of other objects differ from those in front of the same.
        const OUTER_WEIGHT = 1 << 35;
        const LIGHT_WEIGHT = 1 << 36;
        /// The widths that are drawn with object ids: pressure, and those of vertices.
        const WIDTH_MAP = 1 << 37;
        /// One of the two before.
        const SURFACE_WEIGHT = 1 << 38;
        const PERSPECTIVE_WEIGHT = 1 << 39;
        const NIB_WEIGHT = 1 << 40;
        const TAPER_WEIGHT = 1 << 41;
        /// Lines are thinner where they crowd.
        const BUDGET = 1 << 42;
        const FOG = 1 << 43;
        /// Lines fade with the distance from another one.
        const DISTANCE_FADE = 1 << 44;
        /// Near, middle and far have lines of their own; and whether their borders are found.
        const IN_LAYERS = 1 << 45;
        const DEPTH_BORDERS = 1 << 46;
        /// Creases are fainter where lines are simpler.
        const SIMPLIFIED_CREASES = 1 << 47;
        /// Whole objects are in a layer or simpler.
        const WIDTH_BY_OBJECTS = 1 << 48;
        /// The width changes along a line.
        const VARIED = 1 << 49;

        /// Tiles are drawn: the device has compute shaders. Otherwise all pixels are.
        const BLOCKS = 1 << 50;
        /// How cracks near a pixel are searched, see [`Search`].
        const NEIGHBORS = 1 << 51;
        const COLUMNS = 1 << 52;
        /// The color of lines depends on the surface that they belong to, or on the sign of creases;
        /// and whether they take the color a pixel inside of it, because its rim is mixed with others.
        const SURFACE = 1 << 53;
        const INWARD = 1 << 54;
        /// Drawing must know the pixel that owns a line.
        const OWNERS = 1 << 55;
        /// Lines are displaced.
        const BOIL = 1 << 56;
        /// Of the sheet that lines are drawn on: edges are rough; wide lines have streaks.
        const INK_BLEED = 1 << 57;
        const STREAKS = 1 << 58;
        /// Lines ink whole pixels.
        const HARD = 1 << 59;
        /// What is drawn beyond a distance counts as sky.
        const SKY_BEYOND = 1 << 60;
        /// Lines fade with the distance from what the middle of the view shows.
        const MIDDLE_DEPTH = 1 << 61;
        /// Convex and concave creases differ; and whether in the light.
        const EDGE_STYLES = 1 << 62;
        const LIT_EDGES = 1 << 63;
        /// Depth bends where normals make a crease.
        const BENDS = 1 << 64;
    }
}

/// The lowest bit of the flags of the depth map.
const MAP_FLAGS: u32 = 65;

impl LineKey {
    /// What is in the buffer of the visible range.
    pub const RANGE: Self = Self::VISIBLE_RANGE
        .union(Self::DEPTH_BORDERS)
        .union(Self::MIDDLE_DEPTH);

    /// What walking and finding read of a view and its lines.
    const FOUND: Self = Self::SAME_SIZE
        .union(Self::OBLIQUE)
        .union(Self::SKY_BEYOND)
        .union(Self::SILHOUETTES)
        .union(Self::CREASES)
        .union(Self::NORMALS)
        .union(Self::OBJECT_EDGES)
        .union(Self::SECTIONS)
        .union(Self::HIGHLIGHTS)
        .union(Self::MULTISAMPLED_PICTURE)
        .union(Self::LEDGES);

    /// Widths that change along a line. Where lines crowd, a shift of half a pixel cannot be seen.
    const VARYING: Self = Self::LIGHT_WEIGHT
        .union(Self::WIDTH_MAP)
        .union(Self::PERSPECTIVE_WEIGHT)
        .union(Self::NIB_WEIGHT)
        .union(Self::TAPER_WEIGHT);

    /// All factors of width and opacity.
    const WEIGHTS: Self = Self::VARYING
        .union(Self::KIND_WEIGHT)
        .union(Self::BUDGET)
        .union(Self::FOG)
        .union(Self::DISTANCE_FADE)
        .union(Self::IN_LAYERS)
        .union(Self::EDGE_STYLES)
        .union(Self::SIMPLIFIED_CREASES);

    /// What there is only on devices with compute shaders.
    const COMPUTED: Self = Self::WEIGHTS
        .union(Self::OUTER_WEIGHT)
        .union(Self::LIT_EDGES)
        .union(Self::DEPTH_BORDERS)
        .union(Self::MIDDLE_DEPTH)
        .union(Self::WIDTH_BY_OBJECTS)
        .union(Self::FINDS_BY_OBJECTS)
        .union(Self::COMPLETED)
        .union(Self::HOLDS)
        .union(Self::OVERSHOOTS)
        .union(Self::LEDGES)
        .union(Self::RIMS)
        .union(Self::CLOSED_GAPS)
        .union(Self::SMOOTH)
        .union(Self::BLOCKS);

    pub fn new(request: &LineRequest, by_fragments: bool) -> Self {
        let lines = &request.settings;
        let equations = lines.equations();
        let [silhouettes, creases] = equations.map(|of| of == Some(Equations::Corrected));
        let faithful = equations.map(|of| of == Some(Equations::Faithful));
        let object_edges = lines.objects.is_some() && request.ids;
        let rims = silhouettes && (creases || object_edges);
        let fewer = request.simplification.is_some_and(|s| s.threshold > 1.0);
        let multisampled = request.samples > 1;
        let search = request.search();
        let flags = [
            (request.view.depth_scale == Vec2::ONE, Self::SAME_SIZE),
            (request.oblique, Self::OBLIQUE),
            (request.view.raw.sky > 0.0, Self::SKY_BEYOND),
            (request.ids, Self::OBJECT_IDS),
            (request.object_styles, Self::OBJECT_STYLES),
            (request.visible_range, Self::VISIBLE_RANGE),
            (silhouettes, Self::SILHOUETTES),
            (creases, Self::CREASES),
            (creases && lines.finds_by_normals(), Self::NORMALS),
            (creases && lines.finds_bends(), Self::BENDS),
            (object_edges, Self::OBJECT_EDGES),
            (creases && request.sections && request.ids, Self::SECTIONS),
            (request.highlights, Self::HIGHLIGHTS),
            (
                request.highlights && multisampled,
                Self::MULTISAMPLED_PICTURE,
            ),
            (lines.fades(), Self::FADING),
            (fewer, Self::SIMPLIFIED_LINES),
            (request.finds_by_objects(), Self::FINDS_BY_OBJECTS),
            (request.jumps.is_some(), Self::JUMPS),
            (faithful[0], Self::FAITHFUL_SILHOUETTES),
            (faithful[1], Self::FAITHFUL_CREASES),
            (lines.links(), Self::COMPLETED),
            (lines.holds_lines(), Self::HOLDS),
            (lines.holds_lines() && request.motion, Self::MOTION),
            (lines.overshoots(), Self::OVERSHOOTS),
            (lines.joins(), Self::LEDGES),
            (rims && lines.links(), Self::RIMS),
            (lines.gap_closing > 0, Self::CLOSED_GAPS),
            (lines.is_smooth(), Self::SMOOTH),
            (true, Self::BLOCKS),
            (search == Search::Neighbors, Self::NEIGHBORS),
            (search == Search::Columns, Self::COLUMNS),
            (request.needs_owners(), Self::SURFACE),
            (request.needs_owners() && multisampled, Self::INWARD),
            (lines.boil.moves(), Self::BOIL),
            (lines.edge == LineEdge::Hard, Self::HARD),
            (request.sheet.ink_bleed > 0.0, Self::INK_BLEED),
            (request.sheet.dry_brush > 0.0, Self::STREAKS),
        ];
        let flags = flags.into_iter().chain(Self::weights(request));
        let set = flags.filter(|(on, _)| *on);
        let mut key: Self = set.map(|(_, flag)| flag).collect();
        if by_fragments {
            key.remove(Self::COMPUTED);
        }
        let lines = Self::SILHOUETTES | Self::CREASES | Self::OBJECT_EDGES;
        let folds = key.contains(Self::CREASES | Self::SMOOTH);
        key | key.when(lines, Self::CRACKS)
            | key.when(Self::WEIGHTS | Self::SMOOTH, Self::COMPLETED)
            | key.when(Self::WEIGHTS, Self::WEIGHT)
            | key.when(Self::VARYING, Self::VARIED)
            | key.when(Self::OBJECT_STYLES | Self::SURFACE, Self::OWNERS)
            | if folds { Self::FOLDS } else { Self::empty() }
            | Self::from_bits_retain(u128::from(request.map_flags) << MAP_FLAGS)
    }

    /// Which factors of width and opacity are not 1, and what they depend on.
    fn weights(request: &LineRequest) -> impl Iterator<Item = (bool, Self)> {
        let lines = &request.settings;
        let weight = &lines.weight;
        let kinds = [weight.outer, weight.inner, weight.crease, weight.object];
        let layers = request.layers.as_ref();
        let fainter = (request.simplification).is_some_and(|s| s.crease_opacity < 1.0);
        [
            (kinds != [1.0; 4], Self::KIND_WEIGHT),
            (weight.reads_ids(), Self::OUTER_WEIGHT),
            (weight.reads_normals(), Self::LIGHT_WEIGHT),
            (request.widths, Self::WIDTH_MAP),
            (weight.perspective > 0.0, Self::PERSPECTIVE_WEIGHT),
            (
                weight.nib_roundness < 1.0 && lines.is_smooth(),
                Self::NIB_WEIGHT,
            ),
            (weight.taper > 0.0, Self::TAPER_WEIGHT),
            (lines.ink_budget < 1.0, Self::BUDGET),
            (request.fog.is_some(), Self::FOG),
            (request.fade.is_some(), Self::DISTANCE_FADE),
            (request.middle, Self::MIDDLE_DEPTH),
            (layers.is_some(), Self::IN_LAYERS),
            (layers.is_some_and(|l| l.finds_borders), Self::DEPTH_BORDERS),
            (lines.has_edge_styles(), Self::EDGE_STYLES),
            (lines.has_lit_edges(), Self::LIT_EDGES),
            (fainter, Self::SIMPLIFIED_CREASES),
            (request.needs_objects(), Self::WIDTH_BY_OBJECTS),
        ]
        .into_iter()
    }

    /// These flags if the key has any of others.
    fn when(self, any: Self, flags: Self) -> Self {
        if self.intersects(any) {
            flags
        } else {
            Self::empty()
        }
    }

    /// The part that the search for blocks with cracks depends on.
    pub fn for_walk(self) -> Self {
        let map = Self::VISIBLE_RANGE | Self::from_bits_retain(u128::MAX << MAP_FLAGS);
        self & (Self::FOUND | Self::CRACKS | Self::CLOSED_GAPS | Self::JUMPS)
            | Self::DEPTH
            | Self::BOUNDS
            | self.when(Self::SILHOUETTES | Self::LEDGES, Self::EXCESS)
            | self.when(Self::OBJECT_EDGES | Self::SECTIONS, Self::OBJECT_IDS)
            | self.when(Self::JUMPS, self & map)
    }

    /// The part that finding depends on.
    pub fn for_find(self) -> Self {
        let simplified = Self::SIMPLIFIED_LINES | Self::FINDS_BY_OBJECTS;
        let objects = Self::OBJECT_EDGES | Self::OBJECT_STYLES | Self::SECTIONS;
        let stored = Self::COMPLETED | Self::HARD;
        self & (Self::FOUND
            | Self::BENDS
            | Self::OBJECT_STYLES
            | Self::FADING
            | simplified
            | stored)
            | Self::DEPTH
            | self.when(Self::SILHOUETTES | Self::CREASES, Self::EXCESS)
            | self.when(objects | Self::FINDS_BY_OBJECTS, Self::OBJECT_IDS)
            | self.when(Self::FINDS_BY_OBJECTS, Self::OBJECT_DEPTHS)
            | self.when(
                Self::FADING | Self::SIMPLIFIED_LINES,
                self & Self::VISIBLE_RANGE,
            )
    }

    /// The part that the faithful equations depend on.
    pub fn for_faithful(self) -> Self {
        let view = Self::SAME_SIZE | Self::OBLIQUE | Self::OBJECT_IDS | Self::OBJECT_STYLES;
        let faithful = Self::FAITHFUL_SILHOUETTES | Self::FAITHFUL_CREASES;
        self & (view | faithful | Self::FADING | Self::SURFACE)
            | Self::DEPTH
            | self.when(Self::FAITHFUL_CREASES, Self::NORMALS)
            | self.when(Self::FADING, self & Self::VISIBLE_RANGE)
    }

    /// The part that picking samples depends on.
    pub fn for_resolve(self) -> Self {
        let lit = Self::LIGHT_WEIGHT | Self::LIT_EDGES;
        self & (Self::OBLIQUE | Self::OBJECT_IDS | Self::WIDTH_MAP)
            | Self::DEPTH
            | self.when(Self::NORMALS | Self::FAITHFUL_CREASES | lit, Self::NORMALS)
            | self.when(Self::OBJECT_IDS, self & Self::SILHOUETTES)
    }

    /// The part that blending ink with the history depends on.
    pub fn for_accumulate(self) -> Self {
        self & Self::OBLIQUE | Self::DEPTH
    }

    /// The part that completing cracks depends on.
    pub fn for_settle(self) -> Self {
        let lines = Self::LEDGES | Self::RIMS | Self::CLOSED_GAPS | Self::SMOOTH | Self::FOLDS;
        let on_map = Self::PERSPECTIVE_WEIGHT | Self::IN_LAYERS | Self::SIMPLIFIED_CREASES;
        let reads = Self::DEPTH | Self::EDITS | self & Self::OBLIQUE;
        let by_objects = Self::OUTER_WEIGHT | Self::WIDTH_BY_OBJECTS;
        let of_view = Self::DEPTH_BORDERS | Self::MIDDLE_DEPTH;
        self & (lines | Self::WEIGHT | Self::WEIGHTS | Self::LIT_EDGES | of_view)
            | self.when(Self::FOLDS | Self::RIMS | Self::WEIGHT, reads)
            | self.when(Self::LIGHT_WEIGHT | Self::LIT_EDGES, Self::NORMALS)
            | self.when(Self::LIT_EDGES, self & Self::HARD)
            | self.when(Self::LIGHT_WEIGHT | Self::WIDTH_MAP, Self::SURFACE_WEIGHT)
            | self.when(by_objects, self & Self::OBJECT_IDS)
            | self.when(Self::WIDTH_BY_OBJECTS, Self::OBJECT_DEPTHS)
            | self.when(on_map, self & Self::VISIBLE_RANGE)
    }

    /// The part that keeping the lines of the last frames depends on.
    pub fn for_hold(self) -> Self {
        self.when(
            Self::MOTION,
            Self::MOTION | Self::DEPTH | self & Self::OBLIQUE,
        )
    }

    /// The part that extending loose ends depends on.
    pub fn for_ends(self) -> Self {
        Self::BLOCKS
            | Self::SMOOTH
            | self & Self::VARIED
            | self.when(Self::OWNERS, self & Self::CLOSED_GAPS)
    }

    /// What drawing and strokes have of the colors of lines and their sheet.
    fn for_ink(self) -> Self {
        let ink = Self::BOIL | Self::INK_BLEED | Self::STREAKS | Self::SURFACE | Self::INWARD;
        self & (ink | Self::EDGE_STYLES | Self::OBJECT_STYLES)
            | self.when(Self::OBJECT_STYLES, Self::OBJECT_IDS)
    }

    /// The part that drawing the strokes beyond loose ends depends on.
    pub fn for_strokes(self) -> Self {
        self.for_ink() | self & Self::TAPER_WEIGHT
    }

    /// The part that the search in columns depends on.
    pub fn for_columns(self) -> Self {
        self & (Self::COMPLETED | Self::SMOOTH | Self::VARIED | Self::BLOCKS)
    }

    /// The part that drawing depends on. The columns were searched with what cracks have.
    pub fn for_draw(self) -> Self {
        let searched = Self::COMPLETED | Self::SMOOTH | Self::VARIED;
        let drawn = self.for_ink()
            | self & (Self::NEIGHBORS | Self::COLUMNS | Self::BLOCKS | Self::OWNERS | Self::HARD)
            | self.when(Self::OWNERS, self & Self::CLOSED_GAPS);
        if self.contains(Self::COLUMNS) {
            drawn
        } else {
            drawn | self & searched
        }
    }

    /// The shader definitions of a pass, of its part of a key.
    pub fn defs(self) -> Vec<ShaderDefVal> {
        let flags = ShaderDefVal::UInt("MAP_FLAGS".into(), (self.bits() >> MAP_FLAGS) as u32);
        let map = self.contains(Self::JUMPS).then_some(flags);
        let names = self.iter_names().map(|(name, _)| name.into());
        names.chain(map).collect()
    }
}
