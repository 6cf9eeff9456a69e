//! Reads textures of the last frame from the GPU: pictures, depth, normals, object ids.

use bevy::{
    core_pipeline::prepass::ViewPrepassTextures,
    prelude::*,
    render::{
        renderer::{RenderDevice, RenderQueue},
        view::ViewTarget,
    },
};
use bevy_comics::testing::{ObjectIds, ViewCracks, ViewLineWidths, ViewObjectIds};
use half::f16;

use crate::{
    before::Pictures,
    reference::{color, planes::column_word},
};

/// Pixels of four floats, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatImage {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<[f32; 4]>,
}

/// Bits of raw depth: `samples` values per pixel, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthImage {
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    pub bits: Vec<u32>,
}

impl DepthImage {
    pub fn at(&self, x: u32, y: u32, sample: u32) -> f32 {
        f32::from_bits(self.bits[((y * self.width + x) * self.samples + sample) as usize])
    }
}

fn map_buffer(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Vec<u8> {
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| {
        result.expect("the buffer maps");
    });
    device
        .poll(wgpu::PollType::wait_indefinitely())
        .expect("the device answers");
    let bytes = buffer.slice(..).get_mapped_range().to_vec();
    buffer.unmap();
    bytes
}

/// The bytes of a single-sampled color texture, rows without padding.
pub fn texture_bytes(render_world: &World, texture: &wgpu::Texture) -> Vec<u8> {
    let device = render_world.resource::<RenderDevice>().wgpu_device();
    let queue = render_world.resource::<RenderQueue>();
    let texel = texture
        .format()
        .block_copy_size(None)
        .expect("a color format");
    let row = texture.width() * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(padded) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: None,
            },
        },
        texture.size(),
    );
    queue.submit([encoder.finish()]);
    map_buffer(device, &buffer)
        .chunks_exact(padded as usize)
        .flat_map(|chunk| chunk[..row as usize].to_vec())
        .collect()
}

/// The values that a shader reads from a color texture: sRGB formats are decoded.
pub fn float_image(render_world: &World, texture: &wgpu::Texture) -> FloatImage {
    let bytes = texture_bytes(render_world, texture);
    let unorm = |b: u8| f32::from(b) / 255.0;
    let decoded = |b: u8| color::srgb_decode_one(f64::from(b) / 255.0) as f32;
    let pixels = match texture.format() {
        wgpu::TextureFormat::Rgba16Float => bytes
            .chunks_exact(8)
            .map(|p| [0, 2, 4, 6].map(|i| f16::from_le_bytes([p[i], p[i + 1]]).to_f32()))
            .collect(),
        wgpu::TextureFormat::Rgba8Unorm => bytes
            .chunks_exact(4)
            .map(|p| [0, 1, 2, 3].map(|i| unorm(p[i])))
            .collect(),
        wgpu::TextureFormat::Rgba8UnormSrgb => bytes
            .chunks_exact(4)
            .map(|p| {
                let [r, g, b] = [p[0], p[1], p[2]].map(decoded);
                [r, g, b, unorm(p[3])]
            })
            .collect(),
        other => panic!("no reader for {other:?}"),
    };
    FloatImage {
        width: texture.width(),
        height: texture.height(),
        pixels,
    }
}

/// The pictures of the view before the fused pass, if
/// [`BeforeStylize::Copy`](crate::before::BeforeStylize::Copy) is in the app, and after the
/// last post-process pass.
pub fn pictures(render_world: &World, view: Entity) -> Option<(Option<FloatImage>, FloatImage)> {
    let target = render_world.get::<ViewTarget>(view)?;
    let before = render_world
        .get_resource::<Pictures>()
        .and_then(|pictures| pictures.get(view));
    let before = before.map(|picture| float_image(render_world, &picture));
    Some((before, float_image(render_world, target.main_texture())))
}

/// The picture of the view before the fused pass, as the pass loads it: some adapters decode
/// display codes by a polynomial, up to 0.3 codes from the curve.
pub fn loaded_picture(render_world: &World, view: Entity) -> Option<FloatImage> {
    let texture = render_world.get_resource::<Pictures>()?.get(view)?;
    Some(read_floats(render_world, &texture, 0, "texel"))
}

