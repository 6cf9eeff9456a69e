//! Records the passes that find a view's lines and draw their ink.

use std::sync::atomic::Ordering;

use bevy::{
    color::LinearRgba,
    core_pipeline::prepass::ViewPrepassTextures,
    ecs::system::Res,
    math::{UVec2, Vec4Swizzles},
    render::{
        diagnostic::RecordDiagnostics,
        render_resource::{
            BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, BindingResource,
            CachedRenderPipelineId, CommandEncoder, ComputePassDescriptor, ComputePipeline,
            IntoBinding, LoadOp, Operations, PipelineCache, RenderPassColorAttachment,
            RenderPassDescriptor, RenderPipeline, StoreOp,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        texture::CachedTexture,
    },
};

use super::{
    ViewLines,
    pipelines::{LineKey, TILE, WORKGROUP},
    prepare::{Cracks, blocks},
    request::{CrackPasses, LinePasses, LineRequest},
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

/// A pass that is ready to be recorded: its pipeline and bindings.
type Ready<'a, P> = (&'a P, BindGroup);

impl Inputs<'_> {
    fn record(&self, ctx: &mut RenderContext) -> Result<(), LeftOut> {
        let (request, passes, lines) = self.parts.0;
        let ink = lines.ink.as_ref().ok_or(NOT_READY)?;
        let faithful = match passes.faithful {
            Some(id) => {
                let layout = passes.key.faithful_layout();
                let entries = self.entries(passes.key.faithful[1])?;
                Some((self.pipeline(id)?, self.group(&layout, &entries)))
            }
            None => None,
        };
        let cracks = match (&passes.cracks, &lines.cracks) {
            (Some(passes), Some(cracks)) => Some(self.crack_passes(passes, cracks)?),
            _ => None,
        };

        let diagnostics = ctx.diagnostic_recorder();
        let diagnostics = diagnostics.as_deref();
        let encoder = ctx.command_encoder();
        if let Some(cracks) = &cracks {
            let span = diagnostics.time_span(encoder, "comics_find_lines");
            cracks.find(encoder, request);
            span.end(encoder);
        }
        let span = diagnostics.time_span(encoder, "comics_draw_lines");
        if let Some(cracks) = &cracks {
            cracks.search_columns(encoder, request);
        }
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
        if let Some(cracks) = &cracks {
            draw_tiles(&mut pass, &cracks.draw, request.size);
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

    fn entries(&self, normals: bool) -> Result<Vec<BindGroupEntry<'_>>, LeftOut> {
        self.inputs(&self.parts.0.1.key, normals)
    }

    /// The bindings of the passes that read the prepasses. `normals`: the normals too.
    fn inputs(&self, key: &LineKey, normals: bool) -> Result<Vec<BindGroupEntry<'_>>, LeftOut> {
        let ((request, ..), prepass, range, ids) = self.parts;
        let prepass = prepass.ok_or(LeftOut::NoDepthPrepass)?;
        let depth = prepass.depth.as_ref().ok_or(LeftOut::NoDepthPrepass)?;
        if depth.texture.texture.sample_count() != request.samples {
            return Err(LeftOut::SampleCountMismatch);
        }
        let mut entries = vec![
            entry(1, self.uniform()?),
            entry(2, (&depth.texture.default_view).into_binding()),
        ];
        if key.visible_range {
            let keys = range.and_then(ViewDepthRange::drawn).ok_or(NOT_READY)?;
            entries.push(entry(3, keys.as_entire_binding()));
        }
        if key.object_styles {
            let styles = self.object_styles.buffer().ok_or(NOT_READY)?;
            entries.push(entry(6, styles.as_entire_binding()));
        }
        if normals {
            let normal = prepass.normal.as_ref().ok_or(NOT_READY)?;
            entries.push(entry(7, (&normal.texture.default_view).into_binding()));
        }
        if key.ids {
            let ids = ids.ok_or(NOT_READY)?;
            entries.push(entry(8, (&ids.view).into_binding()));
        }
        Ok(entries)
    }

    /// The passes of the lines along cracks.
    fn crack_passes<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<ReadyCracks<'a>, LeftOut> {
        let key = &self.parts.0.1.key;
        let mut entries = self.entries(key.creases)?;
        if let Some(blocks) = &cracks.blocks {
            entries.push(entry(12, (&blocks.default_view).into_binding()));
        }
        let find = self.group(&key.find_layout(), &entries);
        let walk = match (passes.walk, &cracks.blocks) {
            (Some(id), Some(blocks)) => {
                let pipeline = self.cache.get_compute_pipeline(id).ok_or(NOT_READY)?;
                let key = key.for_walk();
                let mut entries = self.inputs(&key, key.creases)?;
                entries.push(entry(10, (&blocks.default_view).into_binding()));
                Some((pipeline, self.group(&key.walk_layout(), &entries)))
            }
            _ => None,
        };
        let columns = match (passes.columns, &cracks.columns) {
            (Some(id), Some(columns)) => {
                let entries = self.searched(cracks, (11, &cracks.texture))?;
                let group = self.group(&key.for_columns().columns_layout(), &entries);
                Some(((self.pipeline(id)?, group), columns))
            }
            _ => None,
        };
        Ok(ReadyCracks {
            walk,
            columns,
            find: (self.pipeline(passes.find)?, find),
            draw: (self.pipeline(passes.draw)?, self.draw_group(cracks)?),
            texture: &cracks.texture,
        })
    }

    /// The bindings of a pass that searches cracks in the texture at this binding.
    fn searched<'a>(
        &'a self,
        cracks: &'a Cracks,
        (binding, texture): (u32, &'a CachedTexture),
    ) -> Result<Vec<BindGroupEntry<'a>>, LeftOut> {
        let mut entries = vec![
            entry(1, self.uniform()?),
            entry(binding, (&texture.default_view).into_binding()),
        ];
        if let Some(blocks) = &cracks.blocks {
            entries.push(entry(12, (&blocks.default_view).into_binding()));
        }
        Ok(entries)
    }

    fn draw_group(&self, cracks: &Cracks) -> Result<BindGroup, LeftOut> {
        let ((_, passes, _), _, _, ids) = self.parts;
        let searched = match &cracks.columns {
            Some(columns) => (13, columns),
            None => (11, &cracks.texture),
        };
        let mut entries = self.searched(cracks, searched)?;
        if passes.key.object_styles {
            let ids = ids.ok_or(NOT_READY)?;
            entries.push(entry(8, (&ids.view).into_binding()));
        }
        Ok(self.group(&passes.key.draw_layout(), &entries))
    }
}

