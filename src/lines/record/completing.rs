//! The passes that complete cracks, ready to be recorded: see `cells.wgsl` and those after it.

use bevy::render::render_resource::{ComputePipeline, IntoBinding};

use super::{
    inputs::Inputs,
    ready::{Ready, ReadyLives},
    sources::{NOT_READY, Reads, entry},
};
use crate::{
    diagnostics::SkipReason,
    lines::{cracks::CrackBuffers, key::LineKey, passes::CellPasses, prepare::Cracks},
};

impl Inputs<'_> {
    /// The passes that continue lines.
    pub(super) fn link_passes<'a>(
        &'a self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Vec<Ready<'a, ComputePipeline>>, SkipReason> {
        let Some([full, last]) = passes.link else {
            return Ok(vec![]);
        };
        let (request, ..) = self.parts.0;
        let count = request.links();
        let pass = |i: usize| {
            let id = if i + 1 == count { last } else { full };
            let mut entries = vec![entry(1, self.uniform()?)];
            entries.extend(self.tiles()?.lists.cell_entries());
            entries.extend(buffers.link_entries(i % 2));
            let group = self.group(&LineKey::link_layout(), &entries);
            Ok((self.compute(id)?, group))
        };
        (0..count).map(pass).collect()
    }

    /// The pass that joins lines over ledges, if there is one.
    pub(super) fn join_pass<'a>(
        &'a self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Ready<'a, ComputePipeline>>, SkipReason> {
        let Some(id) = passes.join else {
            return Ok(None);
        };
        let mut entries = vec![entry(1, self.uniform()?)];
        entries.extend(self.tiles()?.lists.cell_entries());
        entries.extend(buffers.link_entries(self.parts.0.0.links() % 2));
        let group = self.group(&LineKey::link_layout(), &entries);
        Ok(Some((self.compute(id)?, group)))
    }

    /// The pass that closes gaps, if there is one.
    pub(super) fn bridge_pass<'a>(
        &'a self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Ready<'a, ComputePipeline>>, SkipReason> {
        let Some(id) = passes.bridge else {
            return Ok(None);
        };
        let mut entries = vec![entry(1, self.uniform()?)];
        entries.extend(self.tiles()?.lists.cell_entries());
        entries.extend(buffers.bridge_entries(self.parts.0.0.joined() % 2));
        let group = self.group(&LineKey::bridge_layout(), &entries);
        Ok(Some((self.compute(id)?, group)))
    }

    /// The pass that completes cracks, if there is one.
    pub(super) fn settle_pass<'a>(
        &'a self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Ready<'a, ComputePipeline>>, SkipReason> {
        let Some(id) = passes.settle else {
            return Ok(None);
        };
        let key = self.parts.0.1.key.for_settle();
        let mut entries = if key.reads_depth() {
            self.entries(&key, key.weight.light)?
        } else {
            vec![entry(1, self.uniform()?)]
        };
        entries.extend(self.tiles()?.lists.cell_entries());
        let copies = self.parts.0.0.copies();
        entries.extend(buffers.settle_entries(copies % 2));
        let group = self.group(&key.settle_layout(), &entries);
        Ok(Some((self.compute(id)?, group)))
    }

    /// The pass that keeps the lines of the last frames, if there is one.
    pub(super) fn persist_pass<'a>(
        &'a self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<ReadyLives<'a>>, SkipReason> {
        let ((request, all, lines), sources, _) = self.parts;
        let (Some(id), Some(lives)) = (passes.persist, &lines.lives) else {
            return Ok(None);
        };
        let key = all.key.for_persist();
        let mut entries = vec![entry(1, self.uniform()?)];
        if key.motion {
            let motion = sources.motion.ok_or(NOT_READY)?;
            self.texels()?.push(Reads::default(), &mut entries)?;
            entries.push(entry(24, motion.into_binding()));
        }
        entries.extend(self.tiles()?.lists.cell_entries());
        entries.push(buffers.written_planes(request.joined()));
        entries.extend(lives.entries());
        let group = self.group(&key.persist_layout(), &entries);
        Ok(Some(((self.compute(id)?, group), lives)))
    }

    /// The pass that finds loose ends, if there is one.
    pub(super) fn ends_pass<'a>(
        &'a self,
        passes: &CellPasses,
        cracks: &Cracks,
    ) -> Result<Option<Ready<'a, ComputePipeline>>, SkipReason> {
        let (Some(id), Some(strokes)) = (passes.ends, &cracks.strokes) else {
            return Ok(None);
        };
        let mut entries = vec![entry(1, self.uniform()?)];
        entries.extend(self.tiles()?.lists.cell_entries());
        let copies = self.parts.0.0.copies();
        entries.extend(cracks.store.entries(copies));
        entries.push(strokes.entry());
        let group = self.group(&LineKey::ends_layout(), &entries);
        Ok(Some((self.compute(id)?, group)))
    }
}