/// The words of a buffer.
fn words_of(render_world: &World, buffer: &wgpu::Buffer) -> Vec<u32> {
    let device = render_world.resource::<RenderDevice>().wgpu_device();
    let staging = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    render_world
        .resource::<RenderQueue>()
        .submit([encoder.finish()]);
    let bytes = map_buffer(device, &staging);
    let words = bytes.as_chunks::<4>().0.iter();
    words.map(|word| u32::from_le_bytes(*word)).collect()
}

/// The words of the buffers of [`ViewCracks`]. Of cracks that are in none of the planes, the
/// word is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct CrackWords {
    /// x, y, width, height.
    pub rect: [u32; 4],
    pub words: Vec<[u32; 2]>,
    pub planes: Vec<u32>,
    pub bends: Vec<u32>,
}

/// The cracks of the view's last frame; `None` if no lines were found along cracks.
pub fn cracks(render_world: &World, view: Entity) -> Option<CrackWords> {
    let cracks = render_world.get::<ViewCracks>(view)?;
    let words = |buffer: &wgpu::Buffer| words_of(render_world, buffer);
    let planes = words(&cracks.planes);
    let [width, height] = cracks.rect.zw().to_array().map(i64::from);
    let is_set = |plane: i64, x: i64, y: i64| {
        let word = planes[column_word([width, height], plane, x, y / 32) as usize];
        (word >> (y % 32)) & 1 != 0
    };
    let mut all = words(&cracks.words).as_chunks::<2>().0.to_vec();
    for (i, pair) in (0..width * height).zip(&mut all) {
        for (side, word) in (0..2).zip(pair) {
            // Of cracks that are in none of the planes, the word is of an earlier frame.
            let place = |plane: i64| is_set(plane + side, i % width, i / width);
            if ![0, 2, 4].into_iter().any(place) {
                *word = 0;
            }
        }
    }
    Some(CrackWords {
        rect: cracks.rect.to_array(),
        words: all,
        planes,
        bends: cracks.bends.as_ref().map_or(vec![], |b| words(b)),
    })
}

/// (id, style slot) of the object at each pixel, row by row; id 0 for no object.
#[derive(Clone, Debug, PartialEq)]
pub struct IdImage {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<[u32; 2]>,
}

/// The factor of the width of lines at each pixel.
#[derive(Clone, Debug)]
pub struct WidthImage {
    pub width: u32,
    pub height: u32,
    /// 0 to 2.
    pub factors: Vec<f64>,
}

/// For every texel of a texture, row by row, N words of 32 bits. `words`: an expression of WGSL,
/// an array of them made from `texel`, one sample of the texture.
fn read_texels<const N: usize>(
    render_world: &World,
    texture: &wgpu::Texture,
    sample: u32,
    words: &str,
) -> Vec<[u32; N]> {
    let component = match texture.format() {
        wgpu::TextureFormat::Rg16Uint | wgpu::TextureFormat::Rgba16Uint => "u32",
        _ => "f32",
    };
    let kind = if texture.sample_count() > 1 {
        "texture_multisampled_2d"
    } else {
        "texture_2d"
    };
    let shader = format!(
        "@group(0) @binding(0) var source: {kind}<{component}>;
         @group(0) @binding(1) var<storage, read_write> result: array<array<u32, {N}>>;
         @compute @workgroup_size(64) fn read(@builtin(global_invocation_id) id: vec3<u32>) {{
             let size = textureDimensions(source);
             if id.x >= size.x {{ return; }}
             let texel = textureLoad(source, vec2<i32>(id.xy), {sample});
             result[id.y * size.x + id.x] = array<u32, {N}>({words});
         }}"
    );
    let device = render_world.resource::<RenderDevice>().wgpu_device();
    let storage = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(texture.width()) * u64::from(texture.height()) * N as u64 * 4,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(shader.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("read"),
        compilation_options: default(),
        cache: None,
    });
    let view = texture.create_view(&default());
    let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: storage.as_entire_binding(),
            },
        ],
    });
    let mut encoder = device.create_command_encoder(&default());
    {
        let mut pass = encoder.begin_compute_pass(&default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.dispatch_workgroups(texture.width().div_ceil(64), texture.height(), 1);
    }
    let queue = render_world.resource::<RenderQueue>();
    queue.submit([encoder.finish()]);
    let words = words_of(render_world, &storage);
    words.as_chunks::<N>().0.to_vec()
}

