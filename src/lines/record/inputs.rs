//! The passes of a view's lines, ready to be recorded: pipelines and what they bind.

use bevy::render::{
    render_resource::{
        BindGroup, BindGroupEntry, BindGroupLayoutDescriptor, BindingResource,
        CachedComputePipelineId, CachedRenderPipelineId, ComputePipeline, IntoBinding,
        PipelineCache, RenderPipeline, TextureView,
    },
    renderer::RenderDevice,
    texture::CachedTexture,
};

use super::{
    ready::{Ready, ReadyCells, ReadyCracks, ReadyFind, ReadyStrokes},
    sources::{NOT_READY, Reads, Sources, Texels, entry},
};
use crate::{
    depth::prepare::ViewDepthRange,
    diagnostics::SkipReason,
    lines::{
        cracks::CrackStore,
        find::Resolved,
        key::LineKey,
        memory::{LineMemory, MemoryKey},
        passes::{CrackPasses, FindPass, LinePasses},
        prepare::{Cracks, Tiles, ViewLines},
        request::LineRequest,
    },
    objects::{OBJECT_DEPTHS_BINDING, ObjectStyleBuffer},
};

/// What the passes of a view read: of the lines, of the scene, the visible range.
pub(super) type ViewParts<'a> = (
    (&'a LineRequest, &'a LinePasses, &'a ViewLines),
    Sources<'a>,
    Option<&'a ViewDepthRange>,
);

/// What the passes read.
pub(super) struct Inputs<'a> {
    pub parts: ViewParts<'a>,
    /// The table of the styles of objects.
    pub styles: &'a ObjectStyleBuffer,
    pub cache: &'a PipelineCache,
    pub device: RenderDevice,
}

/// The pass that remembers, ready to be recorded.
type MemoryPass<'a> = (&'a LineMemory, Ready<'a, RenderPipeline>);

/// The pass that picks samples, ready to be recorded.
type ResolvePass<'a> = (&'a Resolved, Ready<'a, RenderPipeline>);

