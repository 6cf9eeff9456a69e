//! What a view requests of the lines, and the uniform that its passes read.

use bevy::{prelude::*, render::render_resource::ShaderType};

use crate::{
    depth::view::ViewUniform,
    lines::{
        modifiers::{
            LineFadeUniform, LineLayers, LineLayersUniform, LineSimplification,
            LineSimplificationUniform, SheetUniform,
        },
        settings::{
            BoilUniform, FogUniform, LineEdge, LinesUniform, MapJumps, Outlines, WeightUniform,
        },
    },
};

/// Cracks that a pass of `link.wgsl` continues lines by.
const LINK_STEPS: usize = 8;

/// How cracks near a pixel are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Search {
    /// One pixel around it, without a loop.
    #[default]
    Neighbors,
    /// All pixels within reach.
    Around,
    /// The best crack of each column within reach, see `columns.wgsl`.
    Columns,
}

/// `Grid` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct Grid {
    pub rect: IVec4,
    pub from_viewport: Vec4,
    pub reach: i32,
    pub inked: i32,
    pub jump_least: f32,
    pub jump_radius: f32,
    pub words: IVec2,
    pub steps: i32,
    pub min_length: i32,
    pub gap_closing: i32,
    pub hold_frames: i32,
    pub past_size: IVec2,
    pub overshoot: f32,
}

/// Columns and rows of a block.
const BLOCK: [u32; 2] = [4, 32];

/// Blocks in a workgroup of `walk.wgsl`, side by side: two for each of 32 invocations.
pub(crate) const WORKGROUP: u32 = 64;

/// Number of blocks across and down a part of the depth texture.
pub(crate) fn blocks(rect: UVec4) -> UVec2 {
    UVec2::new(
        rect.z.div_ceil(BLOCK[0]).max(1),
        rect.w.div_ceil(BLOCK[1]).max(1),
    )
}

/// Words of 32 pixels across and down the part of the depth texture with this rectangle.
pub(crate) fn words(rect: UVec4) -> UVec2 {
    UVec2::new(rect.z.div_ceil(32), rect.w.div_ceil(32))
}

/// `LinePass` of `pass.wgsl`, the uniform of the passes that find and draw lines.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct LinePassUniform {
    pub view: ViewUniform,
    pub lines: LinesUniform,
    pub grid: Grid,
    pub weight: WeightUniform,
    pub fog: FogUniform,
    pub fade: LineFadeUniform,
    pub layers: LineLayersUniform,
    pub simplification: LineSimplificationUniform,
    pub boil: BoilUniform,
    pub history: HistoryUniform,
    pub sheet: SheetUniform,
}

/// Frames that a line may be missing in: the same in `history.wgsl`.
const MISSING: u32 = 16;

/// `History` of `history.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HistoryUniform {
    blend_factor: f32,
    spacing: i32,
    tile_frames: u32,
    unused: u32,
}

/// The history of a view's lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HistoryRequest {
    /// Fraction of each frame where lines move.
    pub blend_factor: f32,
    /// Number of camera cuts so far.
    pub cuts: u32,
}

impl HistoryRequest {
    /// The settings as shaders take them. `reach`: pixels of the grid within which lines are
    /// drawn around their owners.
    fn uniform(&self, reach: i32, is_new: bool) -> HistoryUniform {
        HistoryUniform {
            blend_factor: if is_new { 1.0 } else { self.blend_factor },
            spacing: (reach / 2).max(1),
            tile_frames: MISSING + 1,
            unused: 0,
        }
    }
}

/// On a view in the render world: a request for its lines, written in every frame by
/// [`PrepareComics::Choose`](crate::schedule::PrepareComics::Choose).
#[derive(Component, Clone, Debug)]
pub(crate) struct LineRequest {
    pub camera: Entity,
    pub settings: Outlines,
    pub view: ViewUniform,
    pub lines: LinesUniform,
    pub weight: WeightUniform,
    pub boil: BoilUniform,
    /// The history that lines are blended with.
    pub history: Option<HistoryRequest>,
    /// Number of camera cuts so far.
    pub cuts: u32,
    /// The engine's motion vectors can be read.
    pub motion: bool,
    /// The fog that lines fade into.
    pub fog: Option<FogUniform>,
    /// How they fade with the distance from another one.
    pub fade: Option<LineFadeUniform>,
    /// That distance is the one in the middle of the view, smoothed over time.
    pub middle: bool,
    /// How they differ between the depth layers.
    pub layers: Option<LineLayers>,
    /// How they are simplified.
    pub simplification: Option<LineSimplification>,
    /// The sheet that lines are drawn on.
    pub sheet: SheetUniform,
    /// Size in pixels of the depth texture, and its samples per pixel.
    pub depth_size: UVec2,
    pub samples: u32,
    /// Size of the viewport in physical pixels.
    pub size: UVec2,
    /// The part of the depth texture that the main pass draws: x, y, width, height.
    pub rect: UVec4,
    /// By how much the engine has moved the main pass in this frame, in its pixels,
    /// under temporal anti-aliasing.
    pub jitter: Option<Vec2>,
    /// Distance in physical pixels within which lines are searched around a pixel.
    pub reach: i32,
    /// Cracks that a line continues along weak edges.
    pub steps: i32,
    /// Borders of pixels that a piece of line must have.
    pub min_length: i32,
    /// Pixels of the grid by which loose ends are extended.
    pub extension: f32,
    pub oblique: bool,
    /// The depth map spans the visible range.
    pub visible_range: bool,
    /// Object ids are drawn and can be read.
    pub ids: bool,
    /// Meshes are divided into sections, or may be later.
    pub sections: bool,
    /// The lines are those of highlighted objects.
    pub highlights: bool,
    /// Some object has an `OutlineStyle` or `NoOutlines`.
    pub object_styles: bool,
    /// The widths of lines are drawn and can be read.
    pub widths: bool,
    /// Physical pixels from a pixel within which the fused pass reads lines.
    pub line_reach: f32,
    /// Places that count as inked, besides lines: those of [`AffectedArea::AtJumps`].
    ///
    /// [`AffectedArea::AtJumps`]: crate::effect::AffectedArea::AtJumps
    pub jumps: Option<MapJumps>,
    /// Flags of the depth map.
    pub map_flags: u32,
}

