//! Requests for a view's lines, and the pipelines that find them.

use bevy::{
    ecs::{
        component::Component,
        entity::Entity,
        system::{Res, ResMut, SystemParam},
    },
    math::{UVec2, UVec4, Vec2, Vec4},
    render::{
        render_resource::{
            CachedComputePipelineId, CachedRenderPipelineId, PipelineCache,
            SpecializedComputePipelines, SpecializedRenderPipelines,
        },
        renderer::RenderDevice,
    },
};

use super::{
    abstraction::LineAbstraction,
    boil::BoilUniform,
    focus::LineFocusUniform,
    fog::FogUniform,
    key::{LINK_STEPS, LineKey, Search},
    layer_lines::LineLayers,
    memory::{MemoryKey, MemoryPipeline, MemoryRequest},
    pass::{Grid, LinePassUniform},
    pipelines::{LinePass, LineShaders, SearchPass},
    resolve::{ResolveKey, ResolvePipeline},
    settings::{LinesUniform, MapJumps, Outlines},
    sheet::SheetUniform,
    store::{largest_buffer, words},
    tiles::TileList,
    weight::WeightUniform,
};
use crate::depth::view::ViewUniform;

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
    /// What lines remember.
    pub memory: Option<MemoryRequest>,
    /// Number of camera cuts so far.
    pub cuts: u32,
    /// The engine's motion vectors can be read.
    pub motion: bool,
    /// The fog that lines fade into.
    pub fog: Option<FogUniform>,
    /// What lines are in focus.
    pub focus: Option<LineFocusUniform>,
    /// How they differ between the depth layers.
    pub layers: Option<LineLayers>,
    /// How they follow the abstraction of the view.
    pub abstraction: Option<LineAbstraction>,
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
    pub specks: i32,
    /// Pixels of the grid by which loose ends are extended.
    pub extension: f32,
    pub oblique: bool,
    /// The depth map spans the visible range.
    pub visible_range: bool,
    /// Object ids are drawn and can be read.
    pub ids: bool,
    /// Some mesh is divided into sections.
    pub sections: bool,
    /// The lines are those of marked objects.
    pub marks: bool,
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

    /// Whether lines know the places of objects in the depth map.
    pub fn reads_places(&self) -> bool {
        let layers = self.layers.is_some_and(|layers| layers.by_objects);
        layers || self.abstraction.is_some_and(|a| a.by_objects)
    }

    /// Whether edges must be stronger where their object is abstract.
    pub fn abstracts_objects(&self) -> bool {
        let by_objects = |a: LineAbstraction| a.threshold > 1.0 && a.by_objects;
        self.ids && self.abstraction.is_some_and(by_objects)
    }

    /// Whether the pixels that own lines are drawn, for the colour of lines.
    pub fn needs_owners(&self) -> bool {
        let own_colors = |layers: LineLayers| layers.has_colors();
        self.settings.color.is_surface() || self.layers.is_some_and(own_colors)
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
        if self.grid_reach() == 1 {
            Search::Neighbours
        } else if reach < 2.0 {
            Search::Around
        } else {
            Search::Columns
        }
    }

    fn grid(&self) -> Grid {
        let scale = self.view.depth_scale;
        let jitter = self.jitter.unwrap_or(Vec2::ZERO);
        // In columns, and where lines leave their cracks, cracks half a pixel further away count.
        let beyond = self.settings.smooth && self.search() != Search::Neighbours;
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
            inked: (reach + 1 + i32::from(self.settings.smooth) + read)
                .max(jumps.radius.ceil() as i32),
            jump_least: jumps.least,
            jump_radius: jumps.radius.ceil(),
            words: words(self.rect).as_ivec2(),
            steps: self.steps,
            specks: self.specks,
            bridge: self.settings.gap_closing as i32,
            persistence: self.settings.hold_frames as i32,
            overshoot: self.extension,
            unused: 0,
        }
    }

    /// `is_new`: the memory has nothing in it yet.
    pub fn uniform(&self, is_new: bool) -> LinePassUniform {
        LinePassUniform {
            view: self.view,
            lines: self.lines,
            grid: self.grid(),
            weight: self.weight,
            fog: self.fog.unwrap_or_default(),
            focus: self.focus.unwrap_or_default(),
            layers: self.layers.map(LineLayers::uniform).unwrap_or_default(),
            abstraction: (self.abstraction)
                .map(|a| a.uniform(self.view.flip != 0))
                .unwrap_or_default(),
            boil: self.boil,
            memory: (self.memory)
                .map(|memory| memory.uniform(self.grid_reach(), is_new))
                .unwrap_or_default(),
            sheet: self.sheet,
        }
    }
}

