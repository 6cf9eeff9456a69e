#define_import_path bevy_comics::depth::smoothing

// Smooths the visible range over time: percentiles instead of extremes, the median of
// three frames, hysteresis, and an exponential approach. One invocation per view and
// frame; its state stays on the GPU.

#import bevy_comics::depth::level::{DESPIKE, HOLD, ORTHOGRAPHIC, RESET, SNAP, Smoothing, bits_of, level_of}
#ifdef HISTOGRAM
#import bevy_comics::depth::histogram::{
    BINS, DepthWindow, Histogram, OCTAVE_BIN_WIDTH, depth_window, octave_bin, octave_edge, window_bin, window_bin_ends,
}
#endif

// Bound::mode.
// Hysteresis keeps the goal.
const RESTING: u32 = 0u;
// The goal follows the depth that is found.
const FOLLOWING: u32 = 1u;
// As RESTING, but the bound is on its slow way to a goal inside of the hysteresis.
const SETTLING: u32 = 2u;

// One end of the range. A level is log2(d + a); under an orthographic projection it is
// d itself.
struct Bound {
    // The level that the bound approaches, and what is missing: the drawn level is
    // goal + rest. The rest is kept by itself, because a step of the drawn level may be
    // below half of its unit in the last place; the rest shrinks by any fraction.
    goal: f32,
    rest: f32,
    // Bits of the depth at the goal.
    goal_bits: u32,
    mode: u32,
    // Bits of the depths that were found one and two frames ago.
    before: u32,
    earlier: u32,
    // Bits of the farthest and the nearest depth that were found during the last
    // `watched` seconds within the hysteresis.
    low: u32,
    high: u32,
    watched: f32,
}

// RangeState::phase.
const NOTHING_FOUND: u32 = 0u;
// The next frame replaces the range instead of following it.
const PROVISIONAL: u32 = 1u;
const STARTED: u32 = 2u;

struct RangeState {
    near: Bound,
    far: Bound,
    phase: u32,
    unused: u32,
    // Bits of the nearest and the farthest depth of the last frame with geometry. The
    // next frame counts depths in bins of this window (WINDOW_OFFSET of follow.rs).
    window: vec2<u32>,
}

@group(0) @binding(0) var<uniform> smoothing: Smoothing;
@group(0) @binding(1) var<storage, read> found: vec4<u32>;
@group(0) @binding(2) var<storage, read_write> state: RangeState;
@group(0) @binding(3) var<storage, read_write> drawn: vec4<u32>;
#ifdef HISTOGRAM
@group(0) @binding(4) var<storage, read> histogram: Histogram;
#endif

// A bound this close to its goal, in levels, is set to the goal: 0.02 % of a distance.
// Under an orthographic projection, as a fraction of the hysteresis.
const SETTLED: f32 = 0.00025;

// A bound that rests beside everything that was found for this time, in seconds, begins
// to settle.
const WATCH: f32 = 4.0;

fn median(a: u32, b: u32, c: u32) -> u32 {
    return max(min(a, b), min(max(a, b), c));
}

// Makes the depth with these bits the goal. The drawn level stays where it is.
fn aim(s: Smoothing, old: Bound, bits: u32) -> Bound {
    var b = old;
    let goal = level_of(s, bits);
    b.rest += b.goal - goal;
    b.goal = goal;
    b.goal_bits = bits;
    return b;
}

// A bound inside of the hysteresis. Noise around the goal changes nothing. If all that
// was found for WATCH seconds is on one side of the goal, the middle of it becomes the
// goal: a view that stands still gets the range of a new view, whatever came before.
fn watch(s: Smoothing, old: Bound, at: u32) -> Bound {
    var b = old;
    b.low = min(b.low, at);
    b.high = max(b.high, at);
    b.watched += s.seconds;
    if b.watched < WATCH {
        return b;
    }
    if b.goal_bits < b.low || b.goal_bits > b.high {
        b = aim(s, b, b.low + (b.high - b.low) / 2u);
        b.mode = SETTLING;
    }
    return watch_anew(b, at);
}

fn watch_anew(old: Bound, at: u32) -> Bound {
    var b = old;
    b.low = at;
    b.high = at;
    b.watched = 0.0;
    return b;
}

// The bound after a frame in which the depth at its end has these bits. `outward` is 1
// if a larger level widens the range (near), -1 if a smaller one does (far).
fn follow_bound(s: Smoothing, old: Bound, bits: u32, outward: f32, hysteresis: f32) -> Bound {
    var b = old;
    var at = bits;
    if (s.flags & DESPIKE) != 0u {
        at = median(bits, old.before, old.earlier);
    }
    b.earlier = old.before;
    b.before = bits;
    if abs(level_of(s, at) - b.goal) > hysteresis {
        b.mode = FOLLOWING;
    }
    if b.mode == FOLLOWING {
        b = watch_anew(aim(s, b, at), at);
    } else {
        b = watch(s, b, at);
    }
    var fraction = select(s.shrink, s.expand, b.rest * outward < 0.0);
    if b.mode == SETTLING {
        fraction = min(fraction, s.settle);
    }
    b.rest -= fraction * b.rest;
    if b.mode == FOLLOWING && abs(b.rest) <= 0.25 * hysteresis {
        b.mode = RESTING;
    }
    var settled = SETTLED;
    if (s.flags & ORTHOGRAPHIC) != 0u {
        settled = SETTLED * hysteresis;
    }
    if abs(b.rest) <= settled {
        b.rest = 0.0;
        b.mode = select(b.mode, RESTING, b.mode == SETTLING);
    }
    return b;
}

