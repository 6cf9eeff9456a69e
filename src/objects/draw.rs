//! Records the passes that draw the ids of objects, and the layer of highlighted objects.

use bevy::{
    camera::{MainPassResolutionOverride, Viewport},
    prelude::*,
    render::{
        camera::ExtractedCamera,
        render_resource::{LoadOp, RenderPassDescriptor, StoreOp},
        renderer::{RenderContext, ViewQuery},
        view::{ExtractedView, ViewDepthTexture},
    },
};

use super::{
    IdRequest, ViewLineWidths, ViewObjectIds,
    bindings::IdBindings,
    depth_test::{DepthTest, TOLERANT},
    layer::{LayerRequest, ViewLayer},
    line_widths::width_attachment,
    phase::{Layer, ObjectIdPhases},
};
use crate::{
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::{attachment, depth_attachment},
};

/// A view whose ids are drawn.
type Ids = (
    &'static IdRequest,
    &'static ViewObjectIds,
    Option<&'static ViewLineWidths>,
    Option<&'static IdBindings>,
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
        let drawn = phase.render(&mut render_pass, (world, entity), layer);
        drawn.map(|()| StageOutcome::Ran).map_err(|error| {
            error_once!("the object ids were not drawn: {error:?}");
            SkipReason::PipelineNotReady
        })
    };
    if let Some((request, target, widths, bindings)) = ids {
        let own = bindings.and_then(|bindings| bindings.depth.as_ref());
        let targets = [
            Some(attachment(&target.view, LoadOp::default())),
            widths.map(width_attachment),
        ];
        let pass = RenderPassDescriptor {
            label: Some("comics_object_ids"),
            color_attachments: &targets[..1 + usize::from(widths.is_some())],
            depth_stencil_attachment: Some(match own {
                // Nothing reads it later.
                Some(own) => {
                    depth_attachment(&own.default_view, LoadOp::Clear(0.0), StoreOp::Discard)
                }
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
        let pass = RenderPassDescriptor {
            label: Some("comics_highlighted_objects"),
            color_attachments: &targets,
            depth_stencil_attachment: Some(depth_attachment(
                &layer.depth.default_view,
                LoadOp::Clear(0.0),
                StoreOp::Store,
            )),
            ..Default::default()
        };
        let outcome = draw(pass, request.samples, Layer::Highlighted);
        let outcome = outcome.unwrap_or_else(StageOutcome::Skipped);
        ledger.set(request.camera, ComicsStage::HighlightedObjects, outcome);
    }
}
