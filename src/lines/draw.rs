//! Records the passes that find a view's lines and draw their ink.

use std::sync::atomic::Ordering;

use bevy::{
    color::LinearRgba,
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, BindingResource,
            CachedRenderPipelineId, CommandEncoder, ComputePassDescriptor, ComputePipeline,
            IntoBinding, LoadOp, Operations, PipelineCache, RenderPassColorAttachment,
            RenderPassDescriptor, RenderPipeline, StoreOp, TextureView,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        texture::CachedTexture,
    },
};

use super::{
    ViewLines,
    pipelines::{TILE, WORKGROUP},
    prepare::{Cracks, blocks},
    request::{Find, LinePasses, LineRequest},
    resolve::Resolved,
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

/// Records the passes that find the lines of the view and draw their ink.
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
    let inputs = Inputs {
        parts,
        object_styles: &object_styles,
        cache: &cache,
        device: ctx.render_device().clone(),
    };
    let outcome = match inputs.record(&mut ctx) {
        Ok(()) => {
            lines.found.store(true, Ordering::Relaxed);
            StageOutcome::Ran
        }
        Err(reason) => StageOutcome::LeftOut(reason),
    };
    let resolved = if request.samples > 1 {
        outcome
    } else {
        StageOutcome::LeftOut(LeftOut::SingleSampled)
    };
    ledger.set(request.camera, ComicsStage::ResolveSamples, resolved);
    ledger.set(request.camera, ComicsStage::FindLines, outcome);
    ledger.set(request.camera, ComicsStage::DrawLines, outcome);
}

fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

/// What the passes read.
struct Inputs<'a> {
    parts: ViewParts<'a>,
    object_styles: &'a ObjectStyleBuffer,
    cache: &'a PipelineCache,
    device: RenderDevice,
}

const NOT_READY: LeftOut = LeftOut::PipelineNotReady;

/// Textures with the depth, normal and object of every pixel.
pub(super) struct Texels<'a> {
    pub depth: &'a TextureView,
    pub normal: Option<&'a TextureView>,
    pub ids: Option<&'a TextureView>,
}

impl<'a> Texels<'a> {
    /// Adds the bindings: the depth, and the normals and ids if they are read.
    fn push(
        self,
        (normals, ids): (bool, bool),
        entries: &mut Vec<BindGroupEntry<'a>>,
    ) -> Result<(), LeftOut> {
        entries.push(entry(2, self.depth.into_binding()));
        if normals {
            let normal = self.normal.ok_or(NOT_READY)?;
            entries.push(entry(7, normal.into_binding()));
        }
        if ids {
            let ids = self.ids.ok_or(NOT_READY)?;
            entries.push(entry(8, ids.into_binding()));
        }
        Ok(())
    }
}

/// The pass that picks samples, ready to be recorded.
type ResolvePass<'a> = (&'a Resolved, Ready<'a, RenderPipeline>);

/// A pass that is ready to be recorded: its pipeline and bindings.
type Ready<'a, P> = (&'a P, BindGroup);

