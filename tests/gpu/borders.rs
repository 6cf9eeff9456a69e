//! The borders between near, middle and far: the search against all pairs, and their motion.

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        borders::{Borders, Counted},
        histogram::{BINS, Bins},
    },
    wgsl,
};

use crate::{
    prelude::*,
    smoothing::{HOLD, SNAP, bind, record, words},
};

const ORTHOGRAPHIC: u32 = 1;

fn divide() -> &'static wgpu::ComputePipeline {
    static DIVIDE: OnceLock<wgpu::ComputePipeline> = OnceLock::new();
    DIVIDE.get_or_init(|| {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/depth/borders.wgsl");
        let source = std::fs::read_to_string(path).expect("the shader");
        let module = wgsl::module(&source, &[]).unwrap_or_else(|error| panic!("{error}"));
        gpu().compute_pipeline(module, "divide")
    })
}

/// A frame: what was counted, the fraction of the way that it makes up, and its flags.
struct Frame<'a> {
    counted: Counted<'a>,
    fraction: f32,
    flags: u32,
}

/// Raw depths of the borders (near, far) in each frame; `None` if there are none.
fn run(frames: &[Frame]) -> Vec<Option<[f32; 2]>> {
    let gpu = gpu();
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let state = gpu.buffer(&[0; 16], usage);
    let mut found = Vec::new();
    for frame in frames {
        let Counted {
            bins,
            counts,
            offset,
        } = &frame.counted;
        let (window, orthographic) = match bins {
            Bins::Octaves => ([0.0; 2], 0),
            Bins::Window(ends) => (ends.map(|d| d as f32), ORTHOGRAPHIC),
        };
        let mut smoothing = [0; 8];
        smoothing[0] = (*offset as f32).to_bits();
        smoothing[4] = frame.fraction.to_bits();
        smoothing[7] = frame.flags | orthographic;
        let mut histogram = counts.to_vec();
        histogram.push(counts.iter().sum());
        histogram.extend(window.map(f32::to_bits));
        let drawn = gpu.buffer(&[0; 16], usage);
        let smoothing = gpu.buffer(&words(&smoothing), wgpu::BufferUsages::UNIFORM);
        let histogram = gpu.buffer(&words(&histogram), wgpu::BufferUsages::STORAGE);
        let group = bind(divide(), [&smoothing, &histogram, &state, &drawn]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(&mut encoder, divide(), &group);
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(&drawn);
        let word = |at: usize| f32::from_le_bytes([0, 1, 2, 3].map(|i| bytes[4 * at + i]));
        found.push((word(2) > 0.0).then(|| [word(2), word(3)]));
    }
    found
}

/// Heaps of depths, one to five, wide or narrow, some with empty bins between them.
fn heaps(random: &mut Random) -> Vec<u32> {
    let mut counts = vec![0u32; BINS];
    let heaps = 1 + (random.unit() * 5.0) as usize;
    for _ in 0..heaps {
        let (middle, width) = (random.range(2.0, 253.0), random.range(0.3, 25.0));
        let most = 10f32.powf(random.range(0.0, 6.0));
        for (bin, count) in counts.iter_mut().enumerate() {
            let away = (bin as f32 - middle) / width;
            *count += (most * (-away * away).exp()) as u32;
        }
    }
    counts
}

fn bins(random: &mut Random, k: usize) -> (Bins, f64) {
    match k % 3 {
        0 => (Bins::Octaves, 0.0),
        // A far plane: raw depth reaches 0 there.
        1 => (Bins::Octaves, f64::from(random.range(1e-4, 1e-2))),
        _ => {
            let near = random.range(0.5, 1.0);
            let far = near - 10f32.powf(random.range(-3.0, -0.4));
            (Bins::Window([near, far].map(f64::from)), 0.0)
        }
    }
}

#[test]
fn borders_are_those_of_the_exhaustive_search() {
    let mut random = Random::new(16);
    let (mut same, mut all) = (0, 0);
    for k in 0..300 {
        let counts = heaps(&mut random);
        let (bins, offset) = bins(&mut random, k);
        let counted = Counted {
            bins,
            counts: &counts,
            offset,
        };
        let found = run(&[Frame {
            counted: counted.clone(),
            fraction: 1.0,
            flags: 0,
        }]);
        let Some((pair, most)) = counted.search() else {
            assert_eq!(found, [None], "{counted:?}");
            continue;
        };
        if most < 1e-6 {
            // All at one distance, to a thousandth: beyond the far plane of the camera.
            continue;
        }
        let [near, far] = found[0].expect("borders").map(f64::from);
        assert!(near >= far, "{counted:?}: {near}, {far}");
        let chosen = [counted.bins_before(far), counted.bins_before(near)];
        let explained = counted.explained(chosen[0], chosen[1]);
        // Moments are sums of at most 256 rounded terms, and are squared.
        let error = 2.0 * 256.0 * 2f64.powi(-24);
        assert!(
            explained >= (1.0 - error) * most,
            "{counted:?}: {chosen:?} explain {explained}, {pair:?} {most}"
        );
        all += 1;
        // Where two pairs explain the same up to that error, either may be chosen.
        if explained < (1.0 - 1e-12) * most {
            continue;
        }
        same += 1;
        // In the middle of the gap. Raw depth near 1 is rounded to 2^-24, four times, and that is
        // a fraction of the window; a logarithm of up to 32 to 2^-19.
        let error = match counted.bins {
            Bins::Window([near, far]) => 4.0 * 2f64.powi(-24) / (near - far),
            Bins::Octaves => 2f64.powi(-18),
        };
        let want = [pair[1], pair[0]].map(|bin| counted.place(counted.gap(bin)));
        let got = [near, far].map(|d| counted.place(d));
        let apart = (0..2).map(|i| (want[i] - got[i]).abs()).fold(0.0, f64::max);
        assert!(apart <= error, "{counted:?}: {got:?} for {want:?}");
    }
    assert!(all > 250, "{all} of 300 heaps can be divided");
    assert!(
        same > all / 2,
        "{same} of {all} have the pair of the search"
    );
}

/// Counts of three heaps, of which the one in the middle lies `by` bins nearer.
fn three(by: usize) -> Vec<u32> {
    let mut counts = vec![0; BINS];
    for bin in 0..6 {
        counts[100 + bin] = 500;
        counts[140 + by + bin] = 3000;
        counts[220 + bin] = 3000;
    }
    counts
}

/// Frames that make up a part of the way each.
fn frames(scenes: &[Vec<u32>], fraction: f32) -> Vec<Frame<'_>> {
    let frames = scenes.iter().map(|counts| Frame {
        counted: counted(counts),
        fraction,
        flags: 0,
    });
    frames.collect()
}

