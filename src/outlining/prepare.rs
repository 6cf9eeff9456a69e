//! From a plan to this frame's outlines: pipelines and textures.

use bevy::{
    ecs::system::{Res, ResMut, SystemParam},
    math::UVec2,
    render::{
        render_resource::{PipelineCache, SpecializedRenderPipelines, TextureFormat},
        renderer::RenderDevice,
    },
};

use super::{
    FloodPass, FloodPipeline, GATHER_REACH, OutlineKey, OutlinePass, OutlinePipeline, ViewTexture,
};
use crate::{
    objects::{ObjectStyleBuffer, ObjectStyles},
    view::Plan,
};

/// What the outlines' passes are made of.
#[derive(SystemParam)]
pub(crate) struct Outlining<'w> {
    edge_pipelines: ResMut<'w, SpecializedRenderPipelines<OutlinePipeline>>,
    flood_pipelines: ResMut<'w, SpecializedRenderPipelines<FloodPipeline>>,
    edge_pipeline: Res<'w, OutlinePipeline>,
    flood_pipeline: Res<'w, FloodPipeline>,
    pub buffer: ResMut<'w, ObjectStyleBuffer>,
    pub styles: Res<'w, ObjectStyles>,
}

impl Outlining<'_> {
    /// This frame's outlines of a view; what still fits is kept.
    pub fn prepare(
        &mut self,
        old: Option<OutlinePass>,
        cache: &PipelineCache,
        device: &RenderDevice,
        plan: &Plan,
        (samples, size): (u32, UVec2),
        oblique: bool,
        same_size: bool,
        reach: i32,
    ) -> Option<OutlinePass> {
        let key = OutlineKey {
            same_size,
            ..OutlineKey::new(plan, samples, oblique)?
        };
        let new_texture =
            |label| ViewTexture::new(device, label, size, 1, TextureFormat::Rgba16Uint);
        let (edges, flood) = old.map_or((None, None), |old| (Some(old.edges), old.flood));
        // A sketch asks several times a pixel, between pixels: a flood answers
        // each time with four lines.
        let sketched = plan.sketch.is_some() && reach > 0;
        let flood = (reach > GATHER_REACH || sketched).then(|| FloodPass {
            first: self
                .flood_pipelines
                .specialize(cache, &self.flood_pipeline, true),
            next: self
                .flood_pipelines
                .specialize(cache, &self.flood_pipeline, false),
            strides: FloodPass::strides(reach),
            textures: flood
                .map(|flood| flood.textures)
                .filter(|textures| textures[0].fits(size, 1))
                .unwrap_or_else(|| [new_texture("comics_lines_a"), new_texture("comics_lines_b")]),
        });
        Some(OutlinePass {
            key,
            pipeline: self
                .edge_pipelines
                .specialize(cache, &self.edge_pipeline, key),
            edges: edges
                .filter(|edges| edges.fits(size, 1))
                .unwrap_or_else(|| new_texture("comics_edges")),
            flood,
        })
    }
}
