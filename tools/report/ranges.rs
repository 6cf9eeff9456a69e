//! The error of depth ranges that are found with less work.

use bevy::math::UVec2;
use bevy_comics::{
    Colorization, ComicStyle, DepthMap,
    depth::{RangeSmoothing, ReductionMethod},
};

use bevy_comics_testkit::{
    device::gpu, reference::histogram::Bins, scenes::BuiltIn, studio::with_map,
};

use crate::{
    Run,
    bare::{self, Blit, time, upload, view, words},
    capture::{self, Capture, Shot},
    rig::{self, Drawn, Rig},
    table::Table,
};

/// Reads every `stride`-th pixel of every `stride`-th row, starting at a phase. `job` is
/// (stride, phase x, phase y). At stride 1 the shape is that of
/// `ReductionMethod::BarrierFree`, without its texture gathers.
const STRIDED: &str = "
    @group(0) @binding(0) var depth: texture_2d<f32>;
    @group(0) @binding(1) var<uniform> job: vec4<u32>;
    @group(0) @binding(2) var<storage, read_write> keys: array<atomic<u32>, 4>;
    @compute @workgroup_size(8)
    fn reduce(@builtin(global_invocation_id) id: vec3<u32>) {
        let size = textureDimensions(depth);
        let y = id.x * job.x + job.z;
        let start = id.y * 256u;
        if y >= size.y || start >= size.x { return; }
        var found = vec2(0u);
        for (var x = start + job.y; x < min(start + 256u, size.x); x += job.x) {
            let bits = bitcast<u32>(textureLoad(depth, vec2<i32>(vec2(x, y)), 0).r);
            let pair = vec2(bits, 0u - bits);
            found = max(found, select(pair, vec2(0u), bits == 0u || bits > 0x3f800000u));
        }
        if found.x != 0u {
            atomicMax(&keys[0], found.x);
            atomicMax(&keys[1], found.y);
        }
    }";

struct Strided {
    pipeline: wgpu::ComputePipeline,
}

impl Strided {
    fn new() -> Self {
        let module = bevy_comics_testkit::wgsl::module(STRIDED, &[])
            .unwrap_or_else(|error| panic!("{error}"));
        Self {
            pipeline: gpu()
                .device
                .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: None,
                    layout: None,
                    module: &gpu().shader(module),
                    entry_point: Some("reduce"),
                    compilation_options: Default::default(),
                    cache: None,
                }),
        }
    }

    fn job(&self, texture: &wgpu::Texture, stride: u32, phase: [u32; 2]) -> Job<'_> {
        let uniform = gpu().buffer(
            &words(&[stride, phase[0], phase[1], 0]),
            wgpu::BufferUsages::UNIFORM,
        );
        let keys = gpu().buffer(
            &[0; 16],
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        );
        let group = bare::group(
            &self.pipeline.get_bind_group_layout(0),
            &[
                wgpu::BindingResource::TextureView(&view(texture)),
                uniform.as_entire_binding(),
                keys.as_entire_binding(),
            ],
        );
        Job {
            strided: self,
            group,
            keys,
            workgroups: [
                texture.height().div_ceil(stride).div_ceil(8),
                texture.width().div_ceil(256),
            ],
        }
    }
}

struct Job<'a> {
    strided: &'a Strided,
    group: wgpu::BindGroup,
    keys: wgpu::Buffer,
    workgroups: [u32; 2],
}

impl Job<'_> {
    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.keys, 0, None);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.strided.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(self.workgroups[0], self.workgroups[1], 1);
    }

    fn ends(&self) -> Option<[f32; 2]> {
        let mut encoder = gpu().device.create_command_encoder(&Default::default());
        self.record(&mut encoder);
        gpu().queue.submit([encoder.finish()]);
        let b = gpu().read(&self.keys);
        let word = |i: usize| u32::from_le_bytes([b[i], b[i + 1], b[i + 2], b[i + 3]]);
        (word(0) != 0).then(|| [word(0), word(4).wrapping_neg()].map(f32::from_bits))
    }
}

