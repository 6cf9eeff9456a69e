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
            CachedRenderPipelineId, ComputePipeline, IntoBinding, LoadOp, Operations,
            PipelineCache, RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline,
            StoreOp, TextureView,
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        texture::CachedTexture,
    },
};

use super::{
    ViewLines,
    cracks::{Ready, ReadyCracks, ReadyFind, search_tiles},
    key::LineKey,
    prepare::Cracks,
    request::{CrackPasses, FindPass, LinePasses, LineRequest},
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
    let (request, passes, lines) = parts.0;
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
    let searched = if passes.search.is_some() {
        outcome
    } else if passes.key.has_cracks() || passes.key.jumps {
        StageOutcome::LeftOut(LeftOut::NoComputeShaders)
    } else {
        StageOutcome::LeftOut(LeftOut::NoSuchLines)
    };
    let inked = if passes.has_ink() {
        outcome
    } else {
        StageOutcome::LeftOut(LeftOut::NoSuchLines)
    };
    for (stage, outcome) in [
        (ComicsStage::ResolveSamples, resolved),
        (ComicsStage::SearchTiles, searched),
        (ComicsStage::FindLines, inked),
        (ComicsStage::DrawLines, inked),
    ] {
        ledger.set(request.camera, stage, outcome);
    }
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

impl Inputs<'_> {
    fn record(&self, ctx: &mut RenderContext) -> Result<(), LeftOut> {
        let (request, passes, lines) = self.parts.0;
        let resolve = self.resolve_pass()?;
        let search = self.search_passes()?;
        let faithful = match passes.faithful {
            Some(id) => {
                let layout = passes.key.for_faithful().faithful_layout();
                let entries = self.entries(&passes.key.for_faithful(), passes.key.faithful[1])?;
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
        if let Some((resolved, (pipeline, group))) = &resolve {
            let span = diagnostics.time_span(encoder, "comics_resolve_samples");
            resolved.record(encoder, request, (pipeline, group));
            span.end(encoder);
        }
        if let Some(search) = &search {
            let span = diagnostics.time_span(encoder, "comics_search_tiles");
            search_tiles(encoder, search, request, passes.last_list());
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
        if let Some(cracks) = &cracks {
            cracks.search_columns(encoder);
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
            cracks.draw_ink(&mut pass);
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
    fn entries(&self, key: &LineKey, normals: bool) -> Result<Vec<BindGroupEntry<'_>>, LeftOut> {
        let (_, _, range, _) = self.parts;
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

    /// The passes of the lines along cracks.
    fn crack_passes<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<ReadyCracks<'a>, LeftOut> {
        let key = self.parts.0.1.key.for_find();
        let (_, _, lines) = self.parts.0;
        let find = self.find_pass(passes.find, &key, cracks)?;
        let columns = match (passes.columns, &cracks.columns) {
            (Some(id), Some(columns)) => {
                let mut entries = self.searched((11, &cracks.texture))?;
                let blocks = lines.tiles.as_ref().map(|tiles| &tiles.blocks);
                entries.extend(blocks.map(|b| entry(12, (&b.default_view).into_binding())));
                let group = self.group(&key.for_columns().columns_layout(), &entries);
                Some(((self.pipeline(id)?, group), columns))
            }
            _ => None,
        };
        Ok(ReadyCracks {
            tiles: lines.tiles.as_ref().map(|tiles| &tiles.lists),
            columns,
            find,
            ink: (self.pipeline(passes.draw)?, self.draw_group(cracks)?),
            texture: &cracks.texture,
        })
    }

    /// The pass that finds cracks.
    fn find_pass(
        &self,
        pass: FindPass,
        key: &LineKey,
        cracks: &Cracks,
    ) -> Result<ReadyFind<'_>, LeftOut> {
        let mut entries = self.entries(key, key.creases)?;
        match pass {
            FindPass::Pixels(id) => {
                let group = self.group(&key.find_layout(), &entries);
                Ok(ReadyFind::Pixels((self.pipeline(id)?, group)))
            }
            FindPass::Cells(id) => {
                let (_, _, lines) = self.parts.0;
                let lists = &lines.tiles.as_ref().ok_or(NOT_READY)?.lists;
                let texture = &cracks.texture.default_view;
                entries.extend(lists.cell_entries());
                entries.push(entry(18, texture.into_binding()));
                let group = self.group(&key.cells_layout(), &entries);
                let pipeline = self.cache.get_compute_pipeline(id).ok_or(NOT_READY)?;
                Ok(ReadyFind::Cells(lists, (pipeline, group)))
            }
        }
    }

    /// The passes that look for blocks with cracks and list the tiles near them, if there
    /// are any.
    fn search_passes(&self) -> Result<Option<[Ready<'_, ComputePipeline>; 2]>, LeftOut> {
        let (_, passes, lines) = self.parts.0;
        let (Some([walk, list]), Some(tiles)) = (passes.search, &lines.tiles) else {
            return Ok(None);
        };
        let pipeline = |id| self.cache.get_compute_pipeline(id).ok_or(NOT_READY);
        let key = passes.key.for_walk();
        let mut walked = self.entries(&key, key.creases)?;
        walked.push(entry(10, (&tiles.blocks.default_view).into_binding()));
        if key.has_cracks() {
            walked.extend(tiles.lists.cell_entries());
        }
        let walked = self.group(&key.walk_layout(), &walked);
        let mut listed = self.searched((12, &tiles.blocks))?;
        listed.extend(tiles.lists.entries());
        let listed = self.group(&LineKey::tiles_layout(), &listed);
        Ok(Some([(pipeline(walk)?, walked), (pipeline(list)?, listed)]))
    }

    /// The bindings of a pass that searches the texture at this binding.
    fn searched<'a>(
        &'a self,
        (binding, texture): (u32, &'a CachedTexture),
    ) -> Result<Vec<BindGroupEntry<'a>>, LeftOut> {
        Ok(vec![
            entry(1, self.uniform()?),
            entry(binding, (&texture.default_view).into_binding()),
        ])
    }

    fn draw_group(&self, cracks: &Cracks) -> Result<BindGroup, LeftOut> {
        let (_, passes, _) = self.parts.0;
        let searched = match &cracks.columns {
            Some(columns) => (13, columns),
            None => (11, &cracks.texture),
        };
        let mut entries = self.searched(searched)?;
        if passes.key.object_styles {
            let ids = self.texels()?.ids.ok_or(NOT_READY)?;
            entries.push(entry(8, ids.into_binding()));
        }
        Ok(self.group(&passes.key.draw_layout(), &entries))
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
