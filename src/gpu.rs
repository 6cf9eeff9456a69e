//! Short forms of what the renderer takes as structs, and buffers that follow what changes.

#[cfg(feature = "objects")]
use std::{num::NonZero, ops::Range};

#[cfg(feature = "objects")]
use bevy::render::{
    render_resource::{BufferBinding, RawBufferVec, RenderPassDepthStencilAttachment},
    renderer::RenderQueue,
};
use bevy::{
    camera::CompositingSpace,
    image::ToExtents,
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, BindGroupEntry, BindGroupLayoutEntryBuilder, BindingResource, Buffer,
            BufferDescriptor, BufferUsages, CommandEncoder, ComputePassDescriptor, ComputePipeline,
            LoadOp, Operations, RenderPassColorAttachment, StoreOp, TextureDescriptor,
            TextureDimension, TextureFormat, TextureSampleType, TextureUsages, TextureView,
            binding_types::{texture_2d, texture_2d_multisampled},
        },
        renderer::RenderDevice,
    },
    shader::ShaderDefVal,
};

pub(crate) fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

/// The type of textures that are read without a filter.
pub(crate) const UNFILTERABLE: TextureSampleType = TextureSampleType::Float { filterable: false };

/// A layout entry of a texture.
pub(crate) fn sampled(
    multisampled: bool,
    sample_type: TextureSampleType,
) -> BindGroupLayoutEntryBuilder {
    if multisampled {
        texture_2d_multisampled(sample_type)
    } else {
        texture_2d(sample_type)
    }
}

pub(crate) fn buffer(device: &RenderDevice, label: &str, size: u64, usage: BufferUsages) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some(label),
        size,
        usage,
        mapped_at_creation: false,
    })
}

/// A texture without mipmaps, of at least one pixel.
pub(crate) fn texture(
    label: &'static str,
    (size, samples): (UVec2, u32),
    format: TextureFormat,
    usage: TextureUsages,
) -> TextureDescriptor<'static> {
    TextureDescriptor {
        label: Some(label),
        size: size.max(UVec2::ONE).to_extents(),
        mip_level_count: 1,
        sample_count: samples,
        dimension: TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}

/// A texture that a pass draws to; by default it is cleared to 0 before.
pub(crate) fn attachment(
    view: &TextureView,
    load: LoadOp<wgpu::Color>,
) -> RenderPassColorAttachment<'_> {
    RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: Operations {
            load,
            store: StoreOp::Store,
        },
    }
}

/// A depth texture that a pass draws to.
#[cfg(feature = "objects")]
pub(crate) fn depth_attachment(
    view: &TextureView,
    load: LoadOp<f32>,
    store: StoreOp,
) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(Operations { load, store }),
        stencil_ops: None,
    }
}

/// Begins a compute pass; the caller dispatches it. `offsets`: those of the uniforms.
pub(crate) fn compute_pass<'a>(
    encoder: &'a mut CommandEncoder,
    label: &str,
    (pipeline, group): (&ComputePipeline, &BindGroup),
    offsets: &[u32],
) -> wgpu::ComputePass<'a> {
    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
        label: Some(label),
        timestamp_writes: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, offsets);
    pass
}