/// The rotating scan: each frame reads a sixteenth of the pixels; the range is that of the
/// last sixteen frames.
fn rotating(strided: &Strided, textures: &[wgpu::Texture], frame: usize) -> Option<[f32; 2]> {
    let mut ends: Option<[f32; 2]> = None;
    for back in 0..16usize.min(frame + 1) {
        let at = frame - back;
        // A permutation of the sixteen phases: successive ones are far apart.
        let phase = (at * 7) % 16;
        let job = strided.job(&textures[at], 4, [phase as u32 % 4, phase as u32 / 4]);
        if let Some([near, far]) = job.ends() {
            let [n, f] = ends.unwrap_or([near, far]);
            ends = Some([n.max(near), f.min(far)]);
        }
    }
    ends
}

/// Fraction of the pixels that percentiles leave out at either end.
pub const OUTLIERS: f64 = 0.005;

fn percentiles(shot: &Shot) -> Option<[f32; 2]> {
    let ends = shot.ends()?;
    let (bins, total) = Bins::Octaves.count(shot.depth.iter().copied());
    let found = Bins::Octaves.percentiles(&bins, total, OUTLIERS, ends.map(f64::from));
    Some(found.map(|d| d as f32))
}

pub const METHODS: [&str; 8] = [
    "full",
    "ping-pong",
    "stride 2",
    "stride 4",
    "stride 8",
    "rotating 4",
    "previous frame",
    "percentiles 0.5 %",
];

struct Errors {
    near: f64,
    far: f64,
    map: f64,
    band: f64,
    flip: f64,
}

fn errors(size: UVec2, shot: &Shot, found: Option<[f32; 2]>) -> Option<Errors> {
    let truth = shot.ends()?.map(f64::from);
    let found = found?.map(f64::from);
    let (exact, rough) = (capture::frame(truth), capture::frame(found));
    let style = capture::look();
    let (mut map, mut band, mut count) = (0.0f64, 0usize, 0usize);
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for (d, light) in shot.depth.iter().zip(&shot.picture) {
        let d = f64::from(*d);
        let (x, y) = (exact.depth_map(d), rough.depth_map(d));
        if d > 0.0 {
            map = map.max((x[0] - y[0]).abs());
            let of = |d: f64| (d * 8.0).floor().min(7.0);
            band += usize::from(of(x[0]) != of(y[0]));
            count += 1;
        }
        a.push(capture::styled(&style, *light, x));
        b.push(capture::styled(&style, *light, y));
    }
    Some(Errors {
        // Distances are proportional to 1 / d.
        near: (truth[0] / found[0] - 1.0).abs(),
        far: (truth[1] / found[1] - 1.0).abs(),
        map,
        band: band as f64 / count.max(1) as f64,
        flip: capture::flip(size, &a, &b),
    })
}

fn measure_errors(run: &Run, captures: &[Capture]) -> Table {
    let strided = Strided::new();
    let mut table = Table::new(&[
        "scene", "method", "frame", "near", "far", "map", "band", "flip",
    ]);
    let frames: &[usize] = if run.quick { &[16] } else { &[4, 8, 12, 16] };
    for capture in captures {
        let size = capture.size.to_array();
        let textures: Vec<_> = capture
            .shots
            .iter()
            .map(|shot| upload(size, &shot.depth))
            .collect();
        for &frame in frames {
            let shot = &capture.shots[frame];
            for method in METHODS {
                let stride = |k| strided.job(&textures[frame], k, [0, 0]).ends();
                let found = match method {
                    "full" => stride(1),
                    // Computed by the reference.
                    "ping-pong" => {
                        let (w, h) = (size[0] as usize, size[1] as usize);
                        bevy_comics_testkit::reference::ping_pong::reduce(&shot.depth, w, h)
                            .1
                            .map(|bits| bits.map(f32::from_bits))
                    }
                    "stride 2" => stride(2),
                    "stride 4" => stride(4),
                    "stride 8" => stride(8),
                    "rotating 4" => rotating(&strided, &textures, frame),
                    "previous frame" => capture.shots[frame - 1].ends(),
                    _ => percentiles(shot),
                };
                let Some(e) = errors(capture.size, shot, found) else {
                    // It found no geometry where there is some: every error is 1.
                    table.push(&[&capture.name, &method, &frame, &1, &1, &1, &1, &1]);
                    continue;
                };
                table.push(&[
                    &capture.name,
                    &method,
                    &frame,
                    &format!("{:.3e}", e.near),
                    &format!("{:.3e}", e.far),
                    &format!("{:.3e}", e.map),
                    &format!("{:.5}", e.band),
                    &format!("{:.5}", e.flip),
                ]);
            }
        }
        run.say(&format!("{}: errors of the range", capture.name));
    }
    table
}