impl LineRequest {
    /// Pixels within which cracks are searched around a pixel.
    pub fn grid_reach(&self) -> i32 {
        let aligned = self.view.depth_scale == Vec2::ONE
            && self.jitter.is_none()
            && !self.settings.boil.moves();
        // Between the pixels of the grid, cracks half a pixel further away count.
        self.reach.max(1) + i32::from(!aligned)
    }

    /// Whether the width and opacity of lines depend on the depths of objects in the depth map.
    pub fn needs_objects(&self) -> bool {
        let layers = self.layers.is_some_and(|layers| layers.by_objects);
        self.ids && (layers || self.simplification.is_some_and(|s| s.by_objects))
    }

    /// Whether edges must be stronger where their object is simpler.
    pub fn finds_by_objects(&self) -> bool {
        let by_objects = |s: LineSimplification| s.threshold > 1.0 && s.by_objects;
        self.ids && self.simplification.is_some_and(by_objects)
    }

    /// Whether the pixels that own lines are drawn, and which creases are convex, for the color of
    /// lines.
    pub fn needs_owners(&self) -> bool {
        let own_colors = |layers: LineLayers| layers.has_colors();
        self.settings.has_surface_colors()
            || self.settings.has_edge_styles()
            || self.layers.is_some_and(own_colors)
    }

    /// Number of passes that link cracks.
    pub fn links(&self) -> usize {
        (self.steps as usize).div_ceil(LINK_STEPS)
    }

    /// Number of passes that link cracks, and that join lines.
    pub fn joined(&self) -> usize {
        self.links() + usize::from(self.settings.joins())
    }

    /// Number of passes that copy the planes of cracks and add to them.
    pub fn copies(&self) -> usize {
        self.joined() + usize::from(self.settings.gap_closing > 0)
    }

    /// Columns leave out too much where lines are hardly wider than a pixel of the grid.
    pub fn search(&self) -> Search {
        let reach = self.reach as f32 * self.view.depth_scale.min_element();
        let hard = self.settings.edge == LineEdge::Hard;
        if self.grid_reach() == 1 && !hard {
            Search::Neighbors
        } else if reach < 2.0 || hard {
            Search::Around
        } else {
            Search::Columns
        }
    }

    fn grid(&self, past_size: UVec2) -> Grid {
        let scale = self.view.depth_scale;
        let jitter = self.jitter.unwrap_or(Vec2::ZERO);
        // In columns, and where lines leave their cracks, cracks half a pixel further away count.
        let beyond = self.settings.is_smooth() && self.search() != Search::Neighbors;
        let reach = self.grid_reach() + i32::from(beyond);
        let read = self.line_reach + self.boil.amplitude;
        let read = (read * scale.max_element() + self.extension).ceil() as i32;
        let jumps = self.jumps.unwrap_or(MapJumps {
            least: f32::MAX,
            radius: 1.0,
        });
        Grid {
            rect: self.rect.as_ivec4(),
            // The engine draws at p - jitter what belongs at p, and temporal anti-aliasing
            // undoes that in the picture. In orthographic views the engine moves by an
            // amount that grows with distance: this offset is right at a distance of the
            // view's width.
            from_viewport: Vec4::new(scale.x, scale.y, -jitter.x, -jitter.y),
            reach,
            // Smooth lines leave their cracks by half a pixel.
            inked: (reach + 1 + i32::from(self.settings.is_smooth()) + read)
                .max(jumps.radius.ceil() as i32),
            jump_least: jumps.least,
            jump_radius: jumps.radius.ceil(),
            words: words(self.rect).as_ivec2(),
            steps: self.steps,
            min_length: self.min_length,
            gap_closing: self.settings.gap_closing as i32,
            hold_frames: self.settings.hold_frames as i32,
            past_size: past_size.as_ivec2(),
            overshoot: self.extension,
        }
    }

    /// `is_new`: the history has nothing in it yet. `past_size`: size of the grid of the last frame,
    /// if lines stay.
    pub fn uniform(&self, is_new: bool, past_size: UVec2) -> LinePassUniform {
        LinePassUniform {
            view: self.view,
            lines: self.lines,
            grid: self.grid(past_size),
            weight: self.weight,
            fog: self.fog.unwrap_or_default(),
            fade: self.fade.unwrap_or_default(),
            layers: self.layers.map(LineLayers::uniform).unwrap_or_default(),
            simplification: (self.simplification)
                .map(LineSimplification::uniform)
                .unwrap_or_default(),
            boil: self.boil,
            history: (self.history)
                .map(|history| history.uniform(self.grid_reach(), is_new))
                .unwrap_or_default(),
            sheet: self.sheet,
        }
    }
}
