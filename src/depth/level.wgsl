#define_import_path bevy_comics::depth::level

// What the passes share that follow depths from frame to frame: their settings, and levels of
// depth. Pure functions. One invocation per view and frame, so their speed does not matter.

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
// Discard the middle: after a cut, after a change of the view's size, and after frames that did not
// need it. Set in one frame.
const BEGIN: u32 = 32u;

struct Smoothing {
    // a = clip_from_view[2][2]: d + a is proportional to 1/z in perspective. 0 otherwise.
    offset: f32,
    // Fraction of the counted depths that may be outside of the range, at each end.
    outliers: f32,
    // In octaves of distance; under an orthographic projection, as a fraction of the
    // length of the range.
    hysteresis: f32,
    // Fraction of the remaining difference that this frame makes up: 1 - exp(-dt / tau).
    // `settle` is the fraction of a bound that is SETTLING.
    expand: f32,
    shrink: f32,
    settle: f32,
    // Seconds that this frame adds to Bound::watched.
    seconds: f32,
    flags: u32,
}

// log2 of a positive number. The error of the built-in function can be 2^-10 on CPU
// adapters.
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
