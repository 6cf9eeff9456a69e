//! Requests for a view's lines, and the pipelines that find them.

use bevy::{
    ecs::{
        component::Component,
        entity::Entity,
        system::{Res, ResMut, SystemParam},
    },
    math::UVec2,
    render::render_resource::{
        CachedRenderPipelineId, PipelineCache, ShaderType, SpecializedRenderPipelines,
    },
};

use super::{
    pipelines::{FloodPipeline, GATHER_REACH, OutlineKey, OutlinePipeline},
    settings::{LineSettings, LinesUniform},
};
use crate::depth::view::ViewUniform;

/// On a view in the render world: a request for its lines, written in every frame by
/// [`PrepareComics::Choose`](crate::schedule::PrepareComics::Choose).
#[derive(Component, Clone, Debug)]
pub(crate) struct LineRequest {
    pub camera: Entity,
    pub settings: LineSettings,
    pub view: ViewUniform,
    pub lines: LinesUniform,
    /// Size in pixels of the depth texture, and its samples per pixel.
    pub size: UVec2,
    pub samples: u32,
    pub oblique: bool,
    /// The depth map spans the visible range.
    pub visible_range: bool,
    /// Object ids are drawn and can be read.
    pub ids: bool,
    /// Some object has an `OutlineStyle` or `NoOutlines`.
    pub object_styles: bool,
    /// An effect reads lines at positions between pixels, several times per pixel.
    pub anywhere: bool,
}

impl LineRequest {
    /// Whether a flood finds the nearest lines. Reading a position between pixels then
    /// takes four lookups, whatever the width of the lines.
    pub fn floods(&self) -> bool {
        self.lines.reach > GATHER_REACH || (self.anywhere && self.lines.reach > 0)
    }
}

/// The uniform of the passes that find lines.
#[derive(ShaderType, Clone, Copy, Debug, Default)]
pub(crate) struct LinePassUniform {
    pub view: ViewUniform,
    pub lines: LinesUniform,
}

/// The pipelines of one view's lines.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct LinePasses {
    pub key: OutlineKey,
    pub detect: CachedRenderPipelineId,
    /// The first and all further steps of the flood, if there is one.
    pub flood: Option<[CachedRenderPipelineId; 2]>,
}

/// Specializes the pipelines for requests.
#[derive(SystemParam)]
pub(crate) struct LinePipelines<'w> {
    edges: ResMut<'w, SpecializedRenderPipelines<OutlinePipeline>>,
    floods: ResMut<'w, SpecializedRenderPipelines<FloodPipeline>>,
    edge: Res<'w, OutlinePipeline>,
    flood: Res<'w, FloodPipeline>,
}

impl LinePipelines<'_> {
    /// The pipelines for a request; new ones are queued for compilation.
    pub fn get(&mut self, cache: &PipelineCache, request: &LineRequest) -> LinePasses {
        let key = OutlineKey::new(request);
        let mut flood = |first| self.floods.specialize(cache, &self.flood, first);
        LinePasses {
            key,
            detect: self.edges.specialize(cache, &self.edge, key),
            flood: request.floods().then(|| [flood(true), flood(false)]),
        }
    }
}