/// The passes of the lines along cracks, ready to be recorded.
struct ReadyCracks<'a> {
    walk: Option<Ready<'a, ComputePipeline>>,
    find: Ready<'a, RenderPipeline>,
    columns: Option<(Ready<'a, RenderPipeline>, &'a CachedTexture)>,
    draw: Ready<'a, RenderPipeline>,
    texture: &'a CachedTexture,
}

impl ReadyCracks<'_> {
    /// Looks for blocks with cracks, and finds the cracks in them.
    fn find(&self, encoder: &mut CommandEncoder, request: &LineRequest) {
        if let Some((pipeline, group)) = &self.walk {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                label: Some("comics_walk"),
                timestamp_writes: None,
            });
            let blocks = blocks(request.rect);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(blocks.x.div_ceil(WORKGROUP), blocks.y, 1);
        }
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_find_lines"),
            color_attachments: &[Some(cleared(self.texture))],
            ..Default::default()
        });
        draw_tiles(&mut pass, &self.find, request.rect.zw());
    }

    /// Finds the best crack of each pixel's column.
    fn search_columns(&self, encoder: &mut CommandEncoder, request: &LineRequest) {
        let Some((columns, texture)) = &self.columns else {
            return;
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_line_columns"),
            color_attachments: &[Some(cleared(texture))],
            ..Default::default()
        });
        draw_tiles(&mut pass, columns, request.rect.zw());
    }
}

/// Draws the tiles of a picture of this size.
fn draw_tiles(pass: &mut wgpu::RenderPass, (pipeline, group): &Ready<RenderPipeline>, size: UVec2) {
    let tiles = size.x.div_ceil(TILE) * size.y.div_ceil(TILE);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..4, 0..tiles);
}

/// A texture that is cleared to 0 before it is drawn to.
fn cleared(texture: &CachedTexture) -> RenderPassColorAttachment<'_> {
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
