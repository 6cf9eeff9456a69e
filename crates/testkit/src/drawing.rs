//! Passes that draw over a whole texture, with one sample per pixel or several.

use crate::{device::Gpu, wgsl};

/// What a pass draws into.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    pub format: wgpu::TextureFormat,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
}

/// A triangle that covers all of a target.
const WHOLE: &str = "
    @vertex fn whole(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
        return vec4(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
    }
";

/// Writes one layer to each sample.
const FILL: &str = "
    @group(0) @binding(0) var layers: texture_2d_array<f32>;
    @fragment fn fill(
        @builtin(position) at: vec4<f32>,
        @builtin(sample_index) sample: u32,
    ) -> @location(0) vec4<f32> {
        return textureLoad(layers, vec2<i32>(at.xy), i32(sample), 0);
    }
";

/// A pass that draws over all of a target whose content is cleared.
fn draw(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::RenderPipeline,
    group: &wgpu::BindGroup,
    target: &wgpu::TextureView,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}

impl Gpu {
    /// A new texture, drawn by the fragment shader `source` with this entry point.
    pub fn drawn(
        &self,
        target: Target,
        (source, entry_point): (&str, &str),
        definitions: &[wgsl::Definition],
        entries: &[wgpu::BindGroupEntry],
    ) -> wgpu::TextureView {
        let view = self.target(target);
        let module = wgsl::module_with(&format!("{source}{WHOLE}"), definitions);
        let module = self.shader(module.unwrap_or_else(|error| panic!("{error}")));
        let pipeline = self.pipeline_over(target, &module, entry_point);
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        draw(&mut encoder, &pipeline, &group, &view);
        self.queue.submit([encoder.finish()]);
        view
    }

    /// A texture with several samples per pixel. `layers`: the texels of each sample, row by row.
    pub fn multisampled(
        &self,
        format: wgpu::TextureFormat,
        size: [u32; 2],
        layers: &[Vec<[f32; 4]>],
    ) -> wgpu::TextureView {
        let bytes: Vec<u8> = (layers.iter().flatten().flatten())
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let samples = layers.len() as u32;
        let [width, height] = size;
        let layered = wgpu::TextureFormat::Rgba32Float;
        let layered = self.texture_of(layered, [width, height, samples], &bytes);
        let entry = wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::TextureView(&layered),
        };
        let target = Target {
            format,
            size,
            samples,
        };
        self.drawn(target, (FILL, "fill"), &[], &[entry])
    }

    fn target(&self, target: Target) -> wgpu::TextureView {
        let [width, height] = target.size;
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: target.samples,
            dimension: wgpu::TextureDimension::D2,
            format: target.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        texture.create_view(&Default::default())
    }

    fn pipeline_over(
        &self,
        target: Target,
        module: &wgpu::ShaderModule,
        entry_point: &str,
    ) -> wgpu::RenderPipeline {
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: None,
                vertex: wgpu::VertexState {
                    module,
                    entry_point: Some("whole"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState {
                    count: target.samples,
                    ..Default::default()
                },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(target.format.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
    }
}
