//! The passes that complete cracks, ready to be recorded: see `cells.wgsl` and those after it.

use bevy::render::render_resource::{
    BindGroupEntry, BindGroupLayoutDescriptor, CachedComputePipelineId, ComputePipeline,
};

use super::{
    inputs::Inputs,
    ready::{Ready, ReadyDensities, ReadyHolds},
};
use crate::{
    diagnostics::SkipReason,
    lines::{
        cracks::{CrackBuffers, LineDensities},
        key::LineKey,
        passes::CellPasses,
        prepare::Cracks,
    },
};

type Compute<'a> = Ready<'a, ComputePipeline>;

impl Inputs<'_> {
    /// A pass over the cells with cracks.
    fn in_cells(
        &self,
        id: CachedComputePipelineId,
        layout: &BindGroupLayoutDescriptor,
        entries: &[BindGroupEntry],
    ) -> Result<Compute<'_>, SkipReason> {
        let mut all = self.tiles()?.lists.cell_entries().to_vec();
        all.extend_from_slice(entries);
        self.compute(id, layout, &all)
    }

    /// The passes that continue lines.
    pub(super) fn link_passes(
        &self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Vec<Compute<'_>>, SkipReason> {
        let Some([full, last]) = passes.link else {
            return Ok(vec![]);
        };
        let count = self.request.links();
        let pass = |i: usize| {
            let id = if i + 1 == count { last } else { full };
            self.in_cells(id, &LineKey::link_layout(), &buffers.link_entries(i % 2))
        };
        (0..count).map(pass).collect()
    }

    /// The pass that joins lines over ledges, if there is one.
    pub(super) fn join_pass(
        &self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Compute<'_>>, SkipReason> {
        let entries = buffers.link_entries(self.request.links() % 2);
        let pass = |id| self.in_cells(id, &LineKey::link_layout(), &entries);
        passes.join.map(pass).transpose()
    }

    /// The pass that closes gaps, if there is one.
    pub(super) fn gaps_pass(
        &self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Compute<'_>>, SkipReason> {
        let entries = buffers.gaps_entries(self.request.joined() % 2);
        let pass = |id| self.in_cells(id, &LineKey::gaps_layout(), &entries);
        passes.close_gaps.map(pass).transpose()
    }

    /// The passes that measure how densely lines lie, if there are any.
    pub(super) fn measure_passes<'a>(
        &'a self,
        passes: &CellPasses,
        cracks: &'a Cracks,
        buffers: &CrackBuffers,
    ) -> Result<Option<ReadyDensities<'a>>, SkipReason> {
        let (Some([fine, coarse]), Some(densities)) = (passes.measure, &cracks.densities) else {
            return Ok(None);
        };
        let planes = buffers.planes_entry(self.request.copies());
        let entries = [planes, densities.entry()];
        let pass = |id| self.compute(id, &LineKey::measure_layout(), &entries);
        Ok(Some(([pass(fine)?, pass(coarse)?], densities)))
    }

    /// The pass that notes which cracks meet at corners, if there is one.
    pub(super) fn corners_pass(
        &self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<Compute<'_>>, SkipReason> {
        let planes = [buffers.written_planes(self.request.copies())];
        let pass = |id| self.in_cells(id, &LineKey::corners_layout(), &planes);
        passes.corners.map(pass).transpose()
    }

    /// The pass that completes cracks, if there is one.
    pub(super) fn settle_pass(
        &self,
        passes: &CellPasses,
        cracks: &Cracks,
        buffers: &CrackBuffers,
    ) -> Result<Option<Compute<'_>>, SkipReason> {
        let Some(id) = passes.settle else {
            return Ok(None);
        };
        let key = self.passes.key.for_settle();
        let mut entries = buffers.settle_entries(self.request.copies());
        entries.extend(cracks.densities.as_ref().map(LineDensities::entry));
        entries.extend(self.entries(key)?);
        Ok(Some(self.in_cells(id, &key.settle_layout(), &entries)?))
    }

    /// The pass that keeps the lines of the last frames, if there is one.
    pub(super) fn hold_pass(
        &self,
        passes: &CellPasses,
        buffers: &CrackBuffers,
    ) -> Result<Option<ReadyHolds<'_>>, SkipReason> {
        let (Some(id), Some(holds)) = (passes.hold, &self.lines.holds) else {
            return Ok(None);
        };
        let key = self.passes.key.for_hold();
        let mut entries = vec![buffers.written_planes(self.request.joined())];
        entries.extend(holds.entries());
        entries.extend(self.entries(key)?);
        let ready = self.in_cells(id, &key.hold_layout(), &entries)?;
        Ok(Some((ready, holds)))
    }

    /// The pass that finds loose ends, if there is one.
    pub(super) fn ends_pass(
        &self,
        passes: &CellPasses,
        cracks: &Cracks,
    ) -> Result<Option<Compute<'_>>, SkipReason> {
        let (Some(id), Some(strokes)) = (passes.ends, &cracks.strokes) else {
            return Ok(None);
        };
        let mut entries = cracks.store.entries(self.request.copies());
        entries.push(strokes.entry());
        Ok(Some(self.in_cells(
            id,
            &LineKey::ends_layout(),
            &entries,
        )?))
    }
}
