#define_import_path bevy_comics::depth::range

// Finds the nearest and the farthest depth of a view in one dispatch. It compares the
// bits of depths instead of floats: bits of positive floats have the same order,
// nothing is rounded or flushed to 0, and with integer atomics the result does not
// depend on the order of the invocations. Both keys are maxima: of the bits (nearest)
// and of 0 - bits (farthest). A buffer of zeros means "no geometry".
//
// TONES: the tones of a picture take the place of depths, see tones.wgsl.

#import bevy_comics::depth::raw::{RangeView, raw_depth_key}
#ifdef TONES
#import bevy_comics::tones::tone_key
#endif
#ifdef HISTOGRAM
#import bevy_comics::depth::histogram::{DepthWindow, depth_window, octave_bin, window_bin}
#endif

struct RangeKeys {
    near: atomic<u32>,
    far: atomic<u32>,
}

#ifdef MULTISAMPLED
@group(0) @binding(0) var depth_texture: texture_multisampled_2d<f32>;
#else
@group(0) @binding(0) var depth_texture: texture_2d<f32>;
#endif
@group(0) @binding(1) var<uniform> view: RangeView;
@group(0) @binding(2) var<storage, read_write> keys: RangeKeys;
#ifndef MULTISAMPLED
#ifndef TONES
@group(0) @binding(3) var nearest_sampler: sampler;
#endif
#endif

#ifdef HISTOGRAM
// `Histogram` of histogram.wgsl, with atomics.
struct Counts {
    bins: array<atomic<u32>, 256>,
    total: atomic<u32>,
    window_near: u32,
    window_far: u32,
}

@group(0) @binding(4) var<storage, read_write> counts: Counts;

// Neighboring depths are mostly in the same bin, so an invocation adds a run of them
// with one atomic operation, when the bin changes. `counted` is the sum of its runs.
var<private> run_bin: u32;
var<private> run: u32;
var<private> counted: u32;
#ifdef ORTHOGRAPHIC
var<private> window: DepthWindow;
#endif

// Must run before anything is counted.
fn begin_count() {
#ifdef ORTHOGRAPHIC
    window = depth_window(vec2(counts.window_near, counts.window_far));
#endif
}

// Adds the current run to its bin.
fn end_run() {
    if run != 0u {
#ifdef BARRIER_FREE
        atomicAdd(&counts.bins[run_bin], run);
#else
        atomicAdd(&tile_bins[run_bin], run);
#endif
    }
    counted += run;
    run = 0u;
}

// Counts one depth, unless it is background (0).
fn count(bits: u32) {
    if bits == 0u {
        return;
    }
#ifdef ORTHOGRAPHIC
    let bin = window_bin(window, bitcast<f32>(bits));
#else
    let bin = octave_bin(bits);
#endif
    if bin != run_bin {
        end_run();
        run_bin = bin;
    }
    run++;
}
#endif

// (near key, far key) of the bits of one depth; zeros for background.
fn key_pair(bits: u32) -> vec2<u32> {
#ifdef HISTOGRAM
    count(bits);
#endif
    return vec2(bits, select(0u - bits, 0u, bits == 0u));
}

// Keys of a block of 2 x 2 pixels. `at` is its upper left pixel, relative to the
// viewport. Pixels outside of the viewport count as background.
fn block_keys(at: vec2<u32>) -> vec2<u32> {
    let corner = view.rect.xy + at;
    let right = at.x + 1u < view.rect.z;
    let below = at.y + 1u < view.rect.w;
#ifdef TONES
    // One pixel of the four: as good for percentiles of a picture.
    return key_pair(tone_key(textureLoad(depth_texture, vec2<i32>(corner), 0)));
#else ifdef MULTISAMPLED
    var found = vec2(0u);
    let samples = #{SAMPLES};
    let last = view.rect.xy + view.rect.zw - 1u;
    for (var i = 0u; i < 4u; i++) {
        let pixel = corner + vec2(i & 1u, i >> 1u);
        if any(pixel > last) {
            continue;
        }
        for (var s = 0; s < samples; s++) {
            let d = textureLoad(depth_texture, vec2<i32>(pixel), s).r;
            found = max(found, key_pair(raw_depth_key(view.raw, pixel, d)));
        }
    }
    return found;
#else
    let size = vec2<f32>(textureDimensions(depth_texture));
    // A gather in the middle of the block returns its pixels (x, y) in the order
    // (0, 1), (1, 1), (1, 0), (0, 0).
    let d = textureGather(0, depth_texture, nearest_sampler, vec2<f32>(corner + 1u) / size);
    var found = key_pair(raw_depth_key(view.raw, corner, d.w));
    if right {
        found = max(found, key_pair(raw_depth_key(view.raw, corner + vec2(1u, 0u), d.z)));
    }
    if below {
        found = max(found, key_pair(raw_depth_key(view.raw, corner + vec2(0u, 1u), d.x)));
    }
    if right && below {
        found = max(found, key_pair(raw_depth_key(view.raw, corner + 1u, d.y)));
    }
    return found;
#endif
}

