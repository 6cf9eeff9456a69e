//! The smoothed range, frame by frame, against its reference.

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        histogram::Bins,
        smoothing::{LONGEST_WATCHED, Range, SETTLE, Smoothing},
    },
    wgsl,
};

use crate::prelude::*;

const ORTHOGRAPHIC: u32 = 1;
pub const SNAP: u32 = 2;
pub const HOLD: u32 = 4;
const DESPIKE: u32 = 8;

/// One frame: the range found (near, far), its duration, the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub found: Option<[f32; 2]>,
    pub seconds: f64,
    pub flags: u32,
}

pub fn frame(near: f32, far: f32, seconds: f64) -> Frame {
    Frame {
        found: Some([near, far]),
        seconds,
        flags: 0,
    }
}

struct Follow {
    pipeline: wgpu::ComputePipeline,
    with_histogram: wgpu::ComputePipeline,
}

fn follow() -> &'static Follow {
    static FOLLOW: OnceLock<Follow> = OnceLock::new();
    FOLLOW.get_or_init(|| {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/depth/smoothing.wgsl");
        let source = std::fs::read_to_string(path).expect("the shader");
        let pipeline = |defs: &[&str]| {
            let module = wgsl::module(&source, defs).unwrap_or_else(|error| panic!("{error}"));
            gpu().compute_pipeline(module, "follow")
        };
        Follow {
            pipeline: pipeline(&[]),
            with_histogram: pipeline(&["HISTOGRAM"]),
        }
    })
}

pub fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// Buffers at the bindings of a pipeline, in order.
pub fn bind<'a>(
    pipeline: &wgpu::ComputePipeline,
    buffers: impl IntoIterator<Item = &'a wgpu::Buffer>,
) -> wgpu::BindGroup {
    let entry = |(binding, buffer): (u32, &'a wgpu::Buffer)| wgpu::BindGroupEntry {
        binding,
        resource: buffer.as_entire_binding(),
    };
    let entries: Vec<_> = (0..).zip(buffers).map(entry).collect();
    gpu().device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    })
}

/// Records one workgroup of a pipeline.
pub fn record(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    group: &wgpu::BindGroup,
) {
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
}

fn way(seconds: f64, constant: f64) -> f32 {
    if constant > 0.0 {
        (1.0 - (-seconds / constant).exp()) as f32
    } else {
        1.0
    }
}

/// The words of the uniform `Smoothing`.
fn uniform(s: &Smoothing, frame: &Frame, outliers: f32) -> [u32; 8] {
    let flags = frame.flags
        | if s.despike { DESPIKE } else { 0 }
        | if s.offset.is_none() { ORTHOGRAPHIC } else { 0 };
    let floats = [
        s.offset.unwrap_or(0.0) as f32,
        outliers,
        s.hysteresis as f32,
        way(frame.seconds, s.expand),
        way(frame.seconds, s.shrink),
        way(frame.seconds, SETTLE),
        frame.seconds.min(LONGEST_WATCHED) as f32,
    ];
    let mut words = [flags; 8];
    for (word, float) in words.iter_mut().zip(floats) {
        *word = float.to_bits();
    }
    words
}

/// What the percentiles of every frame are taken from: the fraction, the counts, their
/// total, and the window of an orthographic view.
#[derive(Clone, Copy)]
pub struct Outliers<'a> {
    pub fraction: f32,
    pub bins: &'a [u32],
    pub total: u32,
    pub window: [f32; 2],
}

