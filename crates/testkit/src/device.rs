//! A bare GPU device that evaluates shipped WGSL functions on many inputs.

use std::sync::OnceLock;

use crate::{headless::INSTALL_ADAPTER, validation, wgsl};

pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
}

/// Shadow maps of directional lights, and the sampler that compares their depths.
pub struct ShadowMaps {
    maps: wgpu::TextureView,
    sampler: wgpu::Sampler,
}

/// The device, shared by all tests of a process. Without an adapter it panics with
/// the command that installs one.
pub fn gpu() -> &'static Gpu {
    static GPU: OnceLock<Gpu> = OnceLock::new();
    GPU.get_or_init(|| {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY),
            flags: validation::instance_flags(),
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = bevy::tasks::block_on(
            instance.request_adapter(&wgpu::RequestAdapterOptions::default()),
        )
        .unwrap_or_else(|_| panic!("no graphics adapter: {INSTALL_ADAPTER}"));
        let (device, queue) =
            bevy::tasks::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
                required_features: adapter.features()
                    & (wgpu::Features::SUBGROUP | wgpu::Features::SHADER_F16),
                required_limits: adapter.limits(),
                ..Default::default()
            }))
            .expect("a device of the adapter");
        Gpu { device, queue }
    })
}

impl Gpu {
    /// A compute pipeline whose layout is that of the shader.
    pub fn compute_pipeline(
        &self,
        module: wgpu::naga::Module,
        entry_point: &str,
    ) -> wgpu::ComputePipeline {
        self.device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: None,
                layout: None,
                module: &self.shader(module),
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                cache: None,
            })
    }

    /// A shader without checks at run time, as the engine makes them: with checks, a driver may
    /// compile loops that it would otherwise get wrong.
    #[expect(unsafe_code, reason = "shaders without checks are trusted")]
    pub fn shader(&self, module: wgpu::naga::Module) -> wgpu::ShaderModule {
        let module = wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(module)),
        };
        let checks = wgpu::ShaderRuntimeChecks::unchecked();
        // SAFETY: the shaders are those of this crate and of its tests.
        unsafe { self.device.create_shader_module_trusted(module, checks) }
    }

    pub fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// The bytes of a buffer, after all that was submitted. Panics if Vulkan's validation layer has
    /// said anything.
    pub fn read(&self, buffer: &wgpu::Buffer) -> Vec<u8> {
        let staging = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: buffer.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        staging
            .slice(..)
            .map_async(wgpu::MapMode::Read, |result| result.expect("mapped"));
        self.device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the device answers");
        let bytes = staging.slice(..).get_mapped_range().to_vec();
        staging.unmap();
        validation::check();
        bytes
    }

    /// Runs `body`, which sees `i(0)`, `i(1)` ... as its inputs and returns a
    /// `vec4<f32>`, once for every row of `rows`.
    pub fn evaluate<const N: usize>(
        &self,
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let module = wgsl::module(&entry_point::<N>(imports, body), &["DEPTH"]);
        self.run(module.unwrap_or_else(|error| panic!("{error}")), rows, &[])
    }

    /// As [`evaluate`](Self::evaluate), for functions of a texture: `imports` declares it as
    /// binding 2.
    pub fn evaluate_texture<const N: usize>(
        &self,
        texture: &wgpu::TextureView,
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let module = wgsl::module(&entry_point::<N>(imports, body), &[]);
        let entry = wgpu::BindGroupEntry {
            binding: 2,
            resource: wgpu::BindingResource::TextureView(texture),
        };
        let module = module.unwrap_or_else(|error| panic!("{error}"));
        self.run(module, rows, &[entry])
    }

    /// A texture of 32-bit floating-point numbers.
    pub fn texture(&self, [width, height]: [u32; 2], texels: &[[f32; 4]]) -> wgpu::TextureView {
        let bytes: Vec<u8> = (texels.iter().flatten())
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let size = [width, height, 1];
        self.texture_of(wgpu::TextureFormat::Rgba32Float, size, &bytes)
    }

    /// A texture with a width, a height and a number of layers, from the bytes of its rows.
    pub fn texture_of(
        &self,
        format: wgpu::TextureFormat,
        [width, height, layers]: [u32; 3],
        bytes: &[u8],
    ) -> wgpu::TextureView {
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: layers,
        };
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes.len() as u32 / (height * layers)),
            rows_per_image: Some(height),
        };
        self.queue
            .write_texture(texture.as_image_copy(), bytes, layout, size);
        texture.create_view(&Default::default())
    }

    /// Square shadow maps of directional lights: layers of depths in steps of 1 / 65535.
    pub fn shadow_maps(&self, size: u32, layers: &[Vec<u16>]) -> ShadowMaps {
        let depths = layers.iter().flatten();
        let bytes: Vec<u8> = depths.flat_map(|depth| depth.to_le_bytes()).collect();
        let size = [size, size, layers.len() as u32];
        ShadowMaps {
            maps: self.texture_of(wgpu::TextureFormat::Depth16Unorm, size, &bytes),
            // As the engine's.
            sampler: self.device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
        }
    }

    /// As [`evaluate_alone`](Self::evaluate_alone), for functions that read the shadow maps of
    /// directional lights with the slope of the shadow.
    pub fn evaluate_shadows<const N: usize>(
        &self,
        shadows: &ShadowMaps,
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let resources = [
            wgpu::BindingResource::TextureView(&shadows.maps),
            wgpu::BindingResource::Sampler(&shadows.sampler),
        ];
        let entries = (2..).zip(resources);
        let entries = entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        let entries: Vec<_> = entries.collect();
        self.evaluate_bound(&[("SLOPED_SHADOWS", None)], &entries, imports, body, rows)
    }

    /// As [`evaluate`](Self::evaluate), for functions that read bindings: they are variables that
    /// `body` sets, see [`wgsl::module_alone`].
    pub fn evaluate_alone<const N: usize>(
        &self,
        definitions: &[wgsl::Definition],
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        self.evaluate_bound(definitions, &[], imports, body, rows)
    }

    /// As [`evaluate_alone`](Self::evaluate_alone), for functions that also read textures and
    /// buffers: `entries` are those that they use, from binding 2 on.
    pub fn evaluate_bound<const N: usize>(
        &self,
        definitions: &[wgsl::Definition],
        entries: &[wgpu::BindGroupEntry],
        imports: &str,
        body: &str,
        rows: &[[f32; N]],
    ) -> Vec<[f32; 4]> {
        let module = wgsl::module_alone(&entry_point::<N>(imports, body), definitions);
        let module = module.unwrap_or_else(|error| panic!("{error}"));
        self.run(module, rows, entries)
    }

    fn run<const N: usize>(
        &self,
        module: wgpu::naga::Module,
        rows: &[[f32; N]],
        more: &[wgpu::BindGroupEntry],
    ) -> Vec<[f32; 4]> {
        let pipeline = self.compute_pipeline(module, "evaluate");
        let bytes: Vec<u8> = rows
            .iter()
            .flatten()
            .flat_map(|x| x.to_bits().to_le_bytes())
            .collect();
        let input = self.buffer(&bytes, wgpu::BufferUsages::STORAGE);
        let output = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: rows.len() as u64 * 16,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let entries = [(0, &input), (1, &output)].map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
        let bind_group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[&entries, more].concat(),
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bind_group, &[]);
            let count = rows.len() as u32;
            pass.dispatch_workgroups(count.min(65536).div_ceil(64), count.div_ceil(65536), 1);
        }
        self.queue.submit([encoder.finish()]);
        self.read(&output)
            .chunks_exact(16)
            .map(|c| {
                [0, 4, 8, 12].map(|k| f32::from_le_bytes([c[k], c[k + 1], c[k + 2], c[k + 3]]))
            })
            .collect()
    }
}

/// Runs `body` for every row of N numbers.
fn entry_point<const N: usize>(imports: &str, body: &str) -> String {
    format!(
        "{imports}
        @group(0) @binding(0) var<storage, read> rows: array<u32>;
        @group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;
        var<private> row: u32;
        fn i(n: u32) -> f32 {{ return bitcast<f32>(rows[row * {N}u + n]); }}
        fn u(n: u32) -> u32 {{ return u32(i(n)); }}
        fn body() -> vec4<f32> {{ {body} }}
        @compute @workgroup_size(64)
        fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {{
            row = id.y * 65536u + id.x;
            if row < arrayLength(&results) {{ results[row] = body(); }}
        }}"
    )
}
