//! The pipelines of the lines of a view.

use bevy::{
    ecs::{
        component::Component,
        system::{Res, ResMut, SystemParam},
    },
    render::{
        render_resource::{
            CachedComputePipelineId, CachedRenderPipelineId, PipelineCache,
            SpecializedComputePipelines, SpecializedRenderPipelines,
        },
        renderer::RenderDevice,
    },
};

use super::{
    cracks::largest_buffer,
    find::{ResolveKey, ResolvePipeline},
    history::{HistoryKey, HistoryPipeline},
    key::LineKey,
    pipelines::{LinePass, LineShaders, SearchPass},
    request::LineRequest,
    tiles::TileList,
};

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
    pub history: Option<CachedRenderPipelineId>,
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
    pub hold: Option<CachedComputePipelineId>,
    /// Closes gaps.
    pub close_gaps: Option<CachedComputePipelineId>,
    /// Measures how densely lines lie: in small squares, and in large ones.
    pub measure: Option<[CachedComputePipelineId; 2]>,
    /// Notes which cracks meet at corners, before lines are followed.
    pub corners: Option<CachedComputePipelineId>,
    /// Leaves out what is not part of a line, and makes lines smooth.
    pub settle: Option<CachedComputePipelineId>,
    /// Extends loose ends.
    pub ends: Option<CachedComputePipelineId>,
}

impl CellPasses {
    /// `continues`: lines continue along weak edges.
    fn new(
        key: LineKey,
        continues: bool,
        compute: &mut impl FnMut(SearchPass) -> CachedComputePipelineId,
    ) -> Self {
        let find = compute(SearchPass::Cells(key.for_find()));
        let link = continues.then(|| [false, true].map(|last| compute(SearchPass::Link { last })));
        let measure = (key.contains(LineKey::BUDGET))
            .then(|| [false, true].map(|coarse| compute(SearchPass::Measure { coarse })));
        let mut with = |flag, pass| key.contains(flag).then(|| compute(pass));
        Self {
            find,
            link,
            join: with(LineKey::LEDGES, SearchPass::Join),
            hold: with(LineKey::HOLDS, SearchPass::Hold(key.for_hold())),
            close_gaps: with(LineKey::BRIDGED, SearchPass::CloseGaps),
            measure,
            corners: with(LineKey::COMPLETED, SearchPass::Corners),
            settle: with(LineKey::COMPLETED, SearchPass::Settle(key.for_settle())),
            ends: with(LineKey::OVERSHOOTS, SearchPass::Ends(key.for_ends())),
        }
    }

    pub fn ids(&self) -> impl Iterator<Item = CachedComputePipelineId> {
        let pairs = [self.link, self.measure].into_iter().flatten().flatten();
        let rest = [self.join, self.hold, self.close_gaps];
        let last = [self.corners, self.settle, self.ends];
        let rest = rest.into_iter().chain(last).flatten();
        [self.find].into_iter().chain(pairs).chain(rest)
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
    /// `None` if only neighboring pixels are searched.
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
    histories: ResMut<'w, SpecializedRenderPipelines<HistoryPipeline>>,
    history: Res<'w, HistoryPipeline>,
    device: Res<'w, RenderDevice>,
}

impl LinePipelines<'_> {
    /// Whether the device has what `walk.wgsl`, `tiles.wgsl` and `cells.wgsl` bind.
    fn has_compute(&self, request: &LineRequest) -> bool {
        let limits = self.device.limits();
        // Those of `settle.wgsl`.
        const BUFFERS: u32 = 7;
        limits.max_compute_workgroup_size_x > 0
            && limits.max_storage_textures_per_shader_stage > 0
            && limits.max_storage_buffers_per_shader_stage >= BUFFERS
            && limits.max_storage_buffer_binding_size >= largest_buffer(request.rect)
    }

    /// The pipelines for a request; new ones are queued for compilation.
    pub fn get(&mut self, cache: &PipelineCache, request: &LineRequest) -> LinePasses {
        let has_compute = self.has_compute(request);
        let key = LineKey::new(request, !has_compute);
        let has = |flag| key.contains(flag);
        let computes = &mut self.computes;
        let mut render = |pass| {
            let renders = &mut self.renders;
            renders.specialize(cache, &self.shaders, (pass, pass.part(key)))
        };
        let resolve = (request.samples > 1).then(|| {
            let key = ResolveKey::new(key, request.samples);
            (key, self.resolves.specialize(cache, &self.resolve, key))
        });
        let faithful = LineKey::FAITHFUL_SILHOUETTES | LineKey::FAITHFUL_CREASES;
        let faithful = key.intersects(faithful).then(|| render(LinePass::Faithful));
        let cracks = has(LineKey::CRACKS).then(|| CrackPasses {
            find: if has_compute {
                let mut compute = |pass| computes.specialize(cache, &self.shaders, pass);
                FindPass::Cells(CellPasses::new(key, request.steps > 0, &mut compute))
            } else {
                FindPass::Pixels(render(LinePass::Find))
            },
            columns: has(LineKey::COLUMNS).then(|| render(LinePass::Columns)),
            draw: render(LinePass::Draw),
            strokes: has(LineKey::OVERSHOOTS).then(|| render(LinePass::Strokes)),
        });
        let searches = has_compute && key.intersects(LineKey::CRACKS | LineKey::JUMPS);
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
            history: None,
        };
        if request.history.is_some() && passes.has_ink() {
            let key = HistoryKey {
                oblique: key.contains(LineKey::OBLIQUE),
                tiled: passes.are_tiles_complete(),
            };
            let history = self.histories.specialize(cache, &self.history, key);
            passes.history = Some(history);
        }
        passes
    }
}
