//! Turns the plan of a view into requests for the lines of its highlighted objects.

use bevy::{
    ecs::system::SystemParam,
    prelude::*,
    render::{
        camera::ExtractedCamera,
        render_resource::{CachedRenderPipelineId, PipelineCache, SpecializedRenderPipelines},
        view::ExtractedView,
    },
};

use super::{lines::plain_request, scene::Scene};
use crate::{
    depth::view::ViewUniform,
    fused::{Plan, ViewPlan},
    lines::{
        HighlightKey, HighlightPipeline, LinePasses, LinePipelines, LineRequest, Outlines,
        ViewHighlights,
    },
    objects::{HighlightedObjects, LayerRequest},
};

/// What the requests are made with.
#[derive(SystemParam)]
pub(crate) struct HighlightPipelines<'w> {
    highlights: Res<'w, HighlightedObjects>,
    pipelines: ResMut<'w, SpecializedRenderPipelines<HighlightPipeline>>,
    pipeline: Res<'w, HighlightPipeline>,
}

/// The requests for the lines of the highlighted objects of a view.
pub(crate) struct HighlightRequests {
    layer: LayerRequest,
    lines: (LineRequest, LinePasses),
    pipeline: CachedRenderPipelineId,
    key: HighlightKey,
    late: bool,
}

impl HighlightPipelines<'_> {
    /// The requests, if some object is highlighted and the view has a depth prepass.
    pub fn requests(
        &mut self,
        lines: &mut LinePipelines,
        cache: &PipelineCache,
        (plan, view): (&Plan, &ViewPlan),
        (scene, uniform): (&Scene, ViewUniform),
        (extracted, camera): (&ExtractedView, &ExtractedCamera),
    ) -> Option<HighlightRequests> {
        let (size, samples) = scene.depth.filter(|_| plan.objects.highlights)?;
        let widest = self.highlights.styles.max_width();
        let request = request(view, (scene, uniform), widest)?;
        let passes = lines.get(cache, &request);
        let key = HighlightKey {
            format: extracted.target_format,
            space: camera.compositing_space.unwrap_or(CompositingSpace::Linear),
            tiled: passes.are_tiles_complete(),
        };
        Some(HighlightRequests {
            layer: LayerRequest {
                camera: view.camera,
                size,
                samples,
            },
            lines: (request, passes),
            pipeline: self.pipelines.specialize(cache, &self.pipeline, key),
            key,
            late: plan.runs_after_anti_aliasing(),
        })
    }
}

/// The request for the lines of highlighted objects. `widest`: their largest width in logical
/// pixels.
fn request(
    view: &ViewPlan,
    (scene, uniform): (&Scene, ViewUniform),
    widest: f32,
) -> Option<LineRequest> {
    let settings = Outlines::HIGHLIGHTS;
    Some(LineRequest {
        reach: settings.reach(view.scale_factor, (widest, false), None),
        ids: true,
        highlights: true,
        object_styles: true,
        ..plain_request(view, settings, scene, uniform)?
    })
}

impl HighlightRequests {
    pub fn passes(&self) -> &LinePasses {
        &self.lines.1
    }

    pub fn pipeline(&self) -> CachedRenderPipelineId {
        self.pipeline
    }

    /// Puts the requests on the view, and those for lines on an entity of their own.
    pub fn put(self, view: Entity, known: Option<Entity>, commands: &mut Commands) {
        let layer = known.unwrap_or_else(|| commands.spawn(ChildOf(view)).id());
        commands.entity(layer).insert(self.lines);
        let highlights = ViewHighlights {
            layer,
            pipeline: self.pipeline,
            key: self.key,
            late: self.late,
        };
        commands.entity(view).insert((self.layer, highlights));
    }
}

/// Removes the requests for the lines of highlighted objects.
pub(crate) fn remove_highlights(view: Entity, layer: Option<Entity>, commands: &mut Commands) {
    if let Some(layer) = layer {
        commands.entity(layer).despawn();
    }
    commands
        .entity(view)
        .remove::<(LayerRequest, ViewHighlights)>();
}
