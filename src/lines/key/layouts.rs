//! What the shaders of the line passes bind.

use std::num::NonZeroU64;

use bevy::render::render_resource::{
    BindGroupLayoutDescriptor, BindGroupLayoutEntry, ShaderStages, StorageTextureAccess,
    TextureSampleType,
    binding_types::{
        storage_buffer_read_only_sized, storage_buffer_sized, texture_2d, texture_storage_2d,
        uniform_buffer, uniform_buffer_sized,
    },
};

use super::line_key::LineKey;
use crate::{
    depth::view::RANGE_SIZE,
    gpu::{UNFILTERABLE, sampled},
    lines::{request::LinePassUniform, textures::BLOCK_FORMAT},
    objects::{ids_entry, object_depths_entry, object_styles_entry, widths_entry},
};

impl LineKey {
    /// The layout entries of what the pass of a part of a key reads of the scene.
    fn inputs(self, stages: ShaderStages) -> Vec<BindGroupLayoutEntry> {
        if !self.contains(Self::DEPTH) {
            return vec![];
        }
        let float = || texture_2d(UNFILTERABLE);
        // The depth that hides highlighted objects.
        let picture = sampled(self.contains(Self::MULTISAMPLED_PICTURE), UNFILTERABLE);
        [
            (Self::DEPTH, float().build(2, stages)),
            (Self::RANGE, range_entry()),
            (Self::OBJECT_STYLES, object_styles_entry()),
            (Self::NORMALS, float().build(7, stages)),
            (Self::OBJECT_IDS, ids_entry(false)),
            (Self::OBJECT_DEPTHS, object_depths_entry()),
            (Self::HIGHLIGHTS, picture.build(27, stages)),
            (Self::WIDTH_MAP, widths_entry(false, stages)),
            (Self::MOTION, float().build(24, stages)),
        ]
        .into_iter()
        .filter(|(any, _)| self.intersects(*any))
        .map(|(_, mut entry)| {
            entry.visibility = stages;
            entry
        })
        .collect()
    }

    pub fn walk_layout(self) -> BindGroupLayoutDescriptor {
        let mut entries = self.inputs(ShaderStages::COMPUTE);
        let blocks = texture_storage_2d(BLOCK_FORMAT, StorageTextureAccess::WriteOnly);
        entries.push(blocks.build(10, ShaderStages::COMPUTE));
        if self.contains(Self::CRACKS) {
            entries.extend(written_buffers([16, 17]));
        }
        layout("comics_walk", ShaderStages::COMPUTE, entries)
    }

    pub fn cells_layout(self) -> BindGroupLayoutDescriptor {
        let inputs = self.inputs(ShaderStages::COMPUTE);
        in_cells("comics_find_in_cells", inputs, [], [18, 21])
    }

    pub fn link_layout() -> BindGroupLayoutDescriptor {
        in_cells("comics_link_lines", vec![], [20], [21])
    }

    pub fn gaps_layout() -> BindGroupLayoutDescriptor {
        in_cells("comics_close_gaps", vec![], [20], [18, 21])
    }

    pub fn corners_layout() -> BindGroupLayoutDescriptor {
        in_cells("comics_line_corners", vec![], [], [21])
    }

    pub fn measure_layout() -> BindGroupLayoutDescriptor {
        let planes = planes_entry(ShaderStages::COMPUTE);
        let [densities] = written_buffers([33]);
        layout(
            "comics_measure_lines",
            ShaderStages::COMPUTE,
            [planes, densities],
        )
    }

    pub fn hold_layout(self) -> BindGroupLayoutDescriptor {
        let inputs = self.inputs(ShaderStages::COMPUTE);
        in_cells("comics_hold_lines", inputs, [28], [21, 29])
    }

    pub fn ends_layout() -> BindGroupLayoutDescriptor {
        in_cells("comics_line_ends", vec![], [11, 19, 20], [30])
    }

    pub fn strokes_layout(self) -> BindGroupLayoutDescriptor {
        let ids = self.contains(Self::OBJECT_IDS).then(|| ids_entry(false));
        layout("comics_line_strokes", ShaderStages::VERTEX_FRAGMENT, ids)
    }

    pub fn settle_layout(self) -> BindGroupLayoutDescriptor {
        let mut entries = self.inputs(ShaderStages::COMPUTE);
        if self.contains(Self::SMOOTH) {
            entries.extend(written_buffers([22]));
        }
        if self.contains(Self::BUDGET) {
            entries.extend(read_buffers([33]));
        }
        in_cells("comics_settle_lines", entries, [20], [18])
    }

    pub fn find_layout(self) -> BindGroupLayoutDescriptor {
        let fragment = ShaderStages::FRAGMENT;
        layout("comics_find_lines", fragment, self.inputs(fragment))
    }

