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

use super::{Plan, ViewPlan, lines::plain_request, scene::Scene};
use crate::{
    depth::view::ViewUniform,
    lines::{LinePasses, LinePipelines, LineRequest, MarkKey, MarkPipeline, Outlines, ViewMarks},
    objects::{LayerRequest, Marks},
};

/// What the requests are made with.
#[derive(SystemParam)]
pub(crate) struct MarkPipelines<'w> {
    marks: Res<'w, Marks>,
    pipelines: ResMut<'w, SpecializedRenderPipelines<MarkPipeline>>,
    pipeline: Res<'w, MarkPipeline>,
}

/// The requests for the lines of the highlighted objects of a view.
pub(super) struct MarkRequests {
    layer: LayerRequest,
    lines: (LineRequest, LinePasses),
    pipeline: CachedRenderPipelineId,
    key: MarkKey,
    late: bool,
}

impl MarkPipelines<'_> {
    /// The requests, if some object is marked and the view has a depth prepass.
    pub fn requests(
        &mut self,
        lines: &mut LinePipelines,
        cache: &PipelineCache,
        (plan, view): (&Plan, &ViewPlan),
        (scene, uniform): (&Scene, ViewUniform),
        (extracted, camera): (&ExtractedView, &ExtractedCamera),
    ) -> Option<MarkRequests> {
        let (size, samples) = scene.depth.filter(|_| plan.objects.marks)?;
        let widest = self.marks.styles.max_width();
        let request = request(view, (scene, uniform), widest)?;
        let passes = lines.get(cache, &request);
        let key = MarkKey {
            format: extracted.target_format,
            space: camera.compositing_space.unwrap_or(CompositingSpace::Linear),
            tiled: passes.are_tiles_complete(),
        };
        Some(MarkRequests {
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
    let settings = Outlines::MARKS;
    Some(LineRequest {
        reach: settings.reach(view.scale_factor, (widest, false), None),
        ids: true,
        marks: true,
        object_styles: true,
        ..plain_request(view, settings, scene, uniform)?
    })
}

impl MarkRequests {
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
        let marks = ViewMarks {
            layer,
            pipeline: self.pipeline,
            key: self.key,
            late: self.late,
        };
        commands.entity(view).insert((self.layer, marks));
    }
}

/// Removes the requests for the lines of highlighted objects.
pub(super) fn remove_marks(view: Entity, layer: Option<Entity>, commands: &mut Commands) {
    if let Some(layer) = layer {
        commands.entity(layer).despawn();
    }
    commands.entity(view).remove::<(LayerRequest, ViewMarks)>();
}
