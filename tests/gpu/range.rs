//! The depth range, bit for bit.

use bevy::{
    camera::{OrthographicProjection, PerspectiveProjection, Projection, ScalingMode, Viewport},
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{ComicsStage, DepthMap, ReductionMethod, VisibleDepthRange};
use proptest::{
    collection::vec,
    prelude::{ProptestConfig, Strategy, any, prop_oneof},
    sample::select,
    test_runner::TestRunner,
};

use crate::{
    common::headless,
    device::gpu,
    reference::{ping_pong, range},
    small::Small,
    wgsl,
};

const SHAPES: [&[&str]; 3] = [&["BARRIER_FREE"], &["SUBGROUP"], &[]];

/// Runs a shape of `range.wgsl` over a table of depths.
fn reduce(shape: &[&str], depths: &[f32], size: [u32; 2], rect: [u32; 4]) -> Option<[u32; 2]> {
    let gpu = gpu();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/depth/range.wgsl");
    let source = std::fs::read_to_string(path).expect("the shader");
    let module = wgsl::module(&source, shape).unwrap_or_else(|error| panic!("{error}"));
    let compute = wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: compute,
        ty,
        count: None,
    };
    let buffer = |ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[
                entry(
                    0,
                    wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Float { filterable: false },
                        view_dimension: wgpu::TextureViewDimension::D2,
                        multisampled: false,
                    },
                ),
                entry(1, buffer(wgpu::BufferBindingType::Uniform)),
                entry(
                    2,
                    buffer(wgpu::BufferBindingType::Storage { read_only: false }),
                ),
                entry(
                    3,
                    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
                ),
            ],
        });
    let pipeline_layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
    let pipeline = gpu
        .device
        .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&pipeline_layout),
            module: &gpu.shader(module),
            entry_point: Some("reduce"),
            compilation_options: wgpu::PipelineCompilationOptions {
                zero_initialize_workgroup_memory: false,
                ..Default::default()
            },
            cache: None,
        });
    let extent = wgpu::Extent3d {
        width: size[0],
        height: size[1],
        depth_or_array_layers: 1,
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = depths
        .iter()
        .flat_map(|d| d.to_bits().to_le_bytes())
        .collect();
    gpu.queue.write_texture(
        texture.as_image_copy(),
        &bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(size[0] * 4),
            rows_per_image: None,
        },
        extent,
    );
    let mut view = [0u8; 80];
    for (i, value) in rect.iter().enumerate() {
        view[4 * i..4 * i + 4].copy_from_slice(&value.to_le_bytes());
    }
    let uniform = gpu.buffer(&view, wgpu::BufferUsages::UNIFORM);
    let keys = gpu.buffer(
        &[0; 16],
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    );
    let sampler = gpu
        .device
        .create_sampler(&wgpu::SamplerDescriptor::default());
    let texture_view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&texture_view),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: uniform.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: keys.as_entire_binding(),
            },
            wgpu::BindGroupEntry {
                binding: 3,
                resource: wgpu::BindingResource::Sampler(&sampler),
            },
        ],
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
    let bytes = gpu.read(&keys);
    let word = |i: usize| u32::from_le_bytes([bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]]);
    (word(0) != 0).then(|| [word(0), word(4).wrapping_neg()])
}

fn expected(depths: &[f32], size: [u32; 2], rect: [u32; 4]) -> Option<[u32; 2]> {
    range::scan(
        (rect[1]..rect[1] + rect[3])
            .flat_map(|y| (rect[0]..rect[0] + rect[2]).map(move |x| (x, y)))
            .map(|(x, y)| depths[(y * size[0] + x) as usize]),
    )
}

