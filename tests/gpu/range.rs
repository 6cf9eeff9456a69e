//! The depth range against a scan of all depths, bit for bit.

use bevy_comics_testkit::{
    device::gpu,
    reference::{histogram::Bins, range},
    wgsl,
};
use proptest::{
    collection::vec,
    prelude::{ProptestConfig, Strategy, any, prop_oneof},
    sample::select,
    test_runner::TestRunner,
};

use crate::prelude::*;

pub const SHAPES: [&[&str]; 3] = [&["BARRIER_FREE"], &["SUBGROUP"], &[]];

/// A shape of `range.wgsl` with its bindings.
#[derive(Clone)]
struct Reduction {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

/// Each shape is compiled once.
fn reduction(shape: &[&str]) -> Reduction {
    static COMPILED: Mutex<BTreeMap<String, Reduction>> = Mutex::new(BTreeMap::new());
    let mut compiled = COMPILED.lock().expect("no panic");
    let made = || compile(shape);
    compiled.entry(shape.join(" ")).or_insert_with(made).clone()
}

/// A filter cannot read 32-bit floats, so the layout is not that of the shader.
fn compile(shape: &[&str]) -> Reduction {
    let gpu = gpu();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/depth/range.wgsl");
    let source = std::fs::read_to_string(path).expect("the shader");
    let module = wgsl::module(&source, shape).unwrap_or_else(|error| panic!("{error}"));
    let buffer = |ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let storage = buffer(wgpu::BufferBindingType::Storage { read_only: false });
    let types = [
        wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        buffer(wgpu::BufferBindingType::Uniform),
        storage,
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
        storage,
    ];
    let entry = |(binding, ty)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    let layout = wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries[..bindings(shape)],
    };
    let layout = gpu.device.create_bind_group_layout(&layout);
    let pipeline_layout = wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    };
    let pipeline_layout = gpu.device.create_pipeline_layout(&pipeline_layout);
    let pipeline = wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &gpu.shader(module),
        entry_point: Some("reduce"),
        compilation_options: wgpu::PipelineCompilationOptions {
            zero_initialize_workgroup_memory: false,
            ..Default::default()
        },
        cache: None,
    };
    let pipeline = gpu.device.create_compute_pipeline(&pipeline);
    Reduction { layout, pipeline }
}

/// Number of bindings of a shape: the last one is the histogram.
fn bindings(shape: &[&str]) -> usize {
    if shape.contains(&"HISTOGRAM") { 5 } else { 4 }
}

/// Runs a shape of `range.wgsl` over a table of depths.
fn reduce(shape: &[&str], depths: &[f32], size: [u32; 2], rect: [u32; 4]) -> Option<[u32; 2]> {
    reduce_and_count(shape, depths, (size, rect), [0.0; 2]).0
}

/// The same; with `HISTOGRAM`, bins and total as well. `window`: raw depths (near, far)
/// that the bins of an orthographic view divide.
pub fn reduce_and_count(
    shape: &[&str],
    depths: &[f32],
    (size, rect): ([u32; 2], [u32; 4]),
    window: [f32; 2],
) -> (Option<[u32; 2]>, Vec<u32>) {
    let bytes: Vec<u8> = depths.iter().flat_map(|d| d.to_le_bytes()).collect();
    let texture = gpu().texture_of(TextureFormat::R32Float, [size[0], size[1], 1], &bytes);
    reduce_texture(shape, &texture, rect, window)
}

/// The same of a texture of depths, or with `TONES` of a picture.
pub fn reduce_texture(
    shape: &[&str],
    texture: &wgpu::TextureView,
    rect: [u32; 4],
    window: [f32; 2],
) -> (Option<[u32; 2]>, Vec<u32>) {
    let gpu = gpu();
    let Reduction { layout, pipeline } = reduction(shape);
    let mut view = [0u8; 80];
    view[..16].copy_from_slice(&rect.map(u32::to_le_bytes).concat());
    let uniform = gpu.buffer(&view, wgpu::BufferUsages::UNIFORM);
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let keys = gpu.buffer(&[0; 16], usage);
    let mut counts_before = [0u8; 1040];
    counts_before[1028..1036].copy_from_slice(&window.map(f32::to_le_bytes).concat());
    let histogram = gpu.buffer(&counts_before, usage);
    let sampler = gpu.device.create_sampler(&Default::default());
    let resources = [
        wgpu::BindingResource::TextureView(texture),
        uniform.as_entire_binding(),
        keys.as_entire_binding(),
        wgpu::BindingResource::Sampler(&sampler),
        histogram.as_entire_binding(),
    ];
    let entry = |(binding, resource)| wgpu::BindGroupEntry { binding, resource };
    let entries: Vec<_> = (0..).zip(resources).map(entry).collect();
    let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries[..bindings(shape)],
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        if shape.contains(&"BARRIER_FREE") {
            pass.dispatch_workgroups(rect[3].div_ceil(16), rect[2].div_ceil(256), 1);
        } else {
            pass.dispatch_workgroups(rect[2].div_ceil(128), rect[3].div_ceil(32), 1);
        }
    }
    gpu.queue.submit([encoder.finish()]);
    let words = |buffer| -> Vec<u32> {
        let bytes = gpu.read(buffer);
        let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        bytes.chunks_exact(4).map(word).collect()
    };
    let found = words(&keys);
    let range = (found[0] != 0).then(|| [found[0], found[1].wrapping_neg()]);
    (range, words(&histogram))
}

