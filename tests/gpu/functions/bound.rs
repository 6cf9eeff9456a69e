//! Textures and buffers that functions read, and their entries of a bind group.

use bevy_comics_testkit::device::gpu;

/// A texture of one number per pixel, row by row.
pub fn floats([width, height]: [u32; 2], texels: &[f32]) -> wgpu::TextureView {
    let bytes: Vec<u8> = texels.iter().flat_map(|x| x.to_le_bytes()).collect();
    gpu().texture_of(wgpu::TextureFormat::R32Float, [width, height, 1], &bytes)
}

/// A texture of two whole numbers per pixel, row by row.
pub fn pairs([width, height]: [u32; 2], texels: &[[u32; 2]]) -> wgpu::TextureView {
    let bytes: Vec<u8> = (texels.as_flattened().iter())
        .flat_map(|x| x.to_le_bytes())
        .collect();
    gpu().texture_of(wgpu::TextureFormat::Rg32Uint, [width, height, 1], &bytes)
}

/// A buffer that shaders read.
pub fn words(words: &[u32]) -> wgpu::Buffer {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    gpu().buffer(&bytes, wgpu::BufferUsages::STORAGE)
}

pub fn texture(binding: u32, view: &wgpu::TextureView) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: wgpu::BindingResource::TextureView(view),
    }
}

pub fn buffer(binding: u32, buffer: &wgpu::Buffer) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry {
        binding,
        resource: buffer.as_entire_binding(),
    }
}
