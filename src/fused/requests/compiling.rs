//! Whether pipelines are still compiling.

use bevy::{
    render::render_resource::{CachedPipelineState, CachedRenderPipelineId, PipelineCache},
    shader::ShaderCacheError,
};

use crate::lines::{FindPass, LinePasses};

pub(crate) fn are_compiling(passes: &LinePasses, cache: &PipelineCache) -> bool {
    let compute = |id| is_compiling(cache.get_compute_pipeline_state(id));
    let render = |id: CachedRenderPipelineId| is_compiling(cache.get_render_pipeline_state(id));
    let cracks = passes.cracks.as_ref().is_some_and(|cracks| {
        let columns = cracks.columns.is_some_and(render);
        let find = match &cracks.find {
            FindPass::Cells(cells) => cells.iter().any(|(_, id)| compute(*id)),
            FindPass::Pixels(id) => render(*id),
        };
        columns || find || render(cracks.draw)
    });
    let resolve = passes.resolve.is_some_and(render);
    let search = passes.search;
    let search = search.is_some_and(|ids| ids.into_iter().any(compute));
    let drawn = [passes.faithful, passes.history];
    resolve || search || cracks || drawn.into_iter().flatten().any(render)
}

pub(crate) fn is_compiling(state: &CachedPipelineState) -> bool {
    match state {
        CachedPipelineState::Queued | CachedPipelineState::Creating(_) => true,
        // The pipeline cache retries after these errors.
        CachedPipelineState::Err(error) => matches!(
            error,
            ShaderCacheError::ShaderNotLoaded(_) | ShaderCacheError::ShaderImportNotYetAvailable
        ),
        CachedPipelineState::Ok(_) => false,
    }
}