/// The pipelines of one view's lines.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct LinePasses {
    pub key: LineKey,
    /// Picks one sample of every pixel, if the view is multisampled.
    pub resolve: Option<(ResolveKey, CachedRenderPipelineId)>,
    /// Looks for blocks with cracks or jumps, and lists their cells and the tiles near
    /// them. `None`: all pixels are drawn.
    pub search: Option<[CachedComputePipelineId; 2]>,
    /// Finds and draws the lines along cracks, if there are any.
    pub cracks: Option<CrackPasses>,
    /// Draws the faithful lines, if there are any.
    pub faithful: Option<CachedRenderPipelineId>,
    /// Mixes the ink with that of the frames before.
    pub memory: Option<CachedRenderPipelineId>,
}

impl LinePasses {
    /// Whether any line is drawn; if not, only tiles are listed.
    pub fn has_ink(&self) -> bool {
        self.cracks.is_some() || self.faithful.is_some()
    }

    /// The last list of tiles that a pass draws.
    pub fn last_list(&self) -> TileList {
        match self.cracks {
            Some(CrackPasses {
                columns: Some(_), ..
            }) => TileList::Columns,
            _ => TileList::Inked,
        }
    }

    /// Whether there is a list of all tiles that may have ink.
    pub fn are_tiles_complete(&self) -> bool {
        self.search.is_some() && self.faithful.is_none()
    }
}

/// The pipelines that find cracks in cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellPasses {
    pub find: CachedComputePipelineId,
    /// Continues lines by as many steps as a pass goes, and by the steps that are left.
    pub link: Option<[CachedComputePipelineId; 2]>,
    /// Joins lines over faces that are thinner than a pixel.
    pub join: Option<CachedComputePipelineId>,
    /// Keeps the lines of the last frames.
    pub persist: Option<CachedComputePipelineId>,
    /// Closes gaps.
    pub bridge: Option<CachedComputePipelineId>,
    /// Leaves out what is not part of a line, and makes lines smooth.
    pub settle: Option<CachedComputePipelineId>,
    /// Extends loose ends.
    pub ends: Option<CachedComputePipelineId>,
}

impl CellPasses {
    /// `continues`: lines continue along weak edges.
    fn new(
        key: &LineKey,
        continues: bool,
        compute: &mut impl FnMut(SearchPass) -> CachedComputePipelineId,
    ) -> Self {
        Self {
            find: compute(SearchPass::Cells(key.for_find())),
            link: continues.then(|| [false, true].map(|last| compute(SearchPass::Link { last }))),
            join: key.ledges.then(|| compute(SearchPass::Join)),
            persist: (key.persists).then(|| compute(SearchPass::Persist(key.for_persist()))),
            bridge: key.bridged.then(|| compute(SearchPass::Bridge)),
            settle: key
                .settles()
                .then(|| compute(SearchPass::Settle(key.for_settle()))),
            ends: key
                .overshoots
                .then(|| compute(SearchPass::Ends(key.for_ends()))),
        }
    }

    pub fn ids(&self) -> impl Iterator<Item = CachedComputePipelineId> {
        let link = self.link.into_iter().flatten();
        let rest = [self.join, self.persist, self.bridge, self.settle, self.ends];
        let rest = rest.into_iter().flatten();
        [self.find].into_iter().chain(link).chain(rest)
    }
}

