//! Records the passes that find cracks.

use bevy::render::{
    render_resource::{
        BindGroup, CommandEncoder, ComputePassDescriptor, ComputePipeline, LoadOp,
        RenderPassDescriptor, RenderPipeline,
    },
    texture::CachedTexture,
};

use crate::{
    gpu::{attachment, compute_pass},
    lines::{
        cracks::{CrackBuffers, LineDensities},
        draw::StrokeList,
        history::LineHolds,
        key::SearchPass,
        request::{LineRequest, WORKGROUP, blocks},
        textures::cleared,
        tiles::{TileList, TileLists, draw_tiles},
    },
};

/// A pass that is ready to be recorded: its pipeline and bindings.
pub(super) type Ready<'a, P> = (&'a P, BindGroup);

/// The pass that draws strokes beyond loose ends, ready to be recorded.
pub(super) type ReadyStrokes<'a> = (Ready<'a, RenderPipeline>, &'a StrokeList);

/// The passes that find cracks in cells, ready to be recorded.
pub(super) struct ReadyCells<'a> {
    pub lists: &'a TileLists,
    pub buffers: &'a CrackBuffers,
    pub densities: Option<&'a LineDensities>,
    pub holds: Option<&'a LineHolds>,
    pub passes: Vec<(SearchPass, Ready<'a, ComputePipeline>)>,
}

impl ReadyCells<'_> {
    fn record(&self, encoder: &mut CommandEncoder) {
        self.buffers.clear(encoder);
        // Copies of the planes so far.
        let mut copies = 0;
        for (pass, (pipeline, group)) in &self.passes {
            match (pass, self.holds) {
                (SearchPass::Link { .. } | SearchPass::Join | SearchPass::CloseGaps, _) => {
                    self.buffers.copy_planes(encoder, copies);
                    copies += 1;
                }
                (SearchPass::Hold(_), Some(holds)) => holds.clear(encoder),
                (SearchPass::Corners, _) => self.buffers.clear_corners(encoder, copies),
                _ => {}
            }
            let mut compute = compute_pass(encoder, pass.label(), (pipeline, group), &[]);
            match (pass, self.densities) {
                (SearchPass::Measure { coarse }, Some(densities)) => {
                    densities.dispatch(&mut compute, *coarse);
                }
                _ => self.lists.dispatch_cells(&mut compute),
            }
        }
    }
}

/// The passes that find cracks, ready to be recorded.
pub(super) enum ReadyFind<'a> {
    Cells(ReadyCells<'a>),
    /// Draws them into a texture.
    Pixels(Ready<'a, RenderPipeline>, &'a CachedTexture),
}

/// The passes of the lines along cracks, ready to be recorded.
pub(super) struct ReadyCracks<'a> {
    pub tiles: Option<&'a TileLists>,
    pub find: ReadyFind<'a>,
    pub columns: Option<(Ready<'a, RenderPipeline>, &'a CachedTexture)>,
    pub ink: Ready<'a, RenderPipeline>,
    pub strokes: Option<ReadyStrokes<'a>>,
}

impl ReadyCracks<'_> {
    /// Finds the cracks.
    pub fn find(&self, encoder: &mut CommandEncoder) {
        match &self.find {
            ReadyFind::Pixels(ready, texture) => {
                let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                    label: Some("comics_find_lines"),
                    color_attachments: &[Some(cleared(texture))],
                    ..Default::default()
                });
                draw_tiles(&mut pass, (ready.0, &ready.1), None);
            }
            ReadyFind::Cells(cells) => cells.record(encoder),
        }
    }

    /// Finds the best cracks of each pixel's column.
    pub fn search_columns(&self, encoder: &mut CommandEncoder) {
        let Some((columns, texture)) = &self.columns else {
            return;
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_line_columns"),
            color_attachments: &[
                // What lies between the tiles is not read.
                Some(attachment(&texture.default_view, LoadOp::Load)),
            ],
            ..Default::default()
        });
        self.draw(&mut pass, columns, TileList::Columns);
    }

    /// Draws the ink.
    pub fn draw_ink(&self, pass: &mut wgpu::RenderPass) {
        self.draw(pass, &self.ink, TileList::Inked);
        if let Some(((pipeline, group), strokes)) = &self.strokes {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            strokes.draw(pass);
        }
    }

    /// Draws the tiles of a list; without lists, all pixels.
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass,
        (pipeline, group): &Ready<RenderPipeline>,
        list: TileList,
    ) {
        let tiles = self.tiles.map(|tiles| (tiles, list));
        draw_tiles(pass, (pipeline, group), tiles);
    }
}

/// Looks for blocks with cracks or jumps, and writes the lists of tiles up to `last`.
pub(super) fn search_tiles(
    encoder: &mut CommandEncoder,
    [walk, list]: &[Ready<ComputePipeline>; 2],
    request: &LineRequest,
    last: TileList,
) {
    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
        label: Some("comics_search_tiles"),
        timestamp_writes: None,
    });
    let blocks = blocks(request.rect);
    let workgroups = [
        [blocks.x.div_ceil(WORKGROUP), blocks.y, 1],
        TileLists::workgroups(request, last),
    ];
    for ((pipeline, group), [x, y, z]) in [walk, list].into_iter().zip(workgroups) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(x, y, z);
    }
}
