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
    sources::{NOT_READY, Reads, Sources, Texels},
};
use crate::{
    bind_groups::Binder,
    depth::prepare::ViewDepthRange,
    diagnostics::SkipReason,
    gpu::entry,
    lines::{
        cracks::CrackStore,
        find::Resolved,
        history::{HistoryKey, LineHistory},
        key::LineKey,
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
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> Result<Ready<'_, RenderPipeline>, SkipReason> {
        let pipeline = self.binder.cache.get_render_pipeline(id).ok_or(NOT_READY)?;
        Ok((pipeline, self.group(layout, entries)?))
    }

    /// A compute pass that binds the uniform and these entries.
    pub(super) fn compute(
        &self,
        id: CachedComputePipelineId,
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> Result<Ready<'_, ComputePipeline>, SkipReason> {
        let pipeline = self
            .binder
            .cache
            .get_compute_pipeline(id)
            .ok_or(NOT_READY)?;
        Ok((pipeline, self.group(layout, entries)?))
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
    pub(super) fn texels(&self) -> Result<Texels<'_>, SkipReason> {
        match &self.lines.resolved {
            Some(resolved) => Ok(resolved.into()),
            None => self.prepass(),
        }
    }

    /// The pass that picks one sample of every pixel, if the view is multisampled.
    pub fn resolve_pass(&self) -> Result<Option<ResolvePass<'_>>, SkipReason> {
        let (Some((key, id)), Some(resolved)) = (&self.passes.resolve, &self.lines.resolved) else {
            return Ok(None);
        };
        let reads = Reads {
            normals: key.normals,
            ids: key.ids,
            widths: key.widths,
        };
        let mut entries = vec![];
        self.prepass()?.push(reads, &mut entries)?;
        Ok(Some((resolved, self.render(*id, &key.layout(), &entries)?)))
    }

    /// The pass that mixes the ink with that of the frames before, if lines have a history.
    pub fn history_pass(&self) -> Result<Option<HistoryPass<'_>>, SkipReason> {
        let ViewLines { history, ink, .. } = self.lines;
        let (Some(id), Some(history), Some(ink)) = (self.passes.history, history, ink) else {
            return Ok(None);
        };
        let motion = self.sources.motion.ok_or(NOT_READY)?;
        let mut entries = vec![
            entry(23, (&ink.default_view).into_binding()),
            entry(24, motion.into_binding()),
        ];
        self.prepass()?.push(Reads::default(), &mut entries)?;
        entries.extend(history.entries());
        let ready = self.render(id, &HistoryKey::layout(), &entries)?;
        Ok(Some((history, ready)))
    }

    /// The pass that draws the faithful equations, if there are any.
    pub fn faithful_pass(&self) -> Result<Option<Ready<'_, RenderPipeline>>, SkipReason> {
        let Some(id) = self.passes.faithful else {
            return Ok(None);
        };
        let key = self.passes.key.for_faithful();
        let entries = self.entries(key)?;
        Ok(Some(self.render(id, &key.faithful_layout(), &entries)?))
    }

    /// What the pass of a part of a key binds of the scene, see [`LineKey`]'s layouts.
    pub(super) fn entries(&self, key: LineKey) -> Result<Vec<BindGroupEntry<'_>>, SkipReason> {
        let mut entries = vec![];
        if !key.contains(LineKey::DEPTH) {
            return Ok(entries);
        }
        let reads = Reads {
            normals: key.contains(LineKey::NORMALS),
            ids: key.contains(LineKey::OBJECT_IDS),
            widths: key.contains(LineKey::WIDTH_MAP),
        };
        self.texels()?.push(reads, &mut entries)?;
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
        let mut walked = self.entries(key)?;
        walked.push(texture_entry(10, &tiles.blocks));
        if key.contains(LineKey::CRACKS) {
            walked.extend(tiles.lists.cell_entries());
        }
        let mut listed = vec![texture_entry(12, &tiles.blocks)];
        listed.extend(tiles.lists.entries());
        Ok(Some([
            self.compute(walk, &key.walk_layout(), &walked)?,
            self.compute(list, &LineKey::tiles_layout(), &listed)?,
        ]))
    }

    pub(super) fn tiles(&self) -> Result<&Tiles, SkipReason> {
        self.lines.tiles.as_ref().ok_or(NOT_READY)
    }

    /// The passes of the lines along cracks.
    pub fn crack_passes<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<ReadyCracks<'a>, SkipReason> {
        let key = self.passes.key.for_find();
        let find = self.find_pass(passes.find, key, cracks)?;
        let columns = match (passes.columns, &cracks.columns) {
            (Some(id), Some(columns)) => {
                let layout = self.passes.key.for_columns().columns_layout();
                let stored = cracks.store.entries(self.request.copies());
                Some((self.render(id, &layout, &stored)?, columns))
            }
            _ => None,
        };
        Ok(ReadyCracks {
            tiles: self.lines.tiles.as_ref().map(|tiles| &tiles.lists),
            columns,
            find,
            ink: self.draw_pass(passes.draw, cracks)?,
            strokes: self.strokes_pass(passes, cracks)?,
        })
    }

    /// The pass that finds cracks.
    fn find_pass<'a>(
        &'a self,
        pass: FindPass,
        key: LineKey,
        cracks: &'a Cracks,
    ) -> Result<ReadyFind<'a>, SkipReason> {
        let mut entries = self.entries(key)?;
        match (pass, &cracks.store) {
            (FindPass::Pixels(id), CrackStore::Texture(texture)) => {
                let ready = self.render(id, &key.find_layout(), &entries)?;
                Ok(ReadyFind::Pixels(ready, texture))
            }
            (FindPass::Cells(passes), CrackStore::Buffers(buffers)) => {
                let lists = &self.tiles()?.lists;
                entries.extend(lists.cell_entries());
                entries.extend(buffers.cell_entries());
                Ok(ReadyFind::Cells(Box::new(ReadyCells {
                    lists,
                    buffers,
                    find: self.compute(passes.find, &key.cells_layout(), &entries)?,
                    link: self.link_passes(&passes, buffers)?,
                    join: self.join_pass(&passes, buffers)?,
                    hold: self.hold_pass(&passes, buffers)?,
                    close_gaps: self.gaps_pass(&passes, buffers)?,
                    measure: self.measure_passes(&passes, cracks, buffers)?,
                    corners: self.corners_pass(&passes, buffers)?,
                    settle: self.settle_pass(&passes, cracks, buffers)?,
                    ends: self.ends_pass(&passes, cracks)?,
                })))
            }
            _ => Err(NOT_READY),
        }
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
                key.contains(LineKey::BRIDGED)
                    .then(|| buffers.planes_entry(copies)),
            );
        }
        if key.contains(LineKey::OBJECT_IDS) {
            entries.push(self.ids()?);
        }
        self.render(id, &key.draw_layout(), &entries)
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
        let ready = self.render(id, &key.strokes_layout(), ids.as_slice())?;
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
