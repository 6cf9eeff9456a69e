//! Records the passes that find a view's lines.

use std::sync::atomic::Ordering;

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntry, BindingResource, CommandEncoder, IntoBinding, PipelineCache,
            RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        texture::CachedTexture,
    },
};

use super::{
    ViewLines,
    pipelines::FloodPipeline,
    prepare::Flood,
    request::{LinePasses, LineRequest},
};
use crate::{
    depth::prepare::ViewDepthRange,
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    objects::{ObjectStyleBuffer, ViewObjectIds},
};

/// The components of a view that its line passes read.
type ViewParts<'a> = (
    (&'a LineRequest, &'a LinePasses, &'a ViewLines),
    Option<&'a ViewPrepassTextures>,
    Option<&'a ViewDepthRange>,
    Option<&'a ViewObjectIds>,
);

/// Records the passes that find the lines of the view.
pub(crate) fn find_lines(
    view: ViewQuery<(
        (&LineRequest, &LinePasses, &ViewLines),
        Option<&ViewPrepassTextures>,
        Option<&ViewDepthRange>,
        Option<&ViewObjectIds>,
    )>,
    object_styles: Res<ObjectStyleBuffer>,
    ledger: Res<StageLedger>,
    cache: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let parts = view.into_inner();
    let (request, _, lines) = parts.0;
    let outcome = match record(parts, &object_styles, &cache, &mut ctx) {
        Ok(()) => {
            lines.found.store(true, Ordering::Relaxed);
            if lines.flood.is_some() {
                ledger.set(request.camera, ComicsStage::LineFlood, StageOutcome::Ran);
            }
            StageOutcome::Ran
        }
        Err(reason) => StageOutcome::LeftOut(reason),
    };
    ledger.set(request.camera, ComicsStage::OutlineEdges, outcome);
}

fn record(
    parts: ViewParts,
    object_styles: &ObjectStyleBuffer,
    cache: &PipelineCache,
    ctx: &mut RenderContext,
) -> Result<(), LeftOut> {
    let ((_, passes, lines), ..) = parts;
    let not_ready = LeftOut::PipelineNotReady;
    let pipeline = |id| cache.get_render_pipeline(id).ok_or(not_ready);
    let detect = pipeline(passes.detect)?;
    let edges = lines.edges.as_ref().ok_or(not_ready)?;
    let uniform = lines.uniform.binding().ok_or(not_ready)?;
    let flood = match (passes.flood, &lines.flood) {
        (Some([first, next]), Some(flood)) => Some((flood, [pipeline(first)?, pipeline(next)?])),
        _ => None,
    };
    let entries = entries(parts, object_styles, uniform.clone())?;
    let device = ctx.render_device().clone();
    let layout = cache.get_bind_group_layout(&passes.key.layout());
    let group = device.create_bind_group("comics_outlines", &layout, &entries);

    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let encoder = ctx.command_encoder();
    let span = diagnostics.time_span(encoder, "comics_outlines");
    draw(encoder, "comics_outlines", edges, (detect, &group), 0);
    if let Some((flood, pipelines)) = flood {
        let inputs = (edges, uniform);
        record_flood(encoder, (&device, cache), flood, pipelines, inputs);
    }
    span.end(encoder);
    Ok(())
}

fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

/// The bindings of the pass that finds edges.
fn entries<'a>(
    ((request, passes, _), prepass, range, ids): ViewParts<'a>,
    object_styles: &'a ObjectStyleBuffer,
    uniform: BindingResource<'a>,
) -> Result<Vec<BindGroupEntry<'a>>, LeftOut> {
    let key = &passes.key;
    let not_ready = LeftOut::PipelineNotReady;
    let prepass = prepass.ok_or(LeftOut::NoDepthPrepass)?;
    let depth = prepass.depth.as_ref().ok_or(LeftOut::NoDepthPrepass)?;
    if depth.texture.texture.sample_count() != request.samples {
        return Err(LeftOut::SampleCountMismatch);
    }
    let mut entries = vec![
        entry(1, uniform),
        entry(2, (&depth.texture.default_view).into_binding()),
    ];
    if key.visible_range {
        let keys = range.and_then(ViewDepthRange::drawn).ok_or(not_ready)?;
        entries.push(entry(3, keys.as_entire_binding()));
    }
    if key.object_styles {
        let styles = object_styles.buffer().ok_or(not_ready)?;
        entries.push(entry(6, styles.as_entire_binding()));
    }
    if key.creases {
        let normal = prepass.normal.as_ref().ok_or(not_ready)?;
        entries.push(entry(7, (&normal.texture.default_view).into_binding()));
    }
    if key.ids {
        let ids = ids.ok_or(not_ready)?;
        entries.push(entry(8, (&ids.view).into_binding()));
    }
    Ok(entries)
}

/// Records one full-screen pass. `instance` is the flood's stride.
fn draw(
    encoder: &mut CommandEncoder,
    label: &str,
    target: &CachedTexture,
    (pipeline, bind_group): (&RenderPipeline, &BindGroup),
    instance: u32,
) {
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: &target.default_view,
            depth_slice: None,
            resolve_target: None,
            ops: Default::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[]);
    pass.draw(0..3, instance..instance + 1);
}

fn record_flood(
    encoder: &mut CommandEncoder,
    (device, cache): (&RenderDevice, &PipelineCache),
    flood: &Flood,
    [first, next]: [&RenderPipeline; 2],
    (edges, uniform): (&CachedTexture, BindingResource),
) {
    let group = |source: &CachedTexture, is_first: bool| {
        device.create_bind_group(
            "comics_line_flood",
            &cache.get_bind_group_layout(&FloodPipeline::layout(is_first)),
            &[
                entry(1, uniform.clone()),
                entry(
                    if is_first { 4 } else { 5 },
                    (&source.default_view).into_binding(),
                ),
            ],
        )
    };
    let label = "comics_line_flood";
    let start = group(edges, true);
    draw(encoder, label, &flood.textures[0], (first, &start), 0);
    for (i, stride) in flood.strides.iter().enumerate() {
        let group = group(&flood.textures[i % 2], false);
        let target = &flood.textures[(i + 1) % 2];
        draw(encoder, label, target, (next, &group), *stride);
    }
}