/// Every kind of float that a texture may hold, most of them depths.
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
    let sizes = select(vec![
        [1u32, 1],
        [2, 1],
        [1, 2],
        [3, 3],
        [7, 5],
        [129, 33],
        [257, 2],
        [300, 17],
        [64, 64],
        [1, 97],
    ]);
    let case = (
        sizes,
        any::<[u16; 4]>(),
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
            let mut random = crate::common::scenes::noise::Random::new(seed);
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
                let want = expected(&depths, size, rect);
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

#[test]
fn the_papers_index_arithmetic_loses_no_pixel() {
    for width in 1..40usize {
        for height in 1..40usize {
            let mut random =
                crate::common::scenes::noise::Random::new((width * 100 + height) as u64);
            let depths: Vec<f32> = (0..width * height).map(|_| random.unit()).collect();
            let (_, found) = ping_pong::reduce(&depths, width, height);
            assert_eq!(
                found,
                range::scan(depths.iter().copied()),
                "{width}x{height}"
            );
        }
    }
}

fn msaa_of(samples: u32) -> Msaa {
    Msaa::from_samples(samples)
}

/// The range that the game reads against a scan of the depth texture.
fn assert_range_is_the_scan(small: &Small, rect: Option<[u32; 4]>, what: &str) {
    let depth = small.depth().unwrap_or_else(|| panic!("{what}: no depth"));
    let [x, y, w, h] = rect.unwrap_or([0, 0, depth.width, depth.height]);
    let scan = range::scan(
        (y..y + h)
            .flat_map(|y| (x..x + w).map(move |x| (x, y)))
            .flat_map(|(x, y)| {
                let depth = &depth;
                (0..depth.samples).map(move |s| depth.at(x, y, s))
            }),
    );
    match (small.range(), scan) {
        (
            Some(VisibleDepthRange::Visible {
                raw_near, raw_far, ..
            }),
            Some(scan),
        ) => {
            assert_eq!([raw_near.to_bits(), raw_far.to_bits()], scan, "{what}");
        }
        (Some(VisibleDepthRange::Empty), None) => {}
        (got, want) => panic!("{what}: {got:?} for {want:?}"),
    }
}

#[test]
fn every_method_reads_every_sample_of_a_rendered_view() {
    let samples = headless::adapter().expect("an adapter").samples;
    for samples in samples {
        let mut small = Small::new(UVec2::new(71, 53), msaa_of(samples));
        for reduction in [
            ReductionMethod::Auto,
            ReductionMethod::BarrierFree,
            ReductionMethod::Subgroup,
            ReductionMethod::SharedMemory,
            ReductionMethod::PingPong,
        ] {
            small
                .insert((
                    DepthMap {
                        reduction,
                        ..default()
                    },
                    VisibleDepthRange::default(),
                ))
                .settle();
            assert!(
                small.ran(ComicsStage::DepthRange),
                "{reduction:?} did not run"
            );
            assert_range_is_the_scan(&small, None, &format!("{reduction:?}, {samples} samples"));
        }
        assert_eq!(small.errors(), 0);
    }
}

fn oblique(clip: Mat4) -> Mat4 {
    let mut rows = clip.transpose();
    rows.z_axis.y = 0.02;
    rows.transpose()
}

/// A projection whose near plane is tilted, as a mirror's is.
#[derive(Clone, Debug)]
struct Tilted(PerspectiveProjection);

impl bevy::camera::CameraProjection for Tilted {
    fn get_clip_from_view(&self) -> Mat4 {
        oblique(self.0.get_clip_from_view())
    }
    fn get_clip_from_view_for_sub(&self, view: &bevy::camera::SubCameraView) -> Mat4 {
        oblique(self.0.get_clip_from_view_for_sub(view))
    }
    fn update(&mut self, width: f32, height: f32) {
        self.0.update(width, height);
    }
    fn far(&self) -> f32 {
        self.0.far
    }
    fn get_frustum_corners(&self, near: f32, far: f32) -> [Vec3A; 8] {
        self.0.get_frustum_corners(near, far)
    }
}

/// A perspective with a far plane, which the engine's own has not.
#[derive(Clone, Debug)]
struct Finite(PerspectiveProjection);

impl bevy::camera::CameraProjection for Finite {
    fn get_clip_from_view(&self) -> Mat4 {
        let p = &self.0;
        Mat4::perspective_rh(p.fov, p.aspect_ratio, p.far, p.near)
    }
    fn get_clip_from_view_for_sub(&self, _view: &bevy::camera::SubCameraView) -> Mat4 {
        self.get_clip_from_view()
    }
    fn update(&mut self, width: f32, height: f32) {
        self.0.update(width, height);
    }
    fn far(&self) -> f32 {
        self.0.far
    }
    fn get_frustum_corners(&self, near: f32, far: f32) -> [Vec3A; 8] {
        self.0.get_frustum_corners(near, far)
    }
}

/// Failure 16: the distance that the game reads, under every projection.
#[test]
fn distances_are_right_under_every_projection() {
    let ortho = OrthographicProjection {
        near: -5.0,
        far: 60.0,
        scaling_mode: ScalingMode::FixedVertical {
            viewport_height: 6.0,
        },
        ..OrthographicProjection::default_3d()
    };
    let perspective = PerspectiveProjection {
        near: 0.1,
        far: 40.0,
        ..default()
    };
    for (name, projection) in [
        ("perspective", Projection::Perspective(perspective.clone())),
        ("orthographic", Projection::Orthographic(ortho)),
        ("finite", Projection::custom(Finite(perspective.clone()))),
        ("oblique", Projection::custom(Tilted(perspective))),
    ] {
        let mut small = Small::new(UVec2::new(64, 64), Msaa::Off);
        // One wall across the view, seven before the camera, and nothing else.
        small.clear();
        let mesh = small
            .world()
            .resource_mut::<Assets<Mesh>>()
            .add(Rectangle::new(200.0, 200.0));
        let material = small
            .world()
            .resource_mut::<Assets<StandardMaterial>>()
            .add(Color::WHITE);
        small.world().spawn((
            Mesh3d(mesh),
            MeshMaterial3d(material),
            Transform::from_xyz(0.0, 0.0, -7.0),
        ));
        small
            .insert((
                projection,
                Transform::IDENTITY,
                VisibleDepthRange::default(),
            ))
            .settle();
        let Some((near, far)) = small.range().and_then(VisibleDepthRange::distances) else {
            panic!("{name}: {:?}", small.range());
        };
        // A rasterised plane is as exact as single-precision interpolation
        // between corners a hundred units off.
        for distance in [near, far] {
            assert!((distance - 7.0).abs() < 2e-3, "{name}: {near} to {far}");
        }
        if name != "oblique" {
            assert_range_is_the_scan(&small, None, name);
        }
        assert_eq!(small.errors(), 0, "{name}");
    }
}

/// Failure 3, the range's half.
#[test]
fn the_range_stays_inside_the_viewport() {
    let mut small = Small::new(UVec2::new(90, 60), Msaa::Off);
    small.insert((
        Camera {
            viewport: Some(Viewport {
                physical_position: UVec2::new(13, 7),
                physical_size: UVec2::new(41, 37),
                ..default()
            }),
            ..default()
        },
        VisibleDepthRange::default(),
    ));
    small.settle();
    assert_range_is_the_scan(&small, Some([13, 7, 41, 37]), "viewport");
}

/// Failure 7.
#[test]
fn an_empty_and_a_transparent_view_have_an_empty_range_and_a_defined_picture() {
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Sample4);
    small
        .insert((
            bevy_comics::Contours::default(),
            bevy_comics::Desaturation::default(),
            VisibleDepthRange::default(),
        ))
        .settle();
    assert!(matches!(
        small.range(),
        Some(VisibleDepthRange::Visible { .. })
    ));
    let materials: Vec<_> = {
        let world = small.world();
        let mut query = world.query::<&MeshMaterial3d<StandardMaterial>>();
        query.iter(world).map(|m| m.0.clone()).collect()
    };
    for material in materials {
        let mut assets = small.world().resource_mut::<Assets<StandardMaterial>>();
        let mut material = assets.get_mut(&material).expect("a material of the scene");
        material.alpha_mode = AlphaMode::Blend;
    }
    small.settle();
    assert_eq!(
        small.range(),
        Some(VisibleDepthRange::Empty),
        "transparent things have no depth"
    );
    assert!(small.ran(ComicsStage::Stylize));
    let (_, output) = small.pass();
    assert!(output.pixels.iter().flatten().all(|c| c.is_finite()));
    assert_eq!(small.errors(), 0);
}