/// The depths inside a rectangle: left, top, width, height.
fn inside(depths: &[f32], width: u32, [x, y, w, h]: [u32; 4]) -> impl Iterator<Item = f32> {
    let rows = (y..y + h).map(move |y| (y * width) as usize);
    rows.flat_map(move |row| &depths[row + x as usize..][..w as usize])
        .copied()
}

/// Every kind of float that a texture may hold; most are valid depths.
fn any_depth() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (1u32..0x3f80_0000).prop_map(f32::from_bits),
        2 => (1u32..0x0080_0000).prop_map(f32::from_bits),
        2 => select(vec![0.0, -0.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.25, 1.5, f32::MIN_POSITIVE]),
        1 => any::<u32>().prop_map(f32::from_bits),
    ]
}

#[test]
fn every_shape_finds_the_scan_of_any_depth_in_any_viewport() {
    const SIZES: [[u32; 2]; 10] = [
        [1, 1],
        [2, 1],
        [1, 2],
        [3, 3],
        [7, 5],
        [129, 33],
        [257, 2],
        [300, 17],
        [64, 64],
        [1, 97],
    ];
    let words = any::<[u16; 4]>();
    let case = (
        select(&SIZES[..]),
        words,
        vec(any_depth(), 8),
        any::<u64>(),
        0.0f64..=1.0,
    );
    let config = ProptestConfig {
        cases: 60,
        max_shrink_iters: 32,
        ..ProptestConfig::default()
    };
    TestRunner::new(config)
        .run(&case, |(size, cut, values, seed, sky)| {
            let mut random = Random::new(seed);
            let depths: Vec<f32> = (0..size[0] * size[1])
                .map(|_| {
                    if f64::from(random.unit()) < sky {
                        0.0
                    } else {
                        random.pick(&values)
                    }
                })
                .collect();
            let x = u32::from(cut[0]) % size[0];
            let y = u32::from(cut[1]) % size[1];
            let rect = [
                x,
                y,
                1 + u32::from(cut[2]) % (size[0] - x),
                1 + u32::from(cut[3]) % (size[1] - y),
            ];
            for rect in [[0, 0, size[0], size[1]], rect] {
                let want = range::scan(inside(&depths, size[0], rect));
                for shape in SHAPES {
                    assert_eq!(
                        reduce(shape, &depths, size, rect),
                        want,
                        "{shape:?} on {size:?}, {rect:?}"
                    );
                }
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn every_shape_counts_every_depth_once() {
    let mut random = Random::new(11);
    for size in [[1u32, 1], [7, 5], [129, 33], [300, 67], [256, 64]] {
        // Runs of equal depths, as in pictures, with sky and invalid depths between.
        let mut d = 0.5f32;
        let depths: Vec<f32> = (0..size[0] * size[1])
            .map(|_| {
                match random.unit() {
                    x if x < 0.1 => d = f32::from_bits((random.unit() * 1_065_353_216.0) as u32),
                    x if x < 0.15 => return 0.0,
                    x if x < 0.16 => return f32::NAN,
                    x if x < 0.17 => return 1.0,
                    x if x < 0.3 => d *= 0.97,
                    _ => {}
                }
                d
            })
            .collect();
        let cut = [
            size[0] / 3,
            size[1] / 4,
            size[0] - size[0] / 3,
            size[1] - size[1] / 4,
        ];
        for rect in [[0, 0, size[0], size[1]], cut] {
            let range = range::scan(inside(&depths, size[0], rect));
            let (bins, total) = Bins::Octaves.count(inside(&depths, size[0], rect));
            for shape in SHAPES {
                let defs: Vec<&str> = shape.iter().copied().chain(["HISTOGRAM"]).collect();
                let (found, counted) = reduce_and_count(&defs, &depths, (size, rect), [0.0; 2]);
                let what = format!("{shape:?} on {size:?}, {rect:?}");
                assert_eq!(found, range, "{what}");
                assert_eq!(counted[..256], bins, "{what}");
                assert_eq!(counted[256], total, "{what}");
            }
        }
    }
}

#[test]
fn the_widest_and_the_tallest_texture_are_reduced() {
    let most = gpu().device.limits().max_texture_dimension_2d;
    for size in [[most, 1], [1, most], [most, 3]] {
        let mut depths = vec![0.0f32; (size[0] * size[1]) as usize];
        depths[0] = 0.25;
        *depths.last_mut().expect("not empty") = 0.75;
        let middle = depths.len() / 2;
        depths[middle] = f32::from_bits(0x0080_0001);
        for shape in SHAPES {
            let found = reduce(shape, &depths, size, [0, 0, size[0], size[1]]);
            assert_eq!(
                found,
                Some([0.75f32.to_bits(), 0x0080_0001]),
                "{shape:?} on {size:?}"
            );
        }
    }
}
