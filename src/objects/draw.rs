//! Records the passes that draw the ids of objects, and the layer of highlighted objects.

use bevy::{
    camera::{MainPassResolutionOverride, Viewport},
    ecs::{entity::Entity, system::Res, world::World},
    log::error_once,
    render::{
        camera::ExtractedCamera,
        render_phase::TrackedRenderPass,
        render_resource::{LoadOp, RenderPassDescriptor, StoreOp},
        renderer::{RenderContext, ViewQuery},
        view::{ExtractedView, ViewDepthTexture},
    },
};

use super::{
    IdRequest, ViewLineWidths, ViewObjectIds,
    depth_test::{DepthTest, TOLERANT, TolerantIds},
    layer::{LayerRequest, ViewLayer},
    line_widths::width_attachment,
    phase::{Layer, ObjectIdPhase, ObjectIdPhases},
};
use crate::{
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::attachment,
};

/// A view whose ids are drawn.
type Ids = (
    &'static IdRequest,
    &'static ViewObjectIds,
    Option<&'static ViewLineWidths>,
    Option<&'static TolerantIds>,
);

/// Draws the object ids of a view.
pub(super) fn draw_object_ids(
    world: &World,
    view: ViewQuery<(
        &ExtractedCamera,
        &ExtractedView,
        &ViewDepthTexture,
        Option<&MainPassResolutionOverride>,
        Option<Ids>,
        Option<(&LayerRequest, &ViewLayer)>,
    )>,
    test: Res<DepthTest>,
    phases: Res<ObjectIdPhases>,
    ledger: Res<StageLedger>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (camera, extracted, depth, resolution, ids, layer) = view.into_inner();
    let phase = phases.views.get(&extracted.retained_view_entity);
    let viewport = Viewport::from_viewport_and_override(camera.viewport.as_ref(), resolution);
    let mut draw = |descriptor: RenderPassDescriptor, samples: u32, layer: Layer| {
        let phase = phase.ok_or(SkipReason::PipelineNotReady)?;
        if depth.texture.sample_count() != samples {
            return Err(SkipReason::SampleCountMismatch);
        }
        let mut render_pass = ctx.begin_tracked_render_pass(descriptor);
        if let Some(viewport) = &viewport {
            render_pass.set_camera_viewport(viewport);
        }
        render_layer(phase, &mut render_pass, (world, entity), layer)
    };
    if let Some((request, target, widths, own)) = ids {
        let targets = [
            Some(attachment(&target.view, LoadOp::default())),
            widths.map(width_attachment),
        ];
        let pass = RenderPassDescriptor {
            label: Some("comics_object_ids"),
            color_attachments: &targets[..1 + usize::from(widths.is_some())],
            depth_stencil_attachment: Some(match own {
                Some(own) => own.attachment(),
                None => depth.get_attachment(StoreOp::Store),
            }),
            ..Default::default()
        };
        let outcome = if test.tolerant() == own.is_some() {
            draw(pass, request.samples, Layer::Prepass)
        } else {
            // The depth of the prepass could not be bound.
            Err(SkipReason::SampleCountMismatch)
        };
        let outcome = match outcome {
            Ok(_) if own.is_some() => StageOutcome::RanWith(TOLERANT),
            outcome => outcome.unwrap_or_else(StageOutcome::Skipped),
        };
        ledger.set(request.camera, ComicsStage::ObjectIds, outcome);
    }
    if let Some((request, layer)) = layer {
        let targets = [Some(attachment(&layer.ids.default_view, LoadOp::default()))];
        let outcome = draw(layer.pass(&targets), request.samples, Layer::Highlighted);
        let outcome = outcome.unwrap_or_else(StageOutcome::Skipped);
        ledger.set(request.camera, ComicsStage::HighlightedObjects, outcome);
    }
}

/// Draws the items of a layer.
fn render_layer<'w>(
    phase: &ObjectIdPhase,
    pass: &mut TrackedRenderPass<'w>,
    view: (&'w World, Entity),
    layer: Layer,
) -> Result<StageOutcome, SkipReason> {
    let drawn = phase.render(pass, view, layer);
    drawn.map(|()| StageOutcome::Ran).map_err(|error| {
        error_once!("the object ids were not drawn: {error:?}");
        SkipReason::PipelineNotReady
    })
}
