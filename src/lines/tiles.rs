//! Records the passes that find cracks, which draw tiles of the picture.

use bevy::{
    math::{UVec2, Vec4Swizzles},
    render::{
        render_resource::{
            BindGroup, CommandEncoder, ComputePassDescriptor, ComputePipeline,
            RenderPassDescriptor, RenderPipeline,
        },
        texture::CachedTexture,
    },
};

use super::{
    draw::cleared,
    key::{TILE, WORKGROUP},
    prepare::blocks,
    request::LineRequest,
};

/// A pass that is ready to be recorded: its pipeline and bindings.
pub(super) type Ready<'a, P> = (&'a P, BindGroup);

/// The passes of the lines along cracks, ready to be recorded.
pub(super) struct ReadyCracks<'a> {
    pub walk: Option<Ready<'a, ComputePipeline>>,
    pub find: Ready<'a, RenderPipeline>,
    pub columns: Option<(Ready<'a, RenderPipeline>, &'a CachedTexture)>,
    pub draw: Ready<'a, RenderPipeline>,
    pub texture: &'a CachedTexture,
}

impl ReadyCracks<'_> {
    /// Looks for blocks with cracks, and finds the cracks in them.
    pub fn find(&self, encoder: &mut CommandEncoder, request: &LineRequest) {
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
    pub fn search_columns(&self, encoder: &mut CommandEncoder, request: &LineRequest) {
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
pub(super) fn draw_tiles(
    pass: &mut wgpu::RenderPass,
    (pipeline, group): &Ready<RenderPipeline>,
    size: UVec2,
) {
    let tiles = size.x.div_ceil(TILE) * size.y.div_ceil(TILE);
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..4, 0..tiles);
}
