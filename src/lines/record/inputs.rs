//! The passes of a view's lines, ready to be recorded: pipelines and what they bind.

use bevy::render::{
    render_resource::{
        BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, CachedComputePipelineId,
        CachedRenderPipelineId, ComputePipeline, IntoBinding, RenderPipeline, TextureView,
    },
    texture::CachedTexture,
};

use super::{
    ready::{Ready, ReadyCells, ReadyCracks, ReadyFind, ReadyStrokes},
    sources::{NOT_READY, Sources, Texels},
};
use crate::{
    bind_groups::Binder,
    depth::prepare::ViewDepthRange,
    diagnostics::SkipReason,
    gpu::entry,
    lines::{
        cracks::{CrackBuffers, CrackStore, LineDensities},
        find::Resolved,
        history::LineHistory,
        key::{LineKey, LinePass, SearchPass},
        passes::{CrackPasses, FindPass, LinePasses},
        prepare::{Cracks, Tiles, ViewLines},
        request::LineRequest,
    },
    objects::{OBJECT_DEPTHS_BINDING, ObjectStyleBuffer},
};

/// What the passes of a view read.
pub(super) struct Inputs<'a> {
    pub request: &'a LineRequest,
    pub passes: &'a LinePasses,
    pub lines: &'a ViewLines,
    pub sources: Sources<'a>,
    pub range: Option<&'a ViewDepthRange>,
    /// The table of the styles of objects.
    pub styles: &'a ObjectStyleBuffer,
    pub binder: &'a Binder<'a>,
}

/// The pass that blends ink with the history, ready to be recorded.
type HistoryPass<'a> = (&'a LineHistory, Ready<'a, RenderPipeline>);

/// The pass that picks samples, ready to be recorded.
type ResolvePass<'a> = (&'a Resolved, Ready<'a, RenderPipeline>);