/// The definitions of the flags that are set.
pub(crate) fn definitions<const N: usize>(
    flags: [(bool, &'static str); N],
) -> impl Iterator<Item = ShaderDefVal> {
    let set = flags.into_iter().filter(|(on, _)| *on);
    set.map(|(_, name)| name.into())
}

/// The definition of how a picture is stored.
pub(crate) fn stored(space: CompositingSpace) -> Option<ShaderDefVal> {
    let name = match space {
        CompositingSpace::Linear => return None,
        CompositingSpace::Srgb => "STORED_SRGB",
        CompositingSpace::Oklab => "STORED_OKLAB",
    };
    Some(name.into())
}

/// Whether something with this room is used again where less is needed: not if it is over four
/// times too large, as after a window has become smaller.
pub(crate) fn is_reused(room: u64, needed: u64) -> bool {
    (needed..=needed.saturating_mul(4)).contains(&room)
}

/// A storage buffer whose entries have `N` words. Only entries that changed are uploaded.
#[cfg(feature = "objects")]
pub(crate) struct Table<const N: usize> {
    entries: RawBufferVec<[u32; N]>,
    /// What has yet to be uploaded.
    changed: Vec<Range<usize>>,
    /// Bytes that were uploaded so far.
    pub written: usize,
}

/// Entries that are uploaded although they have not changed, so that there are fewer uploads.
#[cfg(feature = "objects")]
const GAP: usize = 64;

#[cfg(feature = "objects")]
impl<const N: usize> Default for Table<N> {
    fn default() -> Self {
        Self {
            entries: RawBufferVec::new(BufferUsages::STORAGE),
            changed: Vec::new(),
            written: 0,
        }
    }
}

#[cfg(feature = "objects")]
impl<const N: usize> Table<N> {
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    pub fn buffer(&self) -> Option<&Buffer> {
        self.entries.buffer()
    }

    /// The entries alone: the buffer may be longer, and shaders read its length. `None` without any.
    pub fn binding(&self) -> Option<BindingResource<'_>> {
        let size = self.len() * size_of::<[u32; N]>();
        Some(BindingResource::Buffer(BufferBinding {
            buffer: self.buffer()?,
            offset: 0,
            size: Some(NonZero::new(size as u64)?),
        }))
    }

    pub fn truncate(&mut self, len: usize) {
        self.entries.truncate(len);
    }

    /// Sets an entry, or adds it at the end.
    pub fn set(&mut self, at: usize, entry: [u32; N]) {
        let entries = self.entries.values_mut();
        match entries.get_mut(at) {
            Some(known) if *known == entry => return,
            Some(known) => *known = entry,
            None => entries.push(entry),
        }
        match self.changed.last_mut() {
            Some(last) if (last.start..=last.end + GAP).contains(&at) => {
                last.end = last.end.max(at + 1);
            }
            _ => self.changed.push(at..at + 1),
        }
    }

    /// Uploads what has changed.
    pub fn write(&mut self, device: &RenderDevice, queue: &RenderQueue) {
        let len = self.len();
        let [room, needed] = [self.entries.capacity(), len.max(GAP)].map(|count| count as u64);
        let changed = std::mem::take(&mut self.changed);
        let mut uploaded = 0;
        if self.buffer().is_none() || !is_reused(room, needed) {
            let mut larger = RawBufferVec::new(BufferUsages::STORAGE);
            std::mem::swap(larger.values_mut(), self.entries.values_mut());
            larger.reserve((len + len / 4).max(GAP), device);
            larger.write_buffer(device, queue);
            self.entries = larger;
            uploaded = len;
        } else {
            for range in merged(changed) {
                let range = range.start..range.end.min(len);
                // It fits, and the buffer is there.
                if !range.is_empty()
                    && self
                        .entries
                        .write_buffer_range(queue, range.clone())
                        .is_ok()
                {
                    uploaded += range.len();
                }
            }
        }
        self.written += uploaded * size_of::<[u32; N]>();
    }
}

/// The ranges in order, those together that are close.
#[cfg(feature = "objects")]
fn merged(mut ranges: Vec<Range<usize>>) -> Vec<Range<usize>> {
    ranges.sort_unstable_by_key(|range| range.start);
    let mut all: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match all.last_mut() {
            Some(last) if range.start <= last.end + GAP => last.end = last.end.max(range.end),
            _ => all.push(range),
        }
    }
    all
}

#[cfg(all(test, feature = "objects"))]
mod tests {
    use super::*;

    #[test]
    fn entries_that_changed_are_uploaded_in_few_ranges() {
        let mut table = Table::<1>::default();
        for at in 0..1000 {
            table.set(at, [0]);
        }
        assert_eq!(table.changed.pop(), Some(0..1000));
        assert_eq!(table.changed.len(), 0);
        for at in [900, 3, 500, 4, 530, 0] {
            table.set(at, [1]);
            table.set(at, [1]);
        }
        assert_eq!(merged(table.changed), [0..5, 500..531, 900..901]);
    }

    #[test]
    fn room_is_used_again_up_to_four_times_what_is_needed() {
        let reused = [99, 100, 400, 401].map(|room| is_reused(room, 100));
        assert_eq!(reused, [false, true, true, false]);
    }
}