fn tinted_by(map: DepthMap) -> Drawn {
    let tint = ComicStyle::new().with(Colorization::default());
    Drawn::style(with_map(tint, map))
}

pub fn measure(run: &Run) -> Result<(), String> {
    let captures = capture::captures(run, capture::FRAMES);
    run.save("range_errors", &measure_errors(run, &captures))?;

    // Times: the crate's reductions in the app, the others on a device without the engine.
    let size = if run.quick {
        UVec2::new(320, 180)
    } else {
        UVec2::new(1920, 1080)
    };
    let mut times = rig::times();
    let mut rig = Rig::new(Some(BuiltIn::Teapot), size);
    rig.unlight();
    let smoothing = |outliers| {
        Some(RangeSmoothing {
            outliers,
            ..RangeSmoothing::default()
        })
    };
    let reductions = [
        ReductionMethod::BarrierFree,
        ReductionMethod::Subgroup,
        ReductionMethod::SharedMemory,
        ReductionMethod::PingPong,
    ];
    let mut variants: Vec<(String, Drawn)> = reductions
        .into_iter()
        .map(|reduction| {
            let map = DepthMap {
                reduction,
                smoothing: None,
                ..DepthMap::default()
            };
            (format!("{reduction:?}"), tinted_by(map))
        })
        .collect();
    for (name, outliers) in [
        ("smoothing without percentiles", 0.0),
        ("percentiles", 0.005),
    ] {
        let map = DepthMap {
            smoothing: smoothing(outliers),
            ..DepthMap::default()
        };
        variants.push((name.to_owned(), tinted_by(map)));
    }
    rig::record(run, &mut times, "ranges", "teapot", &mut rig, &variants);
    run.save("range_times", &times)?;

    let mut bare = Table::new(&["method", "width", "height", "round", "milliseconds"]);
    let strided = Strided::new();
    let blit = Blit::new(size.to_array());
    // The depth of the teapot, enlarged: only reading it is timed.
    let small = captures
        .iter()
        .find(|capture| capture.name == "teapot")
        .ok_or("no teapot")?;
    let depth: Vec<f32> = (0..size.y)
        .flat_map(|y| (0..size.x).map(move |x| (x, y)))
        .map(|(x, y)| {
            let (u, v) = (x * small.size.x / size.x, y * small.size.y / size.y);
            small.shots[0].depth[(v * small.size.x + u) as usize]
        })
        .collect();
    let texture = upload(size.to_array(), &depth);
    let jobs: Vec<_> = [1u32, 2, 4, 8]
        .map(|stride| {
            (
                format!("stride {stride}"),
                strided.job(&texture, stride, [0, 0]),
            )
        })
        .into();
    let times = if run.quick { 2 } else { 8 };
    for round in 0..=run.rounds {
        let mut row = |name: &str, ms: f64| {
            if round > 0 {
                bare.push(&[&name, &size.x, &size.y, &round, &format!("{ms:.5}")]);
            }
        };
        row("blit", time(times, |encoder| blit.record(encoder)));
        for (name, job) in &jobs {
            row(name, time(times, |encoder| job.record(encoder)));
        }
        row("blit again", time(times, |encoder| blit.record(encoder)));
    }
    run.save("range_bare_times", &bare)
}