impl Inputs<'_> {
    /// A render pass that binds the uniform and these entries.
    fn render(
        &self,
        id: CachedRenderPipelineId,
        pass: LinePass,
        entries: &[BindGroupEntry],
    ) -> Result<Ready<'_, RenderPipeline>, SkipReason> {
        let pipeline = self.binder.cache.get_render_pipeline(id).ok_or(NOT_READY)?;
        let layout = pass.layout(pass.part(self.passes.key));
        Ok((pipeline, self.group(&layout, entries)?))
    }

    /// A compute pass that binds the uniform, these entries, and what it reads of the scene.
    fn compute<'a>(
        &'a self,
        (pass, id): (SearchPass, CachedComputePipelineId),
        mut entries: Vec<BindGroupEntry<'a>>,
    ) -> Result<Ready<'a, ComputePipeline>, SkipReason> {
        let pipeline = self.binder.cache.get_compute_pipeline(id);
        entries.extend(self.entries(pass.key())?);
        Ok((
            pipeline.ok_or(NOT_READY)?,
            self.group(&pass.layout(), &entries)?,
        ))
    }

    fn group(
        &self,
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> Result<BindGroup, SkipReason> {
        let mut all = vec![entry(1, self.lines.uniform.binding().ok_or(NOT_READY)?)];
        all.extend_from_slice(entries);
        Ok(self.binder.group("comics_lines", layout, &all))
    }

    /// The surfaces of the view.
    fn prepass(&self) -> Result<Texels<'_>, SkipReason> {
        let sources = self.sources;
        let depth = sources.depth.ok_or(SkipReason::NoDepthPrepass)?;
        // Those of a game's prepasses can be of cameras with different samples.
        let samples = self.request.samples;
        let fits = |texture: &TextureView| texture.texture().sample_count() == samples;
        if !fits(&depth.default_view) || sources.normal.is_some_and(|normal| !fits(normal)) {
            return Err(SkipReason::SampleCountMismatch);
        }
        Ok(Texels {
            depth: &depth.default_view,
            normal: sources.normal,
            ids: sources.ids,
            widths: sources.widths,
        })
    }

    /// The textures that lines are found in.
    fn texels(&self) -> Result<Texels<'_>, SkipReason> {
        match &self.lines.resolved {
            Some(resolved) => Ok(resolved.into()),
            None => self.prepass(),
        }
    }

    /// The pass that picks one sample of every pixel, if the view is multisampled.
    pub fn resolve_pass(&self) -> Result<Option<ResolvePass<'_>>, SkipReason> {
        let (Some(id), Some(resolved)) = (self.passes.resolve, &self.lines.resolved) else {
            return Ok(None);
        };
        let pass = LinePass::Resolve {
            samples: self.request.samples,
        };
        let mut entries = vec![];
        let key = pass.part(self.passes.key);
        self.prepass()?.push(key, &mut entries)?;
        Ok(Some((resolved, self.render(id, pass, &entries)?)))
    }

    /// The pass that mixes the ink with that of the frames before, if lines have a history.
    pub fn history_pass(&self) -> Result<Option<HistoryPass<'_>>, SkipReason> {
        let ViewLines { history, ink, .. } = self.lines;
        let (Some(id), Some(history), Some(ink)) = (self.passes.history, history, ink) else {
            return Ok(None);
        };
        let motion = self.sources.motion.ok_or(NOT_READY)?;
        let pass = LinePass::Accumulate {
            tiled: self.passes.are_tiles_complete(),
        };
        let mut entries = self.entries(pass.part(self.passes.key))?;
        entries.extend([texture_entry(23, ink), entry(24, motion.into_binding())]);
        entries.extend(history.entries());
        Ok(Some((history, self.render(id, pass, &entries)?)))
    }

    /// The pass that draws the faithful equations, if there are any.
    pub fn faithful_pass(&self) -> Result<Option<Ready<'_, RenderPipeline>>, SkipReason> {
        let Some(id) = self.passes.faithful else {
            return Ok(None);
        };
        let entries = self.entries(self.passes.key.for_faithful())?;
        Ok(Some(self.render(id, LinePass::Faithful, &entries)?))
    }

    /// What the pass of a part of a key binds of the scene, see [`LineKey`]'s layouts.
    fn entries(&self, key: LineKey) -> Result<Vec<BindGroupEntry<'_>>, SkipReason> {
        let mut entries = vec![];
        if !key.contains(LineKey::DEPTH) {
            return Ok(entries);
        }
        self.texels()?.push(key, &mut entries)?;
        if key.intersects(LineKey::RANGE) {
            let keys = self.range.and_then(ViewDepthRange::drawn);
            entries.push(entry(3, keys.ok_or(NOT_READY)?.as_entire_binding()));
        }
        if key.contains(LineKey::OBJECT_STYLES) {
            let styles = self.styles.buffer().ok_or(NOT_READY)?;
            entries.push(entry(6, styles.as_entire_binding()));
        }
        if key.contains(LineKey::OBJECT_DEPTHS) {
            let object_depths = self.sources.object_depths.ok_or(NOT_READY)?;
            entries.push(entry(
                OBJECT_DEPTHS_BINDING,
                object_depths.as_entire_binding(),
            ));
        }
        if key.contains(LineKey::HIGHLIGHTS) {
            let picture = self.sources.picture.ok_or(NOT_READY)?;
            entries.push(entry(27, picture.into_binding()));
        }
        if key.contains(LineKey::MOTION) {
            let motion = self.sources.motion.ok_or(NOT_READY)?;
            entries.push(entry(24, motion.into_binding()));
        }
        Ok(entries)
    }

    /// The passes that look for blocks with cracks and list the tiles near them, if there
    /// are any.
    pub fn search_passes(&self) -> Result<Option<[Ready<'_, ComputePipeline>; 2]>, SkipReason> {
        let (Some([walk, list]), Some(tiles)) = (self.passes.search, &self.lines.tiles) else {
            return Ok(None);
        };
        let key = self.passes.key.for_walk();
        let mut walked = vec![texture_entry(10, &tiles.blocks)];
        if key.contains(LineKey::CRACKS) {
            walked.extend(tiles.lists.cell_entries());
        }
        let mut listed = vec![texture_entry(12, &tiles.blocks)];
        listed.extend(tiles.lists.entries());
        Ok(Some([
            self.compute((SearchPass::Walk(key), walk), walked)?,
            self.compute((SearchPass::Tiles, list), listed)?,
        ]))
    }

    fn tiles(&self) -> Result<&Tiles, SkipReason> {
        self.lines.tiles.as_ref().ok_or(NOT_READY)
    }

    /// The passes of the lines along cracks.
    pub fn crack_passes<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<ReadyCracks<'a>, SkipReason> {
        let columns = match (passes.columns, &cracks.columns) {
            (Some(id), Some(columns)) => {
                let stored = cracks.store.entries(self.request.copies());
                Some((self.render(id, LinePass::Columns, &stored)?, columns))
            }
            _ => None,
        };
        Ok(ReadyCracks {
            tiles: self.lines.tiles.as_ref().map(|tiles| &tiles.lists),
            columns,
            find: self.find_pass(&passes.find, cracks)?,
            ink: self.draw_pass(passes.draw, cracks)?,
            strokes: self.strokes_pass(passes, cracks)?,
        })
    }

    /// The passes that find cracks.
    fn find_pass<'a>(
        &'a self,
        pass: &FindPass,
        cracks: &'a Cracks,
    ) -> Result<ReadyFind<'a>, SkipReason> {
        match (pass, &cracks.store) {
            (FindPass::Pixels(id), CrackStore::Texture(texture)) => {
                let entries = self.entries(self.passes.key.for_find())?;
                let ready = self.render(*id, LinePass::Find, &entries)?;
                Ok(ReadyFind::Pixels(ready, texture))
            }
            (FindPass::Cells(passes), CrackStore::Buffers(buffers)) => {
                let mut copies = 0;
                let ready = passes.iter().map(|(pass, id)| {
                    let entries = self.cell_entries(*pass, (cracks, buffers), &mut copies)?;
                    Ok((*pass, self.compute((*pass, *id), entries)?))
                });
                Ok(ReadyFind::Cells(ReadyCells {
                    passes: ready.collect::<Result<_, SkipReason>>()?,
                    lists: &self.tiles()?.lists,
                    buffers,
                    densities: cracks.densities.as_ref(),
                    holds: self.lines.holds.as_ref(),
                }))
            }
            _ => Err(NOT_READY),
        }
    }

    /// What a pass over the cells with cracks binds besides the scene. `copies`: passes so far that
    /// copy the planes of cracks and add to them.
    fn cell_entries<'a>(
        &'a self,
        pass: SearchPass,
        (cracks, buffers): (&'a Cracks, &'a CrackBuffers),
        copies: &mut usize,
    ) -> Result<Vec<BindGroupEntry<'a>>, SkipReason> {
        let densities = cracks.densities.as_ref().map(LineDensities::entry);
        let mut entries = self.tiles()?.lists.cell_entries().to_vec();
        match pass {
            SearchPass::Link { .. } | SearchPass::Join => {
                entries.extend(buffers.link_entries(*copies % 2));
                *copies += 1;
            }
            SearchPass::Hold(_) => {
                let holds = self.lines.holds.as_ref().ok_or(NOT_READY)?;
                entries.push(buffers.written_planes(*copies));
                entries.extend(holds.entries());
            }
            SearchPass::CloseGaps => {
                entries.extend(buffers.gaps_entries(*copies % 2));
                *copies += 1;
            }
            // It runs for the whole grid.
            SearchPass::Measure { .. } => {
                entries = vec![buffers.planes_entry(*copies), densities.ok_or(NOT_READY)?];
            }
            SearchPass::Corners => entries.push(buffers.written_planes(*copies)),
            SearchPass::Settle(_) => {
                entries.extend(buffers.settle_entries(*copies));
                entries.extend(densities);
            }
            SearchPass::Ends(_) => {
                let strokes = cracks.strokes.as_ref().ok_or(NOT_READY)?;
                entries.extend(cracks.store.entries(*copies));
                entries.push(strokes.entry());
            }
            _ => entries.extend(buffers.cell_entries()),
        }
        Ok(entries)
    }

    /// The pass that draws the ink of cracks.
    fn draw_pass(
        &self,
        id: CachedRenderPipelineId,
        cracks: &Cracks,
    ) -> Result<Ready<'_, RenderPipeline>, SkipReason> {
        let key = self.passes.key.for_draw();
        let copies = self.request.copies();
        let mut entries = match &cracks.columns {
            None => cracks.store.entries(copies),
            Some(columns) => vec![texture_entry(13, columns)],
        };
        if let (Some(_), CrackStore::Buffers(buffers)) = (&cracks.columns, &cracks.store) {
            entries.push(texture_entry(12, &self.tiles()?.blocks));
            entries.extend(
                key.contains(LineKey::CLOSED_GAPS)
                    .then(|| buffers.planes_entry(copies)),
            );
        }
        if key.contains(LineKey::OBJECT_IDS) {
            entries.push(self.ids()?);
        }
        self.render(id, LinePass::Draw, &entries)
    }

    /// The pass that draws strokes beyond loose ends, if there is one.
    fn strokes_pass<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<Option<ReadyStrokes<'a>>, SkipReason> {
        let (Some(id), Some(strokes)) = (passes.strokes, &cracks.strokes) else {
            return Ok(None);
        };
        let key = self.passes.key.for_strokes();
        let ids = key
            .contains(LineKey::OBJECT_IDS)
            .then(|| self.ids())
            .transpose()?;
        let ready = self.render(id, LinePass::Strokes, ids.as_slice())?;
        Ok(Some((ready, strokes)))
    }

    fn ids(&self) -> Result<BindGroupEntry<'_>, SkipReason> {
        let ids = self.texels()?.ids.ok_or(NOT_READY)?;
        Ok(entry(8, ids.into_binding()))
    }
}

fn texture_entry(binding: u32, texture: &CachedTexture) -> BindGroupEntry<'_> {
    entry(binding, (&texture.default_view).into_binding())
}
