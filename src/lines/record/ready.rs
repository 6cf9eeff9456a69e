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
        request::{LineRequest, WORKGROUP, blocks},
        textures::cleared,
        tiles::{TileList, TileLists},
    },
};

/// A pass that is ready to be recorded: its pipeline and bindings.
pub(super) type Ready<'a, P> = (&'a P, BindGroup);

/// The pass that keeps the lines of the last frames, ready to be recorded.
pub(super) type ReadyHolds<'a> = (Ready<'a, ComputePipeline>, &'a LineHolds);

/// The passes that measure how densely lines lie, ready to be recorded.
pub(super) type ReadyDensities<'a> = ([Ready<'a, ComputePipeline>; 2], &'a LineDensities);

/// The pass that draws strokes beyond loose ends, ready to be recorded.
pub(super) type ReadyStrokes<'a> = (Ready<'a, RenderPipeline>, &'a StrokeList);

/// The passes that find cracks in cells, ready to be recorded.
pub(super) struct ReadyCells<'a> {
    pub lists: &'a TileLists,
    pub buffers: &'a CrackBuffers,
    pub find: Ready<'a, ComputePipeline>,
    pub link: Vec<Ready<'a, ComputePipeline>>,
    pub join: Option<Ready<'a, ComputePipeline>>,
    pub hold: Option<ReadyHolds<'a>>,
    pub close_gaps: Option<Ready<'a, ComputePipeline>>,
    pub measure: Option<ReadyDensities<'a>>,
    pub corners: Option<Ready<'a, ComputePipeline>>,
    pub settle: Option<Ready<'a, ComputePipeline>>,
    pub ends: Option<Ready<'a, ComputePipeline>>,
}

impl ReadyCells<'_> {
    fn record(&self, encoder: &mut CommandEncoder) {
        self.buffers.clear(encoder);
        self.dispatch(encoder, "comics_find_in_cells", &self.find);
        for (i, link) in self.link.iter().enumerate() {
            self.buffers.copy_planes(encoder, i % 2);
            self.dispatch(encoder, "comics_link_lines", link);
        }
        if let Some(join) = &self.join {
            self.buffers.copy_planes(encoder, self.link.len() % 2);
            self.dispatch(encoder, "comics_join_lines", join);
        }
        let mut copies = self.link.len() + usize::from(self.join.is_some());
        if let Some((hold, holds)) = &self.hold {
            holds.clear(encoder);
            self.dispatch(encoder, "comics_hold_lines", hold);
        }
        if let Some(close_gaps) = &self.close_gaps {
            self.buffers.copy_planes(encoder, copies % 2);
            self.dispatch(encoder, "comics_close_gaps", close_gaps);
            copies += 1;
        }
        if let Some((passes, densities)) = &self.measure {
            densities.measure(encoder, passes);
        }
        if let Some(corners) = &self.corners {
            self.buffers.clear_corners(encoder, copies);
            self.dispatch(encoder, "comics_line_corners", corners);
        }
        if let Some(settle) = &self.settle {
            self.dispatch(encoder, "comics_settle_lines", settle);
        }
        if let Some(ends) = &self.ends {
            self.dispatch(encoder, "comics_line_ends", ends);
        }
    }

    fn dispatch(
        &self,
        encoder: &mut CommandEncoder,
        label: &str,
        (pipeline, group): &Ready<ComputePipeline>,
    ) {
        let mut pass = compute_pass(encoder, label, (pipeline, group), &[]);
        self.lists.dispatch_cells(&mut pass);
    }
}

/// The passes that find cracks, ready to be recorded.
pub(super) enum ReadyFind<'a> {
    Cells(Box<ReadyCells<'a>>),
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
            ReadyFind::Pixels((pipeline, group), texture) => {
                let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                    label: Some("comics_find_lines"),
                    color_attachments: &[Some(cleared(texture))],
                    ..Default::default()
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
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
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        match self.tiles {
            Some(tiles) => tiles.draw(pass, list),
            None => pass.draw(0..3, 0..1),
        }
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
