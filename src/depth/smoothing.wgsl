#define_import_path bevy_comics::depth::smoothing

// Smooths the visible range over time: percentiles instead of extremes, the median of
// three frames, hysteresis, and an exponential approach. One invocation per view and
// frame; its state stays on the GPU.

const ORTHOGRAPHIC: u32 = 1u;
// Discard the state, unless HOLD is set: after a cut or a change of the view's size.
const SNAP: u32 = 2u;
// Keep the range as it is.
const HOLD: u32 = 4u;
// Take the median of three frames.
const DESPIKE: u32 = 8u;
// Discard the state, even with HOLD: the projection changed, and with it what raw depth
// means.
const RESET: u32 = 16u;

struct Smoothing {
    // a = clip_from_view[2][2]: d + a is proportional to 1/z in perspective. 0 otherwise.
    offset: f32,
    // Fraction of the counted depths that may be outside of the range, at each end.
    outliers: f32,
    // In octaves of distance; under an orthographic projection, as a fraction of the
    // length of the range.
    hysteresis: f32,
    // Fraction of the remaining difference that this frame makes up: 1 - exp(-dt / tau).
    expand: f32,
    shrink: f32,
    flags: u32,
}

// One end of the range. A level is log2(d + a); under an orthographic projection it is
// d itself.
struct Bound {
    // Where the bound is drawn, and the level that it approaches.
    level: f32,
    goal: f32,
    // Bits of the depth at the goal.
    goal_bits: u32,
    // 1: the goal follows the depth that is found; 0: hysteresis keeps it.
    moving: u32,
    // Bits of the depths that were found one and two frames ago.
    before: u32,
    earlier: u32,
}

struct RangeState {
    near: Bound,
    far: Bound,
    // 0: no geometry was found yet.
    valid: u32,
}

// A bin is the exponent and the upper three bits of the mantissa of a raw depth: eight
// bins per octave, 32 octaves. The farthest bin also counts everything beyond.
const BINS: u32 = 256u;
const FIRST_BIN: u32 = 761u;
const BIN_WIDTH: u32 = 1048576u;