fn counted(counts: &[u32]) -> Counted<'_> {
    Counted {
        bins: Bins::Octaves,
        counts,
        offset: 0.0,
    }
}

#[test]
fn borders_rest_until_others_explain_more_and_then_follow_like_their_reference() {
    // The heap comes nearer, so that it belongs to the others at the end.
    let scenes: Vec<Vec<u32>> = (0..180).map(|k| three(k.min(50))).collect();
    let frames = frames(&scenes, 0.15);
    let found = run(&frames);
    let mut reference = Borders::default();
    let mut moved = 0;
    for (i, (frame, found)) in frames.iter().zip(&found).enumerate() {
        let want = reference
            .next(&frame.counted, 0.15, [false; 2])
            .expect("borders");
        let found = found.expect("borders");
        for k in 0..2 {
            let apart = (f64::from(found[k]) / want[k]).log2().abs();
            assert!(apart < 1e-4, "frame {i}: {found:?}, reference {want:?}");
        }
    }
    for pair in found.windows(2) {
        let [before, after] = [pair[0], pair[1]].map(|b| b.expect("borders")[1].log2());
        moved += usize::from(before != after);
        // The way is five octaves: the largest step is its 0.15.
        assert!((before - after).abs() <= 0.15 * 5.0, "{pair:?}");
    }
    assert!(
        (5..150).contains(&moved),
        "the far border moved in {moved} frames"
    );
    // It ends at its goal, bit for bit.
    assert_eq!(found[found.len() - 2], found[found.len() - 1]);
    let fresh = run(&frames[frames.len() - 1..]);
    let last = found[found.len() - 1].expect("borders");
    let [near, far] = fresh[0].expect("borders");
    let all = counted(&scenes[59]);
    let explained = |near: f32, far: f32| {
        let [near, far] = [near, far].map(|d| all.bins_before(f64::from(d)));
        all.explained(far, near)
    };
    assert!(1.05 * explained(last[0], last[1]) >= explained(near, far));
}

/// Counts that come and go do not move the borders at all.
#[test]
fn noise_moves_no_border() {
    let mut random = Random::new(7);
    let scenes: Vec<Vec<u32>> = (0..60)
        .map(|_| {
            let shift = (random.unit() * 3.0) as usize;
            let mut counts = three(shift);
            for count in &mut counts {
                *count = (*count as f32 * random.range(0.8, 1.2)) as u32;
            }
            counts
        })
        .collect();
    let found = run(&frames(&scenes, 0.1));
    assert!(
        found[0].is_some() && found.iter().all(|f| *f == found[0]),
        "{found:?}"
    );
}

#[test]
fn a_cut_forgets_the_past_and_a_lock_keeps_it() {
    let (before, after) = (three(0), three(50));
    let frame = |counts, flags| Frame {
        counted: counted(counts),
        fraction: 0.1,
        flags,
    };
    let fresh = run(&[frame(&after, 0)])[0];
    let cut = run(&[frame(&before, 0), frame(&after, SNAP)]);
    assert_eq!(cut[1], fresh);
    assert_ne!(cut[0], fresh);
    let held = run(&[
        frame(&before, 0),
        frame(&after, HOLD),
        frame(&after, SNAP | HOLD),
    ]);
    assert_eq!([held[1], held[2]], [held[0], held[0]]);
    // A view that shows nothing keeps its borders.
    let nothing = vec![0; BINS];
    let empty = run(&[frame(&before, 0), frame(&nothing, 0)]);
    assert_eq!(empty[1], empty[0]);
    assert_eq!(run(&[frame(&nothing, 0)]), [None]);
}