/// Bits of the (near, far) used in each frame.
pub fn run(s: &Smoothing, frames: &[Frame], outliers: Option<Outliers>) -> Vec<Option<[u32; 2]>> {
    let gpu = gpu();
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let state = gpu.buffer(&[0; 96], usage);
    let drawn = gpu.buffer(&[0; 16], usage);
    let all = gpu.buffer(&vec![0; frames.len() * 16], usage);
    let pipeline = match outliers {
        Some(_) => &follow().with_histogram,
        None => &follow().pipeline,
    };
    let histogram = outliers.map(|outliers| {
        let mut table = outliers.bins.to_vec();
        table.push(outliers.total);
        table.extend(outliers.window.map(f32::to_bits));
        gpu.buffer(&words(&table), wgpu::BufferUsages::STORAGE)
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut group: Option<(Frame, wgpu::BindGroup)> = None;
    for (i, frame) in frames.iter().enumerate() {
        // Each pass of wgpu looks at all buffers that there are: those of some frames at a time.
        if i % 64 == 63 {
            gpu.queue.submit([encoder.finish()]);
            let done = gpu.device.poll(wgpu::PollType::wait_indefinitely());
            done.expect("the device answers");
            encoder = gpu.device.create_command_encoder(&Default::default());
        }
        // Equal frames share their buffers.
        let shared = group.take().filter(|(before, _)| before == frame);
        let (_, bind_group) = group.insert(shared.unwrap_or_else(|| {
            let floats = uniform(s, frame, outliers.map_or(0.0, |outliers| outliers.fraction));
            let keys = frame.found.map_or([0; 4], |[near, far]| {
                [near.to_bits(), far.to_bits().wrapping_neg(), 0, 0]
            });
            let uniform = gpu.buffer(&words(&floats), wgpu::BufferUsages::UNIFORM);
            let found = gpu.buffer(&words(&keys), wgpu::BufferUsages::STORAGE);
            let buffers = [&uniform, &found, &state, &drawn];
            (
                *frame,
                bind(pipeline, buffers.into_iter().chain(&histogram)),
            )
        }));
        record(&mut encoder, pipeline, bind_group);
        encoder.copy_buffer_to_buffer(&drawn, 0, &all, i as u64 * 16, 16);
    }
    gpu.queue.submit([encoder.finish()]);
    gpu.read(&all)
        .chunks_exact(16)
        .map(|b| {
            let near = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            let far = u32::from_le_bytes([b[4], b[5], b[6], b[7]]);
            (near != 0).then(|| [near, far.wrapping_neg()])
        })
        .collect()
}

/// The (near, far) used in each frame.
pub fn depths(s: &Smoothing, frames: &[Frame]) -> Vec<[f32; 2]> {
    run(s, frames, None)
        .into_iter()
        .map(|bits| bits.expect("geometry").map(f32::from_bits))
        .collect()
}

pub const DEFAULT: Smoothing = Smoothing {
    offset: Some(0.0),
    despike: true,
    hysteresis: 0.07,
    expand: 0.1,
    shrink: 1.0,
};

/// Only the exponential, without hysteresis.
pub const SMOOTH: Smoothing = Smoothing {
    despike: false,
    hysteresis: 0.0,
    ..DEFAULT
};

pub fn octaves(a: f32, b: f32) -> f64 {
    (f64::from(a) / f64::from(b)).log2()
}

/// Two bursts of changes, each followed by quiet that is long enough to settle.
fn random_frames(random: &mut Random) -> Vec<Frame> {
    let mut ends = [0.5f32, 1e-3];
    let mut frame = |i: usize| {
        let quiet = i % 350 > 80;
        for end in &mut ends {
            *end = match random.unit() {
                x if quiet && x < 0.1 => *end * (1.0 - 1e-5 * random.unit()),
                _ if quiet => *end,
                x if x < 0.1 => (*end * (random.unit() * 6.0 - 3.0).exp2()).min(1.0),
                x if x < 0.5 => (*end * (1.0 + 0.02 * (random.unit() - 0.5))).min(1.0),
                _ => *end,
            };
        }
        let (near, far) = (ends[0].max(ends[1]), ends[0].min(ends[1]));
        Frame {
            found: (random.unit() > 0.05).then_some([near, far]),
            // Sums of these are exact in single precision.
            seconds: f64::from((random.unit() * 50.0).round()) / 1024.0,
            flags: if i == 49 || i == 99 { SNAP } else { 0 },
        }
    };
    (0..700).map(&mut frame).collect()
}

fn assert_followed_as_the_reference(s: &Smoothing, frames: &[Frame]) {
    let mut reference = Range::default();
    for (i, (got, frame)) in run(s, frames, None).iter().zip(frames).enumerate() {
        let found = frame.found.map(|f| f.map(f64::from));
        let want = reference.step(found, s, frame.seconds, frame.flags & SNAP != 0);
        assert_eq!(got.is_some(), want.is_some(), "{s:?}, frame {i}");
        let (Some(got), Some(want)) = (got, want) else {
            continue;
        };
        for (got, want) in got.map(f32::from_bits).into_iter().zip(want) {
            // Levels near -10 have ulps of 1e-6. A bound that has arrived in one and not quite in
            // the other differs by the tolerance of arrival.
            let apart = (f64::from(got) - want).abs() / (want + s.offset.unwrap_or(0.0));
            assert!(apart < 4e-4, "{s:?}, frame {i}: {got} for {want}");
        }
    }
}

#[test]
fn random_views_are_followed_as_the_reference_does() {
    let mut random = Random::new(5);
    for offset in [Some(0.0), Some(1e-3), Some(0.25), None] {
        for despike in [false, true] {
            for hysteresis in [0.0, 0.07, 0.5] {
                let s = Smoothing {
                    offset,
                    despike,
                    hysteresis,
                    expand: 0.1,
                    shrink: 0.7,
                };
                assert_followed_as_the_reference(&s, &random_frames(&mut random));
            }
        }
    }
}

#[test]
fn logarithm_and_power_are_exact_to_a_few_units() {
    const ROOT: f32 = std::f32::consts::SQRT_2;
    let rows: Vec<[f32; 1]> = (0..4000)
        .map(|i| [2f32.powf(-126.0 + i as f32 * 0.0315) * (1.0 + (i % 17) as f32 / 17.0)])
        .chain(
            [
                1.0,
                f32::MIN_POSITIVE,
                0.5,
                0.999_999_9,
                ROOT,
                ROOT.next_up(),
            ]
            .map(|x| [x]),
        )
        .collect();
    let imports = "#import bevy_comics::depth::level::{exact_log2, exact_exp2}";
    let results = gpu().evaluate(
        imports,
        "return vec4(exact_log2(i(0u)), exact_exp2(exact_log2(i(0u))), 0.0, 0.0);",
        &rows,
    );
    for ([x], [log, back, ..]) in rows.iter().zip(results) {
        let want = f64::from(*x).log2();
        let slack = 2.0 * f64::from(f32::EPSILON) * want.abs().max(0.25);
        assert!(
            (f64::from(log) - want).abs() <= slack,
            "log2({x}) = {log}, not {want}"
        );
        // The depth is 2 to the level, so errors of the level are relative.
        let apart = (f64::from(back) / f64::from(*x) - 1.0).abs();
        assert!(
            apart <= slack + 4.0 * f64::from(f32::EPSILON),
            "{x} comes back as {back}"
        );
    }
}

/// Fails unless the same range is drawn in all frames: that of the first.
fn assert_rests(what: &str, frames: &[Frame]) {
    let first = frames[0].found.map(|found| found.map(f32::to_bits));
    let drawn = run(&DEFAULT, frames, None);
    assert!(drawn.iter().all(|d| *d == first), "{what}: {drawn:?}");
}

/// Neither jitter nor what is seen for a single frame, however long it lasts, moves the range.
#[test]
fn a_range_rests_under_jitter_and_intruders_of_one_frame() {
    for jitter in [1u32, 1000, 100_000] {
        let by = |i: u32| (i * 7919 % 5) * jitter;
        let moved = |depth: f32, by: i32| f32::from_bits(depth.to_bits().wrapping_add_signed(by));
        let frames = (0..60).map(|i| {
            let by = by(i) as i32;
            frame(moved(0.25, -by), moved(0.001, by), 0.016)
        });
        assert_rests(&format!("{jitter} ulp"), &frames.collect::<Vec<_>>());
    }
    let mut frames = vec![frame(0.1, 0.001, 0.016); 30];
    frames[9] = frame(0.9, 0.001, 0.016);
    frames[19] = frame(0.1, 1e-6, 0.016);
    assert_rests("intruders", &frames);
    // Two frames in a row are not an outlier.
    frames[20] = frames[19];
    let drawn = run(&DEFAULT, &frames, None);
    assert!(drawn.iter().any(|d| *d != drawn[0]));
    // A game that stops for a minute between two frames of noise has no still view.
    let noise = |i| frame(0.2 * (1.0 + 0.01 * (i % 2) as f32), 0.003, 1.0 / 60.0);
    let mut frames: Vec<Frame> = (0..60).map(noise).collect();
    frames.extend([frame(0.205, 0.003, 60.0); 2]);
    assert_rests("a stopped game", &frames);
}

#[test]
fn a_slow_drift_is_followed_within_the_hysteresis() {
    // The range grows by an octave in four seconds, then stays.
    let frames: Vec<Frame> = (0..900)
        .map(|i| {
            frame(
                0.1,
                0.05 * 2f32.powf(-(i as f32 / 240.0).min(1.0)),
                1.0 / 60.0,
            )
        })
        .collect();
    let drawn = depths(&DEFAULT, &frames);
    for (d, f) in drawn.iter().zip(&frames).skip(60) {
        let found = f.found.expect("geometry");
        let behind = octaves(d[1], found[1]).abs();
        // The hysteresis, plus the change during the lag of 0.1 s.
        assert!(behind < 0.07 + 0.25 * 0.1 + 0.01, "{behind} octaves behind");
    }
}

#[test]
fn nothing_freezes_the_state_and_a_lock_holds_it() {
    let gone = Frame {
        found: None,
        seconds: 10.0,
        flags: 0,
    };
    let near = frame(0.5, 0.1, 0.01);
    let drawn = run(&DEFAULT, &[gone, near, gone, near], None);
    assert_eq!(drawn[0], None);
    assert_eq!(drawn[2], None);
    assert_eq!(drawn[3], drawn[1], "it goes on where it was");

    let views = [None, Some([0.5, 0.1]), Some([0.9, 0.001]), None];
    let hold = views.map(|found| Frame {
        found,
        seconds: 1.0,
        flags: HOLD,
    });
    let drawn = run(&DEFAULT, &hold, None);
    let locked = Some([0.5f32.to_bits(), 0.1f32.to_bits()]);
    assert_eq!(drawn, [None, locked, locked, locked]);
}

#[test]
fn ends_that_would_pass_each_other_meet() {
    let s = Smoothing {
        expand: 10.0,
        shrink: 0.01,
        ..SMOOTH
    };
    // From [0.5, 0.4] to [0.002, 0.001]: the near end is fast, the far end slow.
    let mut frames = vec![frame(0.5, 0.4, 0.01)];
    frames.extend(vec![frame(0.002, 0.001, 0.05); 5]);
    for [near, far] in depths(&s, &frames) {
        assert!(far <= near, "{near} {far}");
    }
}

/// The range of a view whose outermost pixels, a fraction of all, are left out, and that of the
/// reference.
pub fn percentiles(s: &Smoothing, bins: Bins, fraction: f32, depths: &[f32]) -> [[f64; 2]; 2] {
    let nearest = depths.iter().copied().fold(0.0, f32::max);
    let farthest = depths.iter().copied().fold(1.0, f32::min);
    let (counts, total) = bins.count(depths.iter().copied());
    let outliers = Outliers {
        fraction,
        bins: &counts,
        total,
        window: match bins {
            Bins::Octaves => [0.0; 2],
            Bins::Window(ends) => ends.map(|end| end as f32),
        },
    };
    let got = run(s, &[frame(nearest, farthest, 0.0)], Some(outliers))[0].expect("geometry");
    let ends = [nearest, farthest].map(f64::from);
    let want = bins.percentiles(&counts, total, f64::from(fraction), ends);
    [got.map(|bits| f64::from(f32::from_bits(bits))), want]
}

#[test]
fn percentiles_match_the_reference_and_grow_with_the_area() {
    let mut random = Random::new(3);
    for fraction in [0.001f32, 0.005, 0.05, 0.2] {
        for cluster in [0.0f32, 0.5] {
            let mut depth = |_| match random.unit() {
                x if x < cluster => 0.031,
                _ => 2f32.powf(-1.0 - 9.0 * random.unit()),
            };
            let mut table: Vec<f32> = (0..20_000).map(&mut depth).collect();
            let mut before = f64::NAN;
            for intruders in [0usize, 1, 10, 40, 80, 160, 1000] {
                table[..intruders].fill(0.97);
                let [got, want] = percentiles(&SMOOTH, Bins::Octaves, fraction, &table);
                for (got, want) in got.iter().zip(want) {
                    let apart = (got / want - 1.0).abs();
                    assert!(apart < 1e-5, "{fraction}, {intruders}: {got} for {want}");
                }
                // One pixel of 20,000 is 0.005 %: far below the hysteresis of 0.07 octaves.
                let moved = (got[0] / before).log2().abs();
                assert!(intruders != 1 || moved < 0.02, "{before} {got:?}");
                let is_area = intruders as f32 > 1.5 * fraction * 20_000.0;
                assert!(!is_area || got[0] > 0.75, "{intruders} pixels: {got:?}");
                before = got[0];
            }
        }
    }
}

#[test]
fn a_flat_wall_keeps_its_exact_depth_under_percentiles() {
    let [drawn, _] = percentiles(&DEFAULT, Bins::Octaves, 0.005, &[0.123; 500]);
    assert_eq!(drawn, [f64::from(0.123f32); 2]);
}
