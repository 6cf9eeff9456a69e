//! Records the passes of a view's outlines.

use std::sync::atomic::Ordering;

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntry, BindingResource, CommandEncoder, IntoBinding, LoadOp,
            Operations, PipelineCache, RenderPassColorAttachment, RenderPassDescriptor,
            RenderPipeline, StoreOp,
        },
        renderer::{RenderContext, ViewQuery},
    },
};

use super::{FloodPipeline, OutlinePass, ViewTexture};
use crate::{
    diagnostics::{ComicsStage, LeftOut, StageLedger, StageOutcome},
    objects::ObjectStyleBuffer,
    passes::{ViewPass, ViewPasses},
};

fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

fn draw(
    encoder: &mut CommandEncoder,
    label: &str,
    target: &ViewTexture,
    pipeline: &RenderPipeline,
    bind_group: &BindGroup,
    offset: u32,
    instance: u32,
) {
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: &target.view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations {
                load: LoadOp::Clear(Default::default()),
                store: StoreOp::Store,
            },
        })],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, bind_group, &[offset]);
    pass.draw(0..3, instance..instance + 1);
}

/// Finds the outlines of the view.
pub(crate) fn find_outlines(
    view: ViewQuery<Option<&ViewPrepassTextures>>,
    passes: Res<ViewPasses>,
    object_styles: Res<ObjectStyleBuffer>,
    ledger: Res<StageLedger>,
    cache: Res<PipelineCache>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let prepass = view.into_inner();
    let Some(pass) = passes.views.get(&entity) else {
        return;
    };
    let Some(outline) = &pass.outline else {
        return;
    };
    match record(
        pass,
        outline,
        prepass,
        &passes,
        &object_styles,
        &cache,
        &mut ctx,
    ) {
        Ok(()) => {
            pass.outlines_found.store(true, Ordering::Relaxed);
            ledger.set(pass.camera, ComicsStage::OutlineEdges, StageOutcome::Ran);
            if outline.flood.is_some() {
                ledger.set(pass.camera, ComicsStage::LineFlood, StageOutcome::Ran);
            }
        }
        Err(reason) => ledger.set(
            pass.camera,
            ComicsStage::OutlineEdges,
            StageOutcome::LeftOut(reason),
        ),
    }
}

fn record(
    pass: &ViewPass,
    outline: &OutlinePass,
    prepass: Option<&ViewPrepassTextures>,
    passes: &ViewPasses,
    object_styles: &ObjectStyleBuffer,
    cache: &PipelineCache,
    ctx: &mut RenderContext,
) -> Result<(), LeftOut> {
    let key = &outline.key;
    let not_ready = LeftOut::PipelineNotReady;
    let pipeline = cache
        .get_render_pipeline(outline.pipeline)
        .ok_or(not_ready)?;
    let uniforms = passes.uniforms.binding().ok_or(not_ready)?;
    let prepass = prepass.ok_or(LeftOut::NoDepthPrepass)?;
    let depth = prepass.depth.as_ref().ok_or(LeftOut::NoDepthPrepass)?;
    if depth.texture.texture.sample_count() != key.samples {
        return Err(LeftOut::SampleCountMismatch);
    }
    let flood = match &outline.flood {
        Some(flood) => Some((
            flood,
            cache.get_render_pipeline(flood.first).ok_or(not_ready)?,
            cache.get_render_pipeline(flood.next).ok_or(not_ready)?,
        )),
        None => None,
    };

    let mut entries = vec![
        entry(1, uniforms.clone()),
        entry(2, (&depth.texture.default_view).into_binding()),
    ];
    if key.visible_range {
        let range = pass.range.as_ref().ok_or(not_ready)?;
        let keys = range.drawn().ok_or(not_ready)?;
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
        let ids = pass.ids.as_ref().ok_or(not_ready)?;
        entries.push(entry(8, (&ids.view).into_binding()));
    }
    let device = ctx.render_device().clone();
    let layout = cache.get_bind_group_layout(&key.layout());
    let bind_group = device.create_bind_group("comics_outlines", &layout, &entries);

    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let encoder = ctx.command_encoder();
    let span = diagnostics.time_span(encoder, "comics_outlines");
    let offset = pass.uniform_offset;
    draw(
        encoder,
        "comics_outlines",
        &outline.edges,
        pipeline,
        &bind_group,
        offset,
        0,
    );
    if let Some((flood, first, next)) = flood {
        let step = |source: &ViewTexture, is_first: bool| {
            device.create_bind_group(
                "comics_line_flood",
                &cache.get_bind_group_layout(&FloodPipeline::layout(is_first)),
                &[
                    entry(1, uniforms.clone()),
                    entry(if is_first { 4 } else { 5 }, (&source.view).into_binding()),
                ],
            )
        };
        let label = "comics_line_flood";
        let group = step(&outline.edges, true);
        draw(encoder, label, &flood.textures[0], first, &group, offset, 0);
        for (i, stride) in flood.strides.iter().enumerate() {
            let group = step(&flood.textures[i % 2], false);
            let target = &flood.textures[(i + 1) % 2];
            draw(encoder, label, target, next, &group, offset, *stride);
        }
    }
    span.end(encoder);
    Ok(())
}
