//! The pipelines of the lines of a view.

use bevy::{
    ecs::system::SystemParam,
    prelude::*,
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
    key::{LineKey, LinePass, SearchPass},
    pipelines::LineShaders,
    request::LineRequest,
    tiles::TileList,
};

/// The pipelines of one view's lines.
#[derive(Component, Clone, Debug)]
pub(crate) struct LinePasses {
    pub key: LineKey,
    /// Picks one sample of every pixel, if the view is multisampled.
    pub resolve: Option<CachedRenderPipelineId>,
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
        match &self.cracks {
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

/// The pipelines that find cracks.
#[derive(Clone, Debug)]
pub(crate) enum FindPass {
    /// In the cells that the search for blocks has listed; and the passes that complete them.
    Cells(Vec<(SearchPass, CachedComputePipelineId)>),
    /// In all pixels: without compute shaders.
    Pixels(CachedRenderPipelineId),
}

/// The pipelines of the lines along cracks.
#[derive(Clone, Debug)]
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
        let has = |flag| key.intersects(flag);
        let shaders = &*self.shaders;
        let (computes, renders) = (&mut self.computes, &mut self.renders);
        let mut compute = |pass| computes.specialize(cache, shaders, pass);
        let mut render =
            |pass: LinePass| renders.specialize(cache, shaders, (pass, pass.part(key)));
        let samples = request.samples;
        let faithful = LineKey::FAITHFUL_SILHOUETTES | LineKey::FAITHFUL_CREASES;
        let mut passes = LinePasses {
            key,
            resolve: (samples > 1).then(|| render(LinePass::Resolve { samples })),
            search: (has_compute && has(LineKey::CRACKS | LineKey::JUMPS))
                .then(|| [SearchPass::Walk(key.for_walk()), SearchPass::Tiles].map(&mut compute)),
            cracks: None,
            faithful: has(faithful).then(|| render(LinePass::Faithful)),
            history: None,
        };
        if has(LineKey::CRACKS) {
            let find = if has_compute {
                let links = request.links();
                if links == 1 {
                    // Where lines continue further, it does not have to compile first.
                    compute(SearchPass::Link { last: false });
                }
                let cells = SearchPass::in_cells(key, links).map(|pass| (pass, compute(pass)));
                FindPass::Cells(cells.collect())
            } else {
                FindPass::Pixels(render(LinePass::Find))
            };
            passes.cracks = Some(CrackPasses {
                find,
                columns: has(LineKey::COLUMNS).then(|| render(LinePass::Columns)),
                draw: render(LinePass::Draw),
                strokes: has(LineKey::OVERSHOOTS).then(|| render(LinePass::Strokes)),
            });
        }
        if request.history.is_some() && passes.has_ink() {
            let tiled = passes.are_tiles_complete();
            passes.history = Some(render(LinePass::Accumulate { tiled }));
        }
        passes
    }
}
