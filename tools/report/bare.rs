//! Passes on a device without the engine: for variants that exist only in this report.

use std::time::Instant;

use bevy_comics_testkit::{device::gpu, drawing::draw};

pub fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

pub fn texture(
    size: [u32; 2],
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::Texture {
    gpu().device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Copies raw depth to a texture.
pub fn upload(size: [u32; 2], depth: &[f32]) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
    let texture = texture(size, wgpu::TextureFormat::R32Float, usage);
    let bytes: Vec<u8> = depth.iter().flat_map(|d| d.to_le_bytes()).collect();
    gpu().queue.write_texture(
        texture.as_image_copy(),
        &bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(size[0] * 4),
            rows_per_image: None,
        },
        texture.size(),
    );
    texture
}

pub fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A full-screen pass from WGSL that imports the crate's modules.
pub fn fullscreen(source: &str, format: wgpu::TextureFormat) -> wgpu::RenderPipeline {
    let source = format!(
        "{source}
        @vertex fn whole(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
            return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }}"
    );
    let module =
        bevy_comics_testkit::wgsl::module(&source, &[]).unwrap_or_else(|error| panic!("{error}"));
    let module = gpu().shader(module);
    gpu()
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("whole"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("draw"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
}

pub fn group(layout: &wgpu::BindGroupLayout, entries: &[wgpu::BindingResource]) -> wgpu::BindGroup {
    let entries: Vec<_> = entries
        .iter()
        .enumerate()
        .map(|(i, resource)| wgpu::BindGroupEntry {
            binding: i as u32,
            resource: resource.clone(),
        })
        .collect();
    gpu().device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}

/// The first four bytes of every texel, row by row.
pub fn read(texture: &wgpu::Texture) -> Vec<u32> {
    let (width, height) = (texture.width(), texture.height());
    let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu().device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * height),
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu().device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    gpu().queue.submit([encoder.finish()]);
    gpu()
        .read(&buffer)
        .chunks_exact(row as usize)
        .flat_map(|row| {
            row[..width as usize * 4]
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Mean milliseconds of one of `times` repetitions in the same submit, without the time of
/// an empty submit.
pub fn time(times: u32, mut record: impl FnMut(&mut wgpu::CommandEncoder)) -> f64 {
    let mut submit = |times| {
        let mut encoder = gpu().device.create_command_encoder(&Default::default());
        for _ in 0..times {
            record(&mut encoder);
        }
        let buffer = encoder.finish();
        let start = Instant::now();
        gpu().queue.submit([buffer]);
        gpu()
            .device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers");
        start.elapsed().as_secs_f64() * 1e3
    };
    let full = submit(times);
    let empty = submit(0);
    (full - empty).max(0.0) / f64::from(times)
}

/// The copying pass that is the unit of all ratios: eight bits per channel, nearest sample.
pub struct Blit {
    pipeline: wgpu::RenderPipeline,
    group: wgpu::BindGroup,
    target: wgpu::TextureView,
}

impl Blit {
    pub fn new(size: [u32; 2]) -> Self {
        let format = wgpu::TextureFormat::Rgba8UnormSrgb;
        let pipeline = fullscreen(
            "@group(0) @binding(0) var source: texture_2d<f32>;
             @group(0) @binding(1) var nearest: sampler;
             @fragment fn draw(@builtin(position) p: vec4<f32>) -> @location(0) vec4<f32> {
                 return textureSample(source, nearest, p.xy / vec2<f32>(textureDimensions(source)));
             }",
            format,
        );
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT;
        let source = texture(size, format, usage);
        let sampler = gpu().device.create_sampler(&Default::default());
        let group = group(
            &pipeline.get_bind_group_layout(0),
            &[
                wgpu::BindingResource::TextureView(&view(&source)),
                wgpu::BindingResource::Sampler(&sampler),
            ],
        );
        Self {
            pipeline,
            group,
            target: view(&texture(size, format, usage)),
        }
    }

    pub fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        draw(encoder, &self.pipeline, &self.group, &self.target);
    }
}