#ifdef BARRIER_FREE
// For CPU adapters, where barriers are very slow: each invocation reduces a strip of
// 256 columns by two rows and writes its result once.
const STRIP: u32 = 256u;

@compute @workgroup_size(8)
fn reduce(@builtin(global_invocation_id) id: vec3<u32>) {
    let y = id.x * 2u;
    let start = id.y * STRIP;
    if y >= view.rect.w || start >= view.rect.z {
        return;
    }
#ifdef HISTOGRAM
    begin_count();
#endif
    var found = vec2(0u);
    let end = min(start + STRIP, view.rect.z);
    for (var x = start; x < end; x += 2u) {
        found = max(found, block_keys(vec2(x, y)));
    }
    if found.x != 0u {
        atomicMax(&keys.near, found.x);
        atomicMax(&keys.far, found.y);
    }
#ifdef HISTOGRAM
    end_run();
    if counted != 0u {
        atomicAdd(&counts.total, counted);
    }
#endif
}
#else
// For GPUs: a workgroup of 16 rows of 16 invocations, which read 8 x 2 pixels each,
// reduces a tile of 128 x 32 pixels.
var<workgroup> tile: RangeKeys;
#ifndef SUBGROUP
var<workgroup> tree: array<vec2<u32>, 256>;
#endif
#ifdef HISTOGRAM
var<workgroup> tile_bins: array<atomic<u32>, 256>;
#endif

// The keys of the pixels that an invocation reads.
fn strip_keys(group: vec2<u32>, local: u32) -> vec2<u32> {
    var found = vec2(0u);
    let y = group.y * 32u + (local / 16u) * 2u;
    for (var i = 0u; i < 4u; i++) {
        let x = group.x * 128u + (local % 16u) * 8u + i * 2u;
        if x < view.rect.z && y < view.rect.w {
            found = max(found, block_keys(vec2(x, y)));
        }
    }
    return found;
}

@compute @workgroup_size(256)
fn reduce(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
#ifdef SUBGROUP
    @builtin(subgroup_invocation_id) lane: u32,
#endif
) {
#ifdef HISTOGRAM
    begin_count();
    atomicStore(&tile_bins[local], 0u);
    workgroupBarrier();
#endif
    let found = strip_keys(group.xy, local);
#ifdef HISTOGRAM
    end_run();
    workgroupBarrier();
    let tile_count = atomicLoad(&tile_bins[local]);
    if tile_count != 0u {
        atomicAdd(&counts.bins[local], tile_count);
        atomicAdd(&counts.total, tile_count);
    }
#endif
#ifdef SUBGROUP
    if local == 0u {
        atomicStore(&tile.near, 0u);
        atomicStore(&tile.far, 0u);
    }
    workgroupBarrier();
    let best = vec2(subgroupMax(found.x), subgroupMax(found.y));
    // One lane of each subgroup writes the subgroup's result.
    if lane == 0u {
        atomicMax(&tile.near, best.x);
        atomicMax(&tile.far, best.y);
    }
    workgroupBarrier();
    if local == 0u {
        let near = atomicLoad(&tile.near);
        if near != 0u {
            atomicMax(&keys.near, near);
            atomicMax(&keys.far, atomicLoad(&tile.far));
        }
    }
#else
    tree[local] = found;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half >>= 1u) {
        if local < half {
            tree[local] = max(tree[local], tree[local + half]);
        }
        workgroupBarrier();
    }
    if local == 0u && tree[0].x != 0u {
        atomicMax(&keys.near, tree[0].x);
        atomicMax(&keys.far, tree[0].y);
    }
#endif
}
#endif
