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

use super::{
    line_key::LineKey,
    pass::{LinePass, SearchPass},
};
use crate::{
    depth::view::RANGE_SIZE,
    gpu::{UNFILTERABLE, sampled},
    lines::{request::LinePassUniform, textures::BLOCK_FORMAT},
    objects::{ids_entry, object_depths_entry, object_styles_entry, widths_entry},
};

impl SearchPass {
    /// What the pass binds.
    pub fn layout(self) -> BindGroupLayoutDescriptor {
        let (label, compute) = (self.label(), ShaderStages::COMPUTE);
        let mut inputs = self.key().inputs(compute, false);
        match self {
            Self::Walk(key) => {
                let blocks = texture_storage_2d(BLOCK_FORMAT, StorageTextureAccess::WriteOnly);
                inputs.push(blocks.build(10, compute));
                if key.contains(LineKey::CRACKS) {
                    inputs.extend(written_buffers([16, 17]));
                }
                layout(label, compute, inputs)
            }
            Self::Tiles => {
                let blocks = texture_2d(TextureSampleType::Uint).build(12, compute);
                let lists = written_buffers([14, 15, 31]);
                layout(label, compute, [blocks].into_iter().chain(lists))
            }
            Self::Measure { .. } => {
                let planes = read_buffers([20]).into_iter();
                layout(label, compute, planes.chain(written_buffers([33])))
            }
            Self::Cells(_) => in_cells(label, inputs, [], [18, 21]),
            Self::Link { .. } | Self::Join => in_cells(label, inputs, [20], [21]),
            Self::Hold(_) => in_cells(label, inputs, [28], [21, 29]),
            Self::CloseGaps => in_cells(label, inputs, [20], [18, 21]),
            Self::Corners => in_cells(label, inputs, [], [21]),
            Self::Settle(key) => {
                if key.contains(LineKey::SMOOTH) {
                    inputs.extend(written_buffers([22]));
                }
                if key.contains(LineKey::BUDGET) {
                    inputs.extend(read_buffers([33]));
                }
                in_cells(label, inputs, [20], [18])
            }
            Self::Ends(_) => in_cells(label, inputs, [11, 19, 20], [30]),
        }
    }
}

impl LinePass {
    /// What the pass binds with its part of a key.
    pub fn layout(self, key: LineKey) -> BindGroupLayoutDescriptor {
        let fragment = ShaderStages::FRAGMENT;
        let uint = |at| texture_2d(TextureSampleType::Uint).build(at, fragment);
        let ids = key.contains(LineKey::OBJECT_IDS).then(|| ids_entry(false));
        let entries = match self {
            Self::Resolve { .. } => key.inputs(fragment, true),
            Self::Find | Self::Faithful => key.inputs(fragment, false),
            Self::Columns => key.stored(),
            Self::Draw if key.contains(LineKey::COLUMNS) => {
                let blocks = key.contains(LineKey::BLOCKS).then(|| uint(12));
                let planes = key
                    .contains(LineKey::CLOSED_GAPS)
                    .then(|| planes_entry(fragment));
                let entries = [uint(13)].into_iter().chain(blocks);
                entries.chain(planes).chain(ids).collect()
            }
            Self::Draw => key.stored().into_iter().chain(ids).collect(),
            Self::Strokes => ids.into_iter().collect(),
            Self::Accumulate { .. } => {
                let float = |at| texture_2d(UNFILTERABLE).build(at, fragment);
                let history = [23, 24, 25, 26].map(float);
                let inputs = key.inputs(fragment, false).into_iter();
                inputs.chain(history).collect()
            }
        };
        let stages = match self {
            Self::Strokes => ShaderStages::VERTEX_FRAGMENT,
            _ => fragment,
        };
        layout(self.label(), stages, entries)
    }
}

impl LineKey {
    /// The layout entries of what the pass of a part of a key reads of the scene.
    fn inputs(self, stages: ShaderStages, multisampled: bool) -> Vec<BindGroupLayoutEntry> {
        if !self.contains(Self::DEPTH) {
            return vec![];
        }
        let float = |multisampled| sampled(multisampled, UNFILTERABLE);
        // The depth that hides highlighted objects.
        let picture = float(self.contains(Self::MULTISAMPLED_PICTURE));
        [
            (Self::DEPTH, float(multisampled).build(2, stages)),
            (Self::RANGE, range_entry()),
            (Self::OBJECT_STYLES, object_styles_entry()),
            (Self::NORMALS, float(multisampled).build(7, stages)),
            (Self::OBJECT_IDS, ids_entry(multisampled)),
            (Self::OBJECT_DEPTHS, object_depths_entry()),
            (Self::HIGHLIGHTS, picture.build(27, stages)),
            (Self::WIDTH_MAP, widths_entry(multisampled, stages)),
            (Self::MOTION, float(false).build(24, stages)),
        ]
        .into_iter()
        .filter(|(any, _)| self.intersects(*any))
        .map(|(_, mut entry)| {
            entry.visibility = stages;
            entry
        })
        .collect()
    }

    /// The layout entries of a pass that searches stored cracks, see `stored.wgsl`.
    fn stored(self) -> Vec<BindGroupLayoutEntry> {
        let fragment = ShaderStages::FRAGMENT;
        let words = |at| storage_buffer_read_only_sized(false, None).build(at, fragment);
        let mut entries = if self.contains(Self::BLOCKS) {
            vec![words(11), planes_entry(fragment)]
        } else {
            vec![texture_2d(TextureSampleType::Uint).build(11, fragment)]
        };
        entries.extend(self.contains(Self::SMOOTH).then(|| words(19)));
        entries
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