// A bound without a past: at its goal.
fn snapped(s: Smoothing, bits: u32) -> Bound {
    return Bound(level_of(s, bits), 0.0, bits, RESTING, bits, bits, bits, bits, 0.0);
}

// Bits of the depth at which a bound is drawn: exactly those that were found, once the
// bound is at its goal.
fn bound_bits(s: Smoothing, b: Bound) -> u32 {
    if b.rest == 0.0 {
        return b.goal_bits;
    }
    return bits_of(s, b.goal + b.rest);
}

#ifdef HISTOGRAM
// Where a rank is among the counted depths: a bin, and the fraction of its depths that
// come before the rank.
struct Place {
    bin: u32,
    part: f32,
}

// The place that `rank` depths come before, in the order of the bins from `first` to
// `last`.
fn place_of(first: u32, last: u32, rank: f32) -> Place {
    var bin = first;
    var count = f32(histogram.bins[bin]);
    var passed = 0.0;
    // Not an endless loop with a return inside: from that, llvmpipe returned a wrong part.
    while bin != last && passed + count <= rank {
        passed += count;
        bin = select(bin - 1u, bin + 1u, last > first);
        count = f32(histogram.bins[bin]);
    }
    return Place(bin, clamp((rank - passed) / max(count, 1.0), 0.0, 1.0));
}

// Bits of the depths (near, far) that the outliers are beyond, interpolated within
// their bins.
fn percentiles(s: Smoothing, near: u32, far: u32) -> vec2<u32> {
    if s.outliers == 0.0 {
        return vec2(near, far);
    }
    let rank = s.outliers * f32(histogram.total);
    if (s.flags & ORTHOGRAPHIC) != 0u {
        let w = depth_window(vec2(histogram.window_near, histogram.window_far));
        let ends = bitcast<vec2<f32>>(vec2(near, far));
        // One bin earlier than the extreme's: two shaders may round it to two bins.
        let first = min(window_bin(w, ends.x) + 1u, BINS - 1u);
        let last = max(window_bin(w, ends.y), 1u) - 1u;
        let a = place_of(first, 0u, rank);
        let b = place_of(last, BINS - 1u, rank);
        let a_ends = window_bin_ends(w, a.bin, ends.x, ends.y);
        let b_ends = window_bin_ends(w, b.bin, ends.x, ends.y);
        let d = vec2(a_ends.y - a.part * (a_ends.y - a_ends.x), b_ends.x + b.part * (b_ends.y - b_ends.x));
        return bitcast<vec2<u32>>(clamp(d, vec2(ends.y), vec2(ends.x)));
    }
    let a = place_of(octave_bin(near), 0u, rank);
    let b = place_of(octave_bin(far), BINS - 1u, rank);
    let bits = vec2(
        octave_edge(a.bin) - u32(a.part * f32(OCTAVE_BIN_WIDTH)),
        octave_edge(b.bin) - OCTAVE_BIN_WIDTH + u32(b.part * f32(OCTAVE_BIN_WIDTH)),
    );
    return clamp(bits, vec2(far), vec2(near));
}
#endif

// Starts anew from the range of this frame. The bins of an orthographic view come from
// the frame before, so its first percentiles may be coarse.
fn start(near: u32, far: u32, first: bool) {
    state.near = snapped(smoothing, near);
    state.far = snapped(smoothing, far);
    state.phase = STARTED;
#ifdef HISTOGRAM
    if first && smoothing.outliers > 0.0 && (smoothing.flags & ORTHOGRAPHIC) != 0u {
        state.phase = PROVISIONAL;
    }
#endif
}

// Advances the state by a frame with geometry between these depths.
fn advance(near: u32, far: u32) {
    let snap = (smoothing.flags & (SNAP | HOLD)) == SNAP;
    if state.phase != STARTED || snap {
        start(near, far, state.phase == NOTHING_FOUND || snap);
        return;
    }
    var hysteresis = smoothing.hysteresis;
    if (smoothing.flags & ORTHOGRAPHIC) != 0u {
        hysteresis *= abs(state.near.goal - state.far.goal);
    }
    state.near = follow_bound(smoothing, state.near, near, 1.0, hysteresis);
    state.far = follow_bound(smoothing, state.far, far, -1.0, hysteresis);
}

@compute @workgroup_size(1)
fn follow() {
    if (smoothing.flags & RESET) != 0u {
        state.phase = NOTHING_FOUND;
    }
    let extremes = vec2(found.x, 0u - found.y);
    if found.x != 0u {
        state.window = extremes;
    }
    let hold = (smoothing.flags & HOLD) != 0u && state.phase == STARTED;
    if found.x == 0u && !hold {
        // No geometry in this frame: the state stays as it is.
        drawn = vec4(0u);
        return;
    }
    if !hold {
        var ends = extremes;
#ifdef HISTOGRAM
        ends = percentiles(smoothing, ends.x, ends.y);
#endif
        advance(ends.x, ends.y);
    }
    let near = bound_bits(smoothing, state.near);
    // The bounds can cross if shrinking is faster than expanding: then far is near.
    let far = min(bound_bits(smoothing, state.far), near);
    drawn = vec4(near, 0u - far, 0u, 0u);
}