/// The pipelines that find cracks.
#[derive(Clone, Copy, Debug)]
pub(crate) enum FindPass {
    /// In the cells that the search for blocks has listed.
    Cells(CellPasses),
    /// In all pixels: without compute shaders.
    Pixels(CachedRenderPipelineId),
}

/// The pipelines of the lines along cracks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CrackPasses {
    pub find: FindPass,
    /// `None` if only neighbouring pixels are searched.
    pub columns: Option<CachedRenderPipelineId>,
    pub draw: CachedRenderPipelineId,
    /// Draws the strokes beyond loose ends.
    pub strokes: Option<CachedRenderPipelineId>,
}

/// Specializes the pipelines for requests.
#[derive(SystemParam)]
pub(crate) struct LinePipelines<'w> {
    computes: ResMut<'w, SpecializedComputePipelines<LineShaders>>,
    renders: ResMut<'w, SpecializedRenderPipelines<LineShaders>>,
    shaders: Res<'w, LineShaders>,
    resolves: ResMut<'w, SpecializedRenderPipelines<ResolvePipeline>>,
    resolve: Res<'w, ResolvePipeline>,
    memories: ResMut<'w, SpecializedRenderPipelines<MemoryPipeline>>,
    memory: Res<'w, MemoryPipeline>,
    device: Res<'w, RenderDevice>,
}

impl LinePipelines<'_> {
    /// Whether the device has what `walk.wgsl`, `tiles.wgsl` and `cells.wgsl` bind.
    fn has_compute(&self, request: &LineRequest) -> bool {
        let limits = self.device.limits();
        // Those of `ends.wgsl`.
        const BUFFERS: u32 = 6;
        limits.max_compute_workgroup_size_x > 0
            && limits.max_storage_textures_per_shader_stage > 0
            && limits.max_storage_buffers_per_shader_stage >= BUFFERS
            && limits.max_storage_buffer_binding_size >= largest_buffer(request.rect)
    }

    /// The pipelines for a request; new ones are queued for compilation.
    pub fn get(&mut self, cache: &PipelineCache, request: &LineRequest) -> LinePasses {
        let has_compute = self.has_compute(request);
        let key = LineKey::new(request, !has_compute);
        let computes = &mut self.computes;
        let mut render = |pass| {
            let renders = &mut self.renders;
            renders.specialize(cache, &self.shaders, (pass, pass.part(key)))
        };
        let resolve = (request.samples > 1).then(|| {
            let key = ResolveKey::new(&key, request.samples);
            (key, self.resolves.specialize(cache, &self.resolve, key))
        });
        let faithful = key.has_faithful().then(|| render(LinePass::Faithful));
        let cracks = key.has_cracks().then(|| CrackPasses {
            find: if has_compute {
                let mut compute = |pass| computes.specialize(cache, &self.shaders, pass);
                FindPass::Cells(CellPasses::new(&key, request.steps > 0, &mut compute))
            } else {
                FindPass::Pixels(render(LinePass::Find))
            },
            columns: (key.search == Search::Columns).then(|| render(LinePass::Columns)),
            draw: render(LinePass::Draw),
            strokes: key.overshoots.then(|| render(LinePass::Strokes)),
        });
        let searches = has_compute && (key.has_cracks() || key.jumps);
        let search = searches.then(|| {
            let passes = [SearchPass::Walk(key.for_walk()), SearchPass::Tiles];
            passes.map(|pass| computes.specialize(cache, &self.shaders, pass))
        });
        let mut passes = LinePasses {
            key,
            resolve,
            search,
            cracks,
            faithful,
            memory: None,
        };
        if request.memory.is_some() && passes.has_ink() {
            let key = MemoryKey {
                oblique: key.oblique,
                tiled: passes.are_tiles_complete(),
            };
            let memory = self.memories.specialize(cache, &self.memory, key);
            passes.memory = Some(memory);
        }
        passes
    }
}