    pub fn faithful_layout(self) -> BindGroupLayoutDescriptor {
        let fragment = ShaderStages::FRAGMENT;
        layout("comics_faithful_lines", fragment, self.inputs(fragment))
    }

    pub fn columns_layout(self) -> BindGroupLayoutDescriptor {
        layout("comics_line_columns", ShaderStages::FRAGMENT, self.stored())
    }

    /// The layout entries of a pass that searches stored cracks, see `stored.wgsl`.
    fn stored(self) -> Vec<BindGroupLayoutEntry> {
        let fragment = ShaderStages::FRAGMENT;
        let mut entries = if self.contains(Self::BLOCKS) {
            let cracks = storage_buffer_read_only_sized(false, None).build(11, fragment);
            vec![cracks, planes_entry(fragment)]
        } else {
            vec![texture_2d(TextureSampleType::Uint).build(11, fragment)]
        };
        if self.contains(Self::SMOOTH) {
            entries.push(storage_buffer_read_only_sized(false, None).build(19, fragment));
        }
        entries
    }

    pub fn tiles_layout() -> BindGroupLayoutDescriptor {
        let blocks = texture_2d(TextureSampleType::Uint).build(12, ShaderStages::COMPUTE);
        let lists = written_buffers([14, 15, 31]);
        let entries = [blocks].into_iter().chain(lists);
        layout("comics_list_tiles", ShaderStages::COMPUTE, entries)
    }

    pub fn draw_layout(self) -> BindGroupLayoutDescriptor {
        let fragment = ShaderStages::FRAGMENT;
        let texture = |at| texture_2d(TextureSampleType::Uint).build(at, fragment);
        let mut entries = self.stored();
        if self.contains(Self::COLUMNS) {
            entries = vec![texture(13)];
            entries.extend(self.contains(Self::BLOCKS).then(|| texture(12)));
            entries.extend(self.contains(Self::BRIDGED).then(|| planes_entry(fragment)));
        }
        entries.extend(self.contains(Self::OBJECT_IDS).then(|| ids_entry(false)));
        layout("comics_draw_lines", fragment, entries)
    }
}

/// The layout of a pass: the uniform, and what it binds besides.
fn layout(
    label: &'static str,
    stages: ShaderStages,
    entries: impl IntoIterator<Item = BindGroupLayoutEntry>,
) -> BindGroupLayoutDescriptor {
    let uniform = uniform_buffer::<LinePassUniform>(false).build(1, stages);
    let entries: Vec<_> = [uniform].into_iter().chain(entries).collect();
    BindGroupLayoutDescriptor::new(label, &entries)
}

/// The layout of a pass over the cells with cracks, and the buffers that it reads and writes.
fn in_cells<const READ: usize, const WRITTEN: usize>(
    label: &'static str,
    mut entries: Vec<BindGroupLayoutEntry>,
    read: [u32; READ],
    written: [u32; WRITTEN],
) -> BindGroupLayoutDescriptor {
    entries.extend(read_buffers([16, 17]));
    entries.extend(read_buffers(read));
    entries.extend(written_buffers(written));
    layout(label, ShaderStages::COMPUTE, entries)
}

/// The layout entry of planes of bits.
fn planes_entry(stages: ShaderStages) -> BindGroupLayoutEntry {
    storage_buffer_read_only_sized(false, None).build(20, stages)
}

/// The layout entries of buffers that compute passes read.
fn read_buffers<const N: usize>(bindings: [u32; N]) -> [BindGroupLayoutEntry; N] {
    bindings.map(|binding| {
        storage_buffer_read_only_sized(false, None).build(binding, ShaderStages::COMPUTE)
    })
}

/// The layout entries of buffers that compute passes write.
fn written_buffers<const N: usize>(bindings: [u32; N]) -> [BindGroupLayoutEntry; N] {
    bindings.map(|binding| storage_buffer_sized(false, None).build(binding, ShaderStages::COMPUTE))
}

/// The layout entry of the visible range, the same in all passes.
pub(crate) fn range_entry() -> BindGroupLayoutEntry {
    uniform_buffer_sized(false, NonZeroU64::new(RANGE_SIZE)).build(3, ShaderStages::FRAGMENT)
}

/// The layout entry of the pixels that own lines, in the fused pass.
pub(crate) fn owners_entry() -> BindGroupLayoutEntry {
    texture_2d(TextureSampleType::Sint).build(5, ShaderStages::FRAGMENT)
}

/// The layout entry of the ink in the fused pass.
pub(crate) fn ink_entry() -> BindGroupLayoutEntry {
    texture_2d(UNFILTERABLE).build(4, ShaderStages::FRAGMENT)
}
