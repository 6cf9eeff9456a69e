//! What is asked of a view's lines, and the pipelines that answer.

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

/// On a view in the render world: its lines are to be found. Whoever plans the
/// frame writes it anew for every frame.
#[derive(Component, Clone, Debug)]
pub(crate) struct LineRequest {
    pub camera: Entity,
    pub settings: LineSettings,
    pub view: ViewUniform,
    pub lines: LinesUniform,
    /// Size and samples of the depth texture.
    pub size: UVec2,
    pub samples: u32,
    pub oblique: bool,
    /// The depth map spans the visible range.
    pub visible_range: bool,
    /// Object ids are drawn.
    pub ids: bool,
    /// Objects have lines of their own, or none.
    pub object_styles: bool,
    /// Lines are read between pixels, several times per pixel.
    pub anywhere: bool,
}

impl LineRequest {
    /// Whether lines are carried by a flood. A flood answers every place with
    /// four lines, however wide they are.
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
    /// First and further steps of the flood, if there is one.
    pub flood: Option<[CachedRenderPipelineId; 2]>,
}

/// Gives the pipelines for a request.
#[derive(SystemParam)]
pub(crate) struct LinePipelines<'w> {
    edges: ResMut<'w, SpecializedRenderPipelines<OutlinePipeline>>,
    floods: ResMut<'w, SpecializedRenderPipelines<FloodPipeline>>,
    edge: Res<'w, OutlinePipeline>,
    flood: Res<'w, FloodPipeline>,
}

impl LinePipelines<'_> {
    /// The pipelines that answer a request, queued where they are new.
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