struct Histogram {
    bins: array<u32, 256>,
    total: u32,
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

fn bin_of(bits: u32) -> u32 {
    return clamp(bits >> 20u, FIRST_BIN, FIRST_BIN + BINS - 1u) - FIRST_BIN;
}

// Bits of the depth at the nearer edge of a bin.
fn bin_edge(bin: u32) -> u32 {
    return (bin + FIRST_BIN + 1u) << 20u;
}

// log2 of a positive number. The error of the built-in function can be 2^-10 on CPU
// adapters. Speed does not matter here: one invocation per frame.
fn exact_log2(x: f32) -> f32 {
    let bits = bitcast<u32>(max(x, 1.1754944e-38));
    var exponent = f32(bits >> 23u) - 127.0;
    var m = bitcast<f32>((bits & 0x007fffffu) | 0x3f800000u);
    if m > 1.4142135 {
        m *= 0.5;
        exponent += 1.0;
    }
    // 2 atanh(s) / ln 2, |s| < 0.172.
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    var sum = 1.0 / 9.0;
    sum = sum * q + 1.0 / 7.0;
    sum = sum * q + 1.0 / 5.0;
    sum = sum * q + 1.0 / 3.0;
    sum = sum * q + 1.0;
    return exponent + s * sum * 2.885390;
}

// 2^x for x in [-126, 127]; x is clamped to that.
fn exact_exp2(x: f32) -> f32 {
    let whole = clamp(round(x), -126.0, 127.0);
    let y = (x - whole) * 0.6931472;
    var sum = 1.0 / 5040.0;
    sum = sum * y + 1.0 / 720.0;
    sum = sum * y + 1.0 / 120.0;
    sum = sum * y + 1.0 / 24.0;
    sum = sum * y + 1.0 / 6.0;
    sum = sum * y + 0.5;
    sum = sum * y + 1.0;
    sum = sum * y + 1.0;
    return sum * bitcast<f32>(u32(i32(whole) + 127) << 23u);
}

// Level of the bits of a depth.
fn level_of(s: Smoothing, bits: u32) -> f32 {
    let d = bitcast<f32>(bits);
    if (s.flags & ORTHOGRAPHIC) != 0u {
        return d;
    }
    return exact_log2(d + s.offset);
}

// Bits of the depth at a level, clamped to what the reduction can find.
fn bits_of(s: Smoothing, level: f32) -> u32 {
    var d = level;
    if (s.flags & ORTHOGRAPHIC) == 0u {
        d = exact_exp2(level) - s.offset;
    }
    return bitcast<u32>(clamp(d, 1.1754944e-38, 1.0));
}

fn median(a: u32, b: u32, c: u32) -> u32 {
    return max(min(a, b), min(max(a, b), c));
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
    let level = level_of(s, at);
    if abs(level - b.goal) > hysteresis {
        b.moving = 1u;
    }
    if b.moving == 1u {
        b.goal = level;
        b.goal_bits = at;
    }
    let rest = b.goal - b.level;
    b.level += select(s.shrink, s.expand, rest * outward > 0.0) * rest;
    if abs(b.goal - b.level) <= 0.25 * hysteresis {
        b.moving = 0u;
    }
    var settled = SETTLED;
    if (s.flags & ORTHOGRAPHIC) != 0u {
        settled = SETTLED * hysteresis;
    }
    if abs(b.goal - b.level) <= settled {
        b.level = b.goal;
    }
    return b;
}

// A bound without a past: at its goal.
fn snapped(s: Smoothing, bits: u32) -> Bound {
    let level = level_of(s, bits);
    return Bound(level, level, bits, 0u, bits, bits);
}

// Bits of the depth at which a bound is drawn: exactly those that were found, once the
// bound is at its goal.
fn bound_bits(s: Smoothing, b: Bound) -> u32 {
    if b.level == b.goal {
        return b.goal_bits;
    }
    return bits_of(s, b.level);
}

#ifdef HISTOGRAM
// Bits of the depth that `rank` of the counted depths are nearer than, interpolated
// within its bin.
fn from_near(near: u32, far: u32, rank: f32) -> u32 {
    var passed = 0.0;
    for (var bin = bin_of(near); ; bin--) {
        let count = f32(histogram.bins[bin]);
        if passed + count > rank || bin == 0u {
            let part = clamp((rank - passed) / max(count, 1.0), 0.0, 1.0);
            return clamp(bin_edge(bin) - u32(part * f32(BIN_WIDTH)), far, near);
        }
        passed += count;
    }
    return near;
}

// Bits of the depth that `rank` of the counted depths are farther than.
fn from_far(near: u32, far: u32, rank: f32) -> u32 {
    var passed = 0.0;
    for (var bin = bin_of(far); ; bin++) {
        let count = f32(histogram.bins[bin]);
        if passed + count > rank || bin == BINS - 1u {
            let part = clamp((rank - passed) / max(count, 1.0), 0.0, 1.0);
            return clamp(bin_edge(bin) - BIN_WIDTH + u32(part * f32(BIN_WIDTH)), far, near);
        }
        passed += count;
    }
    return far;
}
#endif

@compute @workgroup_size(1)
fn follow() {
    if (smoothing.flags & RESET) != 0u {
        state.valid = 0u;
    }
    let hold = (smoothing.flags & HOLD) != 0u && state.valid == 1u;
    if found.x == 0u && !hold {
        // No geometry in this frame: the state stays as it is.
        drawn = vec4(0u);
        return;
    }
    if !hold {
        var near = found.x;
        var far = 0u - found.y;
#ifdef HISTOGRAM
        let rank = smoothing.outliers * f32(histogram.total);
        let ends = vec2(near, far);
        near = from_near(ends.x, ends.y, rank);
        far = from_far(ends.x, ends.y, rank);
#endif
        if state.valid == 0u || (smoothing.flags & SNAP) != 0u {
            state.near = snapped(smoothing, near);
            state.far = snapped(smoothing, far);
            state.valid = 1u;
        } else {
            var hysteresis = smoothing.hysteresis;
            if (smoothing.flags & ORTHOGRAPHIC) != 0u {
                hysteresis *= abs(state.near.goal - state.far.goal);
            }
            state.near = follow_bound(smoothing, state.near, near, 1.0, hysteresis);
            state.far = follow_bound(smoothing, state.far, far, -1.0, hysteresis);
        }
    }
    let near = bound_bits(smoothing, state.near);
    // The bounds can cross if shrinking is faster than expanding: then far is near.
    let far = min(bound_bits(smoothing, state.far), near);
    drawn = vec4(near, 0u - far, 0u, 0u);
}
