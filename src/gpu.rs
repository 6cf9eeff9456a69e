//! Short forms of what the renderer takes as structs.

use bevy::{
    image::ToExtents,
    math::UVec2,
    render::{
        render_resource::{
            BindGroup, BindGroupEntry, BindingResource, Buffer, BufferDescriptor, BufferUsages,
            CommandEncoder, ComputePassDescriptor, ComputePipeline, LoadOp, Operations,
            RenderPassColorAttachment, StoreOp, TextureDescriptor, TextureDimension, TextureFormat,
            TextureUsages, TextureView,
        },
        renderer::RenderDevice,
    },
    shader::ShaderDefVal,
};

/// An entry of a bind group.
pub(crate) fn entry(binding: u32, resource: BindingResource<'_>) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource }
}

/// A new buffer of `size` bytes.
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

/// Whether something with this room is used again where less is needed: not if it is over four
/// times too large, as after a window has become smaller.
pub(crate) fn is_reused(room: u64, needed: u64) -> bool {
    (needed..=needed.saturating_mul(4)).contains(&room)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_used_again_up_to_four_times_what_is_needed() {
        let reused = [99, 100, 400, 401].map(|room| is_reused(room, 100));
        assert_eq!(reused, [false, true, true, false]);
    }
}
