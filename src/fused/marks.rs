//! Turns the plan of a view into requests for the lines of its marked objects.

use bevy::{
    camera::CompositingSpace,
    ecs::{
        entity::Entity,
        hierarchy::ChildOf,
        system::{Commands, Res, ResMut, SystemParam},
    },
    math::Vec4Swizzles,
    render::{
        camera::ExtractedCamera,
        render_resource::{CachedRenderPipelineId, PipelineCache, SpecializedRenderPipelines},
        view::ExtractedView,
    },
};

use super::{Plan, ViewPlan, lines::memory_request, scene::Scene};
use crate::{
    depth::{ProjectionKind, view::ViewUniform},
    lines::{
        LinePasses, LinePipelines, LineRequest, MarkKey, MarkPipeline, Outlines, SheetUniform,
        ViewMarks,
    },
    objects::{LayerRequest, Marks},
};

/// What the requests are made with.
#[derive(SystemParam)]
pub(crate) struct MarkPipelines<'w> {
    marks: Res<'w, Marks>,
    pipelines: ResMut<'w, SpecializedRenderPipelines<MarkPipeline>>,
    pipeline: Res<'w, MarkPipeline>,
}

/// The requests for the lines of the marked objects of a view.
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
        let (size, samples) = scene.depth.filter(|_| plan.marks)?;
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

/// The request for the lines of marked objects. `widest`: their largest width in logical
/// pixels.
fn request(
    view: &ViewPlan,
    (scene, uniform): (&Scene, ViewUniform),
    widest: f32,
) -> Option<LineRequest> {
    let settings = Outlines::MARKS;
    let (depth_size, samples) = scene.depth?;
    let reference = view.projection.jump_reference(&view.clip_from_view);
    let grid_scale = view.scale_factor * uniform.depth_scale.max_element();
    Some(LineRequest {
        camera: view.camera,
        settings,
        view: uniform,
        lines: settings.uniform(view.scale_factor, reference),
        weight: (settings.weight).uniform(grid_scale, view.to_light, settings.ink_budget),
        boil: settings.boil.uniform(view.scale_factor, view.time, 0.0),
        memory: memory_request(view, &settings, scene),
        cuts: view.cuts,
        motion: false,
        fog: None,
        focus: None,
        layers: None,
        abstraction: None,
        sheet: SheetUniform::default(),
        depth_size,
        samples,
        size: scene.viewport.zw(),
        rect: scene.drawn(),
        jitter: scene.jitter,
        reach: settings.reach(view.scale_factor, (widest, false), None),
        steps: settings.steps(grid_scale),
        specks: settings.min_length(grid_scale),
        extension: 0.0,
        oblique: view.projection.kind() == ProjectionKind::Oblique,
        visible_range: false,
        ids: true,
        sections: false,
        marks: true,
        object_styles: true,
        widths: false,
        line_reach: 0.0,
        jumps: None,
        map_flags: 0,
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

/// Removes the requests for the lines of marked objects.
pub(super) fn remove_marks(view: Entity, layer: Option<Entity>, commands: &mut Commands) {
    if let Some(layer) = layer {
        commands.entity(layer).despawn();
    }
    commands.entity(view).remove::<(LayerRequest, ViewMarks)>();
}
