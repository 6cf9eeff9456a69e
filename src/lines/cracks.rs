//! Records the passes that find cracks.

use bevy::render::{
    render_resource::{
        BindGroup, CommandEncoder, ComputePassDescriptor, ComputePipeline, RenderPassDescriptor,
        RenderPipeline,
    },
    texture::CachedTexture,
};

use super::{
    draw::cleared,
    key::WORKGROUP,
    prepare::blocks,
    request::LineRequest,
    tiles::{TileList, TileLists},
};

/// A pass that is ready to be recorded: its pipeline and bindings.
pub(super) type Ready<'a, P> = (&'a P, BindGroup);

/// The pass that finds cracks, ready to be recorded.
pub(super) enum ReadyFind<'a> {
    Cells(&'a TileLists, Ready<'a, ComputePipeline>),
    Pixels(Ready<'a, RenderPipeline>),
}

/// The passes of the lines along cracks, ready to be recorded.
pub(super) struct ReadyCracks<'a> {
    pub tiles: Option<&'a TileLists>,
    pub find: ReadyFind<'a>,
    pub columns: Option<(Ready<'a, RenderPipeline>, &'a CachedTexture)>,
    pub ink: Ready<'a, RenderPipeline>,
    pub texture: &'a CachedTexture,
}

impl ReadyCracks<'_> {
    /// Finds the cracks.
    pub fn find(&self, encoder: &mut CommandEncoder) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_find_lines"),
            color_attachments: &[Some(cleared(self.texture))],
            ..Default::default()
        });
        match &self.find {
            ReadyFind::Pixels((pipeline, group)) => {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.draw(0..3, 0..1);
            }
            // The pass above clears the texture.
            ReadyFind::Cells(lists, (pipeline, group)) => {
                drop(pass);
                let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
                    label: Some("comics_find_in_cells"),
                    timestamp_writes: None,
                });
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, group, &[]);
                lists.dispatch_cells(&mut pass);
            }
        }
    }

    /// Finds the best crack of each pixel's column.
    pub fn search_columns(&self, encoder: &mut CommandEncoder) {
        let Some((columns, texture)) = &self.columns else {
            return;
        };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("comics_line_columns"),
            color_attachments: &[Some(cleared(texture))],
            ..Default::default()
        });
        self.draw(&mut pass, columns, TileList::Columns);
    }

    /// Draws the ink.
    pub fn draw_ink(&self, pass: &mut wgpu::RenderPass) {
        self.draw(pass, &self.ink, TileList::Inked);
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