impl Inputs<'_> {
    fn record(&self, ctx: &mut RenderContext) -> Result<(), LeftOut> {
        let (request, passes, lines) = self.parts.0;
        let ink = lines.ink.as_ref().ok_or(NOT_READY)?;
        let resolve = self.resolve_pass()?;
        let faithful = match passes.faithful {
            Some(id) => {
                let layout = passes.key.faithful_layout();
                let entries = self.entries(passes.key.faithful[1])?;
                Some((self.pipeline(id)?, self.group(&layout, &entries)))
            }
            None => None,
        };
        let cracks = match (&passes.cracks, &lines.cracks) {
            (Some((find, draw)), Some(cracks)) => Some((
                self.find_pass(find, cracks)?,
                (self.pipeline(*draw)?, self.draw_group(cracks)?),
                cracks,
            )),
            _ => None,
        };

        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        if let Some((resolved, (pipeline, group))) = &resolve {
            let span = diagnostics.time_span(encoder, "comics_resolve_samples");
            resolved.record(encoder, request, (pipeline, group));
            span.end(encoder);
        }
        if let Some((find, _, cracks)) = &cracks {
            let span = diagnostics.time_span(encoder, "comics_find_lines");
            find.record(encoder, request, &cracks.texture);
            span.end(encoder);
        }
        let span = diagnostics.time_span(encoder, "comics_draw_lines");
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_draw_lines"),
            color_attachments: &[Some(cleared(ink))],
            ..Default::default()
        });
        if let Some((pipeline, group)) = &faithful {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
        if let Some((_, (pipeline, group), _)) = &cracks {
            let tiles = request.size.x.div_ceil(TILE) * request.size.y.div_ceil(TILE);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..4, 0..tiles);
        }
        drop(pass);
        span.end(encoder);
        Ok(())
    }

    fn pipeline(&self, id: CachedRenderPipelineId) -> Result<&RenderPipeline, LeftOut> {
        self.cache.get_render_pipeline(id).ok_or(NOT_READY)
    }

    fn group(&self, layout: &BindGroupLayoutDescriptor, entries: &[BindGroupEntry]) -> BindGroup {
        let layout = self.cache.get_bind_group_layout(layout);
        self.device
            .create_bind_group("comics_lines", &layout, entries)
    }

    fn uniform(&self) -> Result<BindingResource<'_>, LeftOut> {
        let (_, _, lines) = self.parts.0;
        lines.uniform.binding().ok_or(NOT_READY)
    }

    /// The prepass textures of the view.
    fn prepass(&self) -> Result<Texels<'_>, LeftOut> {
        let ((request, ..), prepass, _, ids) = self.parts;
        let prepass = prepass.ok_or(LeftOut::NoDepthPrepass)?;
        let depth = prepass.depth.as_ref().ok_or(LeftOut::NoDepthPrepass)?;
        if depth.texture.texture.sample_count() != request.samples {
            return Err(LeftOut::SampleCountMismatch);
        }
        let normal = prepass.normal.as_ref();
        Ok(Texels {
            depth: &depth.texture.default_view,
            normal: normal.map(|normal| &normal.texture.default_view),
            ids: ids.map(|ids| &ids.view),
        })
    }

    /// The textures that lines are found in.
    fn texels(&self) -> Result<Texels<'_>, LeftOut> {
        let (_, _, lines) = self.parts.0;
        match &lines.resolved {
            Some(resolved) => Ok(resolved.texels()),
            None => self.prepass(),
        }
    }

    /// The pass that picks one sample of every pixel, if the view is multisampled.
    fn resolve_pass(&self) -> Result<Option<ResolvePass<'_>>, LeftOut> {
        let (_, passes, lines) = self.parts.0;
        let (Some((key, id)), Some(resolved)) = (&passes.resolve, &lines.resolved) else {
            return Ok(None);
        };
        let mut entries = vec![entry(1, self.uniform()?)];
        self.prepass()?.push((key.normals, key.ids), &mut entries)?;
        let group = self.group(&key.layout(), &entries);
        Ok(Some((resolved, (self.pipeline(*id)?, group))))
    }

    /// The bindings of the passes that find lines. `normals`: the normals too.
    fn entries(&self, normals: bool) -> Result<Vec<BindGroupEntry<'_>>, LeftOut> {
        let ((_, passes, _), _, range, _) = self.parts;
        let key = &passes.key;
        let mut entries = vec![entry(1, self.uniform()?)];
        self.texels()?.push((normals, key.ids), &mut entries)?;
        if key.visible_range {
            let keys = range.and_then(ViewDepthRange::drawn).ok_or(NOT_READY)?;
            entries.push(entry(3, keys.as_entire_binding()));
        }
        if key.object_styles {
            let styles = self.object_styles.buffer().ok_or(NOT_READY)?;
            entries.push(entry(6, styles.as_entire_binding()));
        }
        Ok(entries)
    }

    fn find_pass(&self, find: &Find, cracks: &Cracks) -> Result<FindPass<'_>, LeftOut> {
        let (request, passes, _) = self.parts.0;
        let layout = passes.key.find_layout();
        let mut entries = self.entries(passes.key.creases)?;
        match find {
            Find::Fragments(id) => {
                let pipeline = self.pipeline(*id)?;
                Ok(FindPass::Fragments((
                    pipeline,
                    self.group(&layout, &entries),
                )))
            }
            Find::Compute(id) => {
                let pipeline = self.cache.get_compute_pipeline(*id).ok_or(NOT_READY)?;
                let rows = cracks.blocks.as_ref().ok_or(NOT_READY)?;
                entries.push(entry(9, (&cracks.texture.default_view).into_binding()));
                entries.push(entry(10, (&rows.default_view).into_binding()));
                let blocks = blocks(request.rect);
                Ok(FindPass::Compute {
                    pass: (pipeline, self.group(&layout, &entries)),
                    workgroups: [blocks.x.div_ceil(WORKGROUP), blocks.y],
                })
            }
        }
    }

    fn draw_group(&self, cracks: &Cracks) -> Result<BindGroup, LeftOut> {
        let (_, passes, _) = self.parts.0;
        let mut entries = vec![
            entry(1, self.uniform()?),
            entry(11, (&cracks.texture.default_view).into_binding()),
        ];
        if passes.key.object_styles {
            let ids = self.texels()?.ids.ok_or(NOT_READY)?;
            entries.push(entry(8, ids.into_binding()));
        }
        if let Some(blocks) = &cracks.blocks {
            entries.push(entry(12, (&blocks.default_view).into_binding()));
        }
        Ok(self.group(&passes.key.draw_layout(), &entries))
    }
}

/// The pass that finds cracks.
enum FindPass<'a> {
    Compute {
        pass: Ready<'a, ComputePipeline>,
        workgroups: [u32; 2],
    },
    Fragments(Ready<'a, RenderPipeline>),
}

impl FindPass<'_> {
    fn record(&self, encoder: &mut CommandEncoder, request: &LineRequest, cracks: &CachedTexture) {
        let label = Some("comics_find_lines");
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label,
            color_attachments: &[Some(cleared(cracks))],
            ..Default::default()
        });
        match self {
            Self::Fragments((pipeline, group)) => {
                let [_, _, width, height] = request.rect.to_array().map(|v| v as f32);
                pass.set_viewport(0.0, 0.0, width, height, 0.0, 1.0);
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
            }
            Self::Compute {
                pass: (pipeline, group),
                workgroups: [x, y],
            } => {
                drop(pass);
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                    label,
                    timestamp_writes: None,
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.dispatch_workgroups(*x, *y, 1);
            }
        }
    }
}

/// A texture that is cleared to 0 before it is drawn to.
pub(super) fn cleared(texture: &CachedTexture) -> RenderPassColorAttachment<'_> {
    RenderPassColorAttachment {
        view: &texture.default_view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations {
            load: LoadOp::Clear(LinearRgba::NONE.into()),
            store: StoreOp::Store,
        },
    }
}
