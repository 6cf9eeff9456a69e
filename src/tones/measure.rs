//! Records the passes that measure the tones of a view.

use std::sync::atomic::Ordering;

use bevy::{
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{IntoBinding, TextureView},
        renderer::{RenderContext, ViewQuery},
        view::ViewTarget,
    },
};

use super::prepare::{ToneUniforms, ViewTones};
use crate::{
    bind_groups::Binder,
    depth::range::RangePipeline,
    diagnostics::{ComicsStage, SkipReason, StageLedger, StageOutcome},
    gpu::{compute_pass, entry},
};

const LABEL: &str = "comics_tones";

/// Records the counting of a view's tones, and the smoothing of their percentiles, before the fused
/// pass.
///
/// `PRINTS`: of the views that are styled after anti-aliasing, otherwise of the others.
pub(crate) fn measure_tones<const PRINTS: bool>(
    view: ViewQuery<(&ViewTarget, &ViewTones)>,
    uniforms: Res<ToneUniforms>,
    ledger: Res<StageLedger>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let (target, tones) = view.into_inner();
    if tones.request.after_anti_aliasing != PRINTS {
        return;
    }
    let picture = target.main_texture_view();
    let outcome = match tones.record(picture, &uniforms, &binder, &mut ctx) {
        Some(()) => StageOutcome::Ran,
        None => StageOutcome::Skipped(SkipReason::PipelineNotReady),
    };
    ledger.set(tones.request.camera, ComicsStage::Tones, outcome);
}

impl ViewTones {
    /// `None` if a pipeline or a uniform is not ready in this frame.
    fn record(
        &self,
        picture: &TextureView,
        uniforms: &ToneUniforms,
        binder: &Binder,
        ctx: &mut RenderContext,
    ) -> Option<()> {
        let passes = self.passes;
        let (follow, id) = passes.smoothing;
        let count = binder.cache.get_compute_pipeline(passes.count)?;
        let smooth = binder.cache.get_compute_pipeline(id)?;
        let views = uniforms.views.binding()?;
        let smoothings = uniforms.smoothings.binding()?;
        let histogram = self.smoothing.histogram.as_ref()?;
        let entries = [
            entry(0, picture.into_binding()),
            entry(1, views),
            entry(2, self.keys.as_entire_binding()),
            entry(4, histogram.as_entire_binding()),
        ];
        let group = binder.group(LABEL, &RangePipeline::layout(passes.key), &entries);
        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        let span = diagnostics.time_span(encoder, LABEL);
        encoder.clear_buffer(&self.keys, 0, None);
        self.smoothing.clear_histogram(encoder);
        let (x, y) = passes.shape.workgroups(self.request.viewport);
        compute_pass(encoder, LABEL, (count, &group), &[self.view_offset])
            .dispatch_workgroups(x, y, 1);
        let bound = self.smoothing.bound(smoothings, &self.keys);
        let offset = self.smoothing.uniform_offset;
        follow.record(encoder, (binder, smooth), bound, &[offset]);
        span.end(encoder);
        self.smoothing.recorded();
        self.found.store(true, Ordering::Relaxed);
        Some(())
    }
}