impl Inputs<'_> {
    /// The pass that draws the faithful equations, if there are any.
    pub fn faithful_pass(&self) -> Result<Option<Ready<'_, RenderPipeline>>, SkipReason> {
        let (_, passes, _) = self.parts.0;
        let Some(id) = passes.faithful else {
            return Ok(None);
        };
        let key = passes.key.for_faithful();
        let entries = self.entries(&key, key.faithful[1])?;
        let group = self.group(&key.faithful_layout(), &entries);
        Ok(Some((self.pipeline(id)?, group)))
    }

    pub(super) fn pipeline(
        &self,
        id: CachedRenderPipelineId,
    ) -> Result<&RenderPipeline, SkipReason> {
        self.cache.get_render_pipeline(id).ok_or(NOT_READY)
    }

    pub(super) fn group(
        &self,
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> BindGroup {
        let layout = self.cache.get_bind_group_layout(layout);
        self.device
            .create_bind_group("comics_lines", &layout, entries)
    }

    pub(super) fn uniform(&self) -> Result<BindingResource<'_>, SkipReason> {
        let (_, _, lines) = self.parts.0;
        lines.uniform.binding().ok_or(NOT_READY)
    }

    /// The surfaces of the view.
    fn prepass(&self) -> Result<Texels<'_>, SkipReason> {
        let ((request, ..), sources, _) = self.parts;
        let depth = sources.depth.ok_or(SkipReason::NoDepthPrepass)?;
        // Those of a game's prepasses can be of cameras with different samples.
        let fits = |texture: &TextureView| texture.texture().sample_count() == request.samples;
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
        let (_, _, lines) = self.parts.0;
        match &lines.resolved {
            Some(resolved) => Ok(resolved.into()),
            None => self.prepass(),
        }
    }

    /// The pass that picks one sample of every pixel, if the view is multisampled.
    pub fn resolve_pass(&self) -> Result<Option<ResolvePass<'_>>, SkipReason> {
        let (_, passes, lines) = self.parts.0;
        let (Some((key, id)), Some(resolved)) = (&passes.resolve, &lines.resolved) else {
            return Ok(None);
        };
        let mut entries = vec![entry(1, self.uniform()?)];
        let reads = Reads {
            normals: key.normals,
            ids: key.ids,
            widths: key.widths,
        };
        self.prepass()?.push(reads, &mut entries)?;
        let group = self.group(&key.layout(), &entries);
        Ok(Some((resolved, (self.pipeline(*id)?, group))))
    }

    /// The pass that mixes the ink with that of the frames before, if lines remember.
    pub fn memory_pass(&self) -> Result<Option<MemoryPass<'_>>, SkipReason> {
        let ((_, passes, lines), sources, _) = self.parts;
        let (Some(id), Some(memory), Some(ink)) = (passes.memory, &lines.memory, &lines.ink) else {
            return Ok(None);
        };
        let motion = sources.motion.ok_or(NOT_READY)?;
        let mut entries = vec![entry(1, self.uniform()?)];
        self.prepass()?.push(Reads::default(), &mut entries)?;
        entries.push(entry(23, (&ink.default_view).into_binding()));
        entries.push(entry(24, motion.into_binding()));
        entries.extend(memory.entries());
        let group = self.group(&MemoryKey::layout(), &entries);
        Ok(Some((memory, (self.pipeline(id)?, group))))
    }

    /// The bindings of the passes that find lines. `normals`: the normals too.
    pub(super) fn entries(
        &self,
        key: &LineKey,
        normals: bool,
    ) -> Result<Vec<BindGroupEntry<'_>>, SkipReason> {
        let (_, sources, range) = self.parts;
        let mut entries = vec![entry(1, self.uniform()?)];
        let reads = Reads {
            normals,
            ids: key.ids,
            widths: key.weight.map,
        };
        self.texels()?.push(reads, &mut entries)?;
        if key.visible_range || key.weight.found_borders {
            let keys = range.and_then(ViewDepthRange::drawn).ok_or(NOT_READY)?;
            entries.push(entry(3, keys.as_entire_binding()));
        }
        if key.object_styles {
            let styles = self.styles.buffer().ok_or(NOT_READY)?;
            entries.push(entry(6, styles.as_entire_binding()));
        }
        if key.reads_places() {
            let places = sources.places.ok_or(NOT_READY)?;
            entries.push(entry(OBJECT_DEPTHS_BINDING, places.as_entire_binding()));
        }
        if key.marks {
            let picture = sources.picture.ok_or(NOT_READY)?;
            entries.push(entry(27, picture.into_binding()));
        }
        Ok(entries)
    }

    /// The passes of the lines along cracks.
    pub fn crack_passes<'a>(
        &'a self,
        passes: &CrackPasses,
        cracks: &'a Cracks,
    ) -> Result<ReadyCracks<'a>, SkipReason> {
        let key = self.parts.0.1.key.for_find();
        let (_, _, lines) = self.parts.0;
        let find = self.find_pass(passes.find, &key, cracks)?;
        let columns = match (passes.columns, &cracks.columns) {
            (Some(id), Some(columns)) => {
                let layout = self.parts.0.1.key.for_columns().columns_layout();
                let group = self.group(&layout, &self.stored(cracks)?);
                Some(((self.pipeline(id)?, group), columns))
            }
            _ => None,
        };
        Ok(ReadyCracks {
            tiles: lines.tiles.as_ref().map(|tiles| &tiles.lists),
            columns,
            find,
            ink: (self.pipeline(passes.draw)?, self.draw_group(cracks)?),
            strokes: self.strokes_pass(passes, cracks)?,
        })
    }

    /// The pass that finds cracks.
    fn find_pass<'a>(
        &'a self,
        pass: FindPass,
        key: &LineKey,
        cracks: &'a Cracks,
    ) -> Result<ReadyFind<'a>, SkipReason> {
        let mut entries = self.entries(key, key.creases)?;
        match (pass, &cracks.store) {
            (FindPass::Pixels(id), CrackStore::Texture(texture)) => {
                let group = self.group(&key.find_layout(), &entries);
                Ok(ReadyFind::Pixels((self.pipeline(id)?, group), texture))
            }
            (FindPass::Cells(passes), CrackStore::Buffers(buffers)) => {
                let lists = &self.tiles()?.lists;
                entries.extend(lists.cell_entries());
                entries.extend(buffers.cell_entries());
                let group = self.group(&key.cells_layout(), &entries);
                Ok(ReadyFind::Cells(ReadyCells {
                    lists,
                    buffers,
                    find: (self.compute(passes.find)?, group),
                    link: self.link_passes(&passes, buffers)?,
                    join: self.join_pass(&passes, buffers)?,
                    persist: self.persist_pass(&passes, buffers)?,
                    bridge: self.bridge_pass(&passes, buffers)?,
                    settle: self.settle_pass(&passes, buffers)?,
                    ends: self.ends_pass(&passes, cracks)?,
                }))
            }
            _ => Err(NOT_READY),
        }
    }

    pub(super) fn tiles(&self) -> Result<&Tiles, SkipReason> {
        let (_, _, lines) = self.parts.0;
        lines.tiles.as_ref().ok_or(NOT_READY)
    }

    pub(super) fn compute(
        &self,
        id: CachedComputePipelineId,
    ) -> Result<&ComputePipeline, SkipReason> {
        self.cache.get_compute_pipeline(id).ok_or(NOT_READY)
    }

    /// The bindings of a pass that searches stored cracks.
    fn stored<'a>(&'a self, cracks: &'a Cracks) -> Result<Vec<BindGroupEntry<'a>>, SkipReason> {
        let uniform = [entry(1, self.uniform()?)];
        let copies = self.parts.0.0.copies();
        let stored = cracks.store.entries(copies);
        Ok(uniform.into_iter().chain(stored).collect())
    }

    /// The passes that look for blocks with cracks and list the tiles near them, if there
    /// are any.
    pub fn search_passes(&self) -> Result<Option<[Ready<'_, ComputePipeline>; 2]>, SkipReason> {
        let (_, passes, lines) = self.parts.0;
        let (Some([walk, list]), Some(tiles)) = (passes.search, &lines.tiles) else {
            return Ok(None);
        };
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
        Ok(Some([
            (self.compute(walk)?, walked),
            (self.compute(list)?, listed),
        ]))
    }

    /// The bindings of a pass that searches the texture at this binding.
    fn searched<'a>(
        &'a self,
        (binding, texture): (u32, &'a CachedTexture),
    ) -> Result<Vec<BindGroupEntry<'a>>, SkipReason> {
        Ok(vec![
            entry(1, self.uniform()?),
            entry(binding, (&texture.default_view).into_binding()),
        ])
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
        let key = self.parts.0.1.key.for_strokes();
        let mut entries = vec![entry(1, self.uniform()?)];
        if key.object_styles {
            let ids = self.texels()?.ids.ok_or(NOT_READY)?;
            entries.push(entry(8, ids.into_binding()));
        }
        let group = self.group(&key.strokes_layout(), &entries);
        Ok(Some(((self.pipeline(id)?, group), strokes)))
    }

    fn draw_group(&self, cracks: &Cracks) -> Result<BindGroup, SkipReason> {
        let (_, passes, _) = self.parts.0;
        let key = passes.key.for_draw();
        let mut entries = match (&cracks.columns, &cracks.store) {
            (None, _) => self.stored(cracks)?,
            (Some(columns), CrackStore::Texture(_)) => self.searched((13, columns))?,
            (Some(columns), CrackStore::Buffers(buffers)) => {
                let mut entries = self.searched((13, columns))?;
                let blocks = &self.tiles()?.blocks.default_view;
                entries.push(entry(12, blocks.into_binding()));
                let planes = || buffers.planes_entry(self.parts.0.0.copies());
                entries.extend(key.bridged.then(planes));
                entries
            }
        };
        if passes.key.object_styles {
            let ids = self.texels()?.ids.ok_or(NOT_READY)?;
            entries.push(entry(8, ids.into_binding()));
        }
        Ok(self.group(&key.draw_layout(), &entries))
    }
}