/// The same for four floats. `value`: an expression of WGSL, a vector of them.
fn read_floats(
    render_world: &World,
    texture: &wgpu::Texture,
    sample: u32,
    value: &str,
) -> FloatImage {
    let words = ["x", "y", "z", "w"].map(|axis| format!("bitcast<u32>(({value}).{axis})"));
    let texels = read_texels::<4>(render_world, texture, sample, &words.join(", "));
    FloatImage {
        width: texture.width(),
        height: texture.height(),
        pixels: texels.iter().map(|w| w.map(f32::from_bits)).collect(),
    }
}

/// All samples of the view's raw depth, bit by bit; `None` without a depth prepass.
pub fn depth(render_world: &World, view: Entity) -> Option<DepthImage> {
    let prepass = render_world.get::<ViewPrepassTextures>(view)?;
    let texture: &wgpu::Texture = &prepass.depth.as_ref()?.texture.texture;
    let samples = texture.sample_count();
    let mut bits = vec![0; (texture.width() * texture.height() * samples) as usize];
    for sample in 0..samples {
        let texels = read_texels::<1>(render_world, texture, sample, "bitcast<u32>(texel.r)");
        let places = bits[sample as usize..].iter_mut();
        for (place, [bits]) in places.step_by(samples as usize).zip(texels) {
            *place = bits;
        }
    }
    Some(DepthImage {
        width: texture.width(),
        height: texture.height(),
        samples,
        bits,
    })
}

/// World normals of the first sample, components -1 to 1; `None` without a normal
/// prepass.
pub fn normals(render_world: &World, view: Entity) -> Option<FloatImage> {
    normals_of(render_world, view, 0)
}

/// The same of one sample, which must exist.
pub fn normals_of(render_world: &World, view: Entity, sample: u32) -> Option<FloatImage> {
    let prepass = render_world.get::<ViewPrepassTextures>(view)?;
    let texture: &wgpu::Texture = &prepass.normal.as_ref()?.texture.texture;
    let normal = "vec4(texel.xyz * 2.0 - 1.0, texel.w)";
    Some(read_floats(render_world, texture, sample, normal))
}

/// Motion vectors of a view of one sample per pixel, x and y, as fractions of the picture;
/// `None` without a motion vector prepass.
pub fn motion_vectors(render_world: &World, view: Entity) -> Option<FloatImage> {
    let prepass = render_world.get::<ViewPrepassTextures>(view)?;
    let texture: &wgpu::Texture = &prepass.motion_vectors.as_ref()?.texture.texture;
    Some(read_floats(render_world, texture, 0, "texel"))
}

/// The id of an object; 0 if it has none.
pub fn id_of(render_world: &World, object: Entity) -> u32 {
    let ids = render_world.get_resource::<ObjectIds>();
    ids.and_then(|ids| ids.get(object)).map_or(0, u32::from)
}

/// The object at each pixel's first sample; `None` if no ids were drawn.
pub fn object_ids(render_world: &World, view: Entity) -> Option<IdImage> {
    object_ids_of(render_world, view, 0)
}

/// The same of one sample, which must exist.
pub fn object_ids_of(render_world: &World, view: Entity, sample: u32) -> Option<IdImage> {
    let texture: &wgpu::Texture = &render_world.get::<ViewObjectIds>(view)?.texture;
    Some(IdImage {
        width: texture.width(),
        height: texture.height(),
        pixels: read_texels(render_world, texture, sample, "texel.x, texel.y"),
    })
}

/// The factors of the width of lines at one sample of each pixel; `None` if they were not
/// drawn.
pub fn line_widths_of(render_world: &World, view: Entity, sample: u32) -> Option<WidthImage> {
    let texture: &wgpu::Texture = &render_world.get::<ViewLineWidths>(view)?.texture;
    let codes = read_texels::<1>(render_world, texture, sample, "u32(round(texel.x * 255.0))");
    Some(WidthImage {
        width: texture.width(),
        height: texture.height(),
        factors: (codes.iter())
            .map(|[code]| (f64::from(*code) / 127.0).min(2.0))
            .collect(),
    })
}
