//! Records the passes that find a view's lines and draw their ink.

use std::sync::atomic::Ordering;

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{CommandEncoder, RenderPassDescriptor, RenderPipeline},
        renderer::{RenderContext, ViewQuery},
        texture::CachedTexture,
    },
};

#[cfg(feature = "objects")]
use super::highlights::ViewHighlights;
use super::{
    inputs::Inputs,
    ready::{Ready, ReadyCracks, search_tiles},
    sources::Sources,
};
use crate::{
    bind_groups::Binder,
    depth::{prepare::ViewDepthRange, surfaces::OwnSurfaces},
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    lines::{
        key::LineKey, passes::LinePasses, prepare::ViewLines, request::LineRequest,
        textures::cleared, tiles::draw_tiles,
    },
    objects::{ObjectDepths, ObjectStyleBuffer, ViewLineWidths, ViewObjectIds},
};
#[cfg(feature = "objects")]
use crate::{
    depth::surfaces::prepass_is_empty,
    objects::{HighlightStyleBuffer, ViewLayer},
};
#[cfg(feature = "objects")]
use bevy::{ecs::system::Query, render::renderer::RenderAdapterInfo};

/// Records the passes that find the lines of the highlighted objects of the view, and draw their
/// ink.
#[cfg(feature = "objects")]
pub(crate) fn find_highlights(
    view: ViewQuery<(
        &ViewHighlights,
        (&ViewPrepassTextures, Option<&OwnSurfaces>),
        &ViewLayer,
    )>,
    layers: Query<(&LineRequest, &LinePasses, &ViewLines)>,
    styles: Res<HighlightStyleBuffer>,
    ledger: Res<StageLedger>,
    (binder, adapter): (Binder, Res<RenderAdapterInfo>),
    mut ctx: RenderContext,
) {
    let (highlights, (prepass, own), layer) = view.into_inner();
    // Transparent meshes hide no highlighted object.
    let own = own.filter(|_| prepass_is_empty(&adapter));
    let Ok((request, passes, lines)) = layers.get(highlights.layer) else {
        return;
    };
    let inputs = Inputs {
        request,
        passes,
        lines,
        sources: Sources::new((Some(prepass), own), (None, None, None)).layer(layer),
        range: None,
        styles: &styles.0,
        binder: &binder,
    };
    match inputs.record(&mut ctx) {
        Ok(()) => lines.found.store(true, Ordering::Relaxed),
        Err(reason) => {
            let outcome = StageOutcome::Skipped(reason);
            ledger.set(request.camera, ComicsStage::HighlightedObjects, outcome);
        }
    }
}

/// Records the passes that find the lines of the view and draw their ink.
pub(crate) fn find_lines(
    view: ViewQuery<(
        (&LineRequest, &LinePasses, &ViewLines),
        (Option<&ViewPrepassTextures>, Option<&OwnSurfaces>),
        Option<&ViewDepthRange>,
        (
            Option<&ViewObjectIds>,
            Option<&ViewLineWidths>,
            Option<&ObjectDepths>,
        ),
    )>,
    object_styles: Res<ObjectStyleBuffer>,
    ledger: Res<StageLedger>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let ((request, passes, lines), prepass, range, objects) = view.into_inner();
    let inputs = Inputs {
        request,
        passes,
        lines,
        sources: Sources::new(prepass, objects),
        range,
        styles: &object_styles,
        binder: &binder,
    };
    let outcome = match inputs.record(&mut ctx) {
        Ok(()) => {
            lines.found.store(true, Ordering::Relaxed);
            StageOutcome::Ran
        }
        Err(reason) => StageOutcome::Skipped(reason),
    };
    let unsearched = if passes.key.intersects(LineKey::CRACKS | LineKey::JUMPS) {
        SkipReason::NoComputeShaders
    } else {
        SkipReason::NoSuchLines
    };
    let resolved = (request.samples > 1, SkipReason::SingleSampled);
    let searched = (passes.search.is_some(), unsearched);
    let inked = (passes.has_ink(), SkipReason::NoSuchLines);
    for (stage, (is_needed, reason)) in [
        (ComicsStage::ResolveSamples, resolved),
        (ComicsStage::SearchTiles, searched),
        (ComicsStage::FindLines, inked),
        (ComicsStage::DrawLines, inked),
    ] {
        let skipped = StageOutcome::Skipped(reason);
        let outcome = if is_needed { outcome } else { skipped };
        ledger.set(request.camera, stage, outcome);
    }
}

impl Inputs<'_> {
    /// Records the passes of the view, or says why not.
    fn record(&self, ctx: &mut RenderContext) -> Result<(), SkipReason> {
        let (passes, lines) = (self.passes, self.lines);
        let resolve = self.resolve_pass()?;
        let search = self.search_passes()?;
        let faithful = self.faithful_pass()?;
        let accumulate = self.history_pass()?;
        let cracks = match (&passes.cracks, &lines.cracks) {
            (Some(passes), Some(cracks)) => Some(self.crack_passes(passes, cracks)?),
            _ => None,
        };

        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        if let Some((resolved, (pipeline, group))) = &resolve {
            let span = diagnostics.time_span(encoder, "comics_resolve_samples");
            resolved.record(encoder, self.request, (pipeline, group));
            span.end(encoder);
        }
        if let Some(search) = &search {
            let span = diagnostics.time_span(encoder, "comics_search_tiles");
            search_tiles(encoder, search, self.request, passes.last_list());
            span.end(encoder);
        }
        if let Some(cracks) = &cracks {
            let span = diagnostics.time_span(encoder, "comics_find_lines");
            cracks.find(encoder);
            span.end(encoder);
        }
        let Some(ink) = &lines.ink else {
            return Ok(());
        };
        let span = diagnostics.time_span(encoder, "comics_draw_lines");
        self.draw_ink(encoder, ink, (faithful.as_ref(), cracks.as_ref()));
        if let Some((history, (pipeline, group))) = &accumulate {
            let tiles = lines.tiles.as_ref().map(|tiles| &tiles.lists);
            let tiles = tiles.filter(|_| passes.are_tiles_complete());
            history.record(encoder, (pipeline, group), tiles);
        }
        span.end(encoder);
        Ok(())
    }

    /// Records the passes that draw the ink of all lines.
    fn draw_ink(
        &self,
        encoder: &mut CommandEncoder,
        ink: &CachedTexture,
        (faithful, cracks): (Option<&Ready<RenderPipeline>>, Option<&ReadyCracks>),
    ) {
        if let Some(cracks) = cracks {
            cracks.search_columns(encoder);
        }
        let targets: Vec<_> = [Some(ink), self.lines.owners.as_ref()]
            .into_iter()
            .flatten()
            .map(|texture| Some(cleared(texture)))
            .collect();
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_draw_lines"),
            color_attachments: &targets,
            ..Default::default()
        });
        if let Some((pipeline, group)) = faithful {
            draw_tiles(&mut pass, (pipeline, group), None);
        }
        if let Some(cracks) = cracks {
            cracks.draw_ink(&mut pass);
        }
    }
}
