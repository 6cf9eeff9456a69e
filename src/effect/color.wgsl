#define_import_path bevy_comics::effect::color

// Color conversions shared by the effects. Effects take and return linear
// light. The papers' formulas work on display codes (sRGB-encoded, 0 to 1), so
// the faithful equations convert inside.

// Replaces NaN and infinity. Tests the bits, since a compiler may assume that
// neither exists and remove a test such as `x != x`.
fn finite(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    if (bits & 0x7fffffffu) < 0x7f800000u {
        return x;
    }
    // +inf becomes the largest 16-bit float; NaN and -inf become 0.
    return select(0.0, 65504.0, bits == 0x7f800000u);
}

fn finite_color(c: vec3<f32>) -> vec3<f32> {
    return vec3(finite(c.r), finite(c.g), finite(c.b));
}

// Linear light to display codes: the sRGB transfer function (IEC 61966-2-1),
// extended as an odd function and without an upper bound, so that components
// outside 0 to 1 stay finite and monotone.
fn srgb_encode(c: vec3<f32>) -> vec3<f32> {
    let m = abs(c);
    let low = m * 12.92;
    let high = 1.055 * pow(max(m, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return sign(c) * select(high, low, m <= vec3(0.0031308));
}

// Display codes to linear light: the inverse of srgb_encode.
fn srgb_decode(c: vec3<f32>) -> vec3<f32> {
    let m = abs(c);
    let low = m / 12.92;
    let high = pow((max(m, vec3(0.04045)) + 0.055) / 1.055, vec3(2.4));
    return sign(c) * select(high, low, m <= vec3(0.04045));
}

// Relative luminance of linear light (ITU-R BT.709).
fn luminance(c: vec3<f32>) -> f32 {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

// Perceived lightness, 0 to 1: the square root of the luminance (Hunter 1948).
// Some adapters compute sqrt exactly but pow coarsely, which would move the steps
// between tone bands.
fn lightness(linear: vec3<f32>) -> f32 {
    return sqrt(clamp(luminance(linear), 0.0, 1.0));
}

fn largest(c: vec3<f32>) -> f32 {
    return max(c.r, max(c.g, c.b));
}

fn smallest(c: vec3<f32>) -> f32 {
    return min(c.r, min(c.g, c.b));
}

// HSV hue in [0, 1); grays have hue 0.
fn hue_of(c: vec3<f32>) -> f32 {
    let value = largest(c);
    let chroma = value - smallest(c);
    if chroma <= 0.0 {
        return 0.0;
    }
    var h: f32;
    if value == c.r {
        h = (c.g - c.b) / chroma;
    } else if value == c.g {
        h = 2.0 + (c.b - c.r) / chroma;
    } else {
        h = 4.0 + (c.r - c.g) / chroma;
    }
    h = h / 6.0;
    return select(h, h + 1.0, h < 0.0);
}

// The fully saturated color, in display codes, of an HSV hue in [0, 1).
fn hue_color(hue: f32) -> vec3<f32> {
    let p = abs(fract(vec3(hue) + vec3(1.0, 2.0 / 3.0, 1.0 / 3.0)) * 6.0 - 3.0);
    return clamp(p - 1.0, vec3(0.0), vec3(1.0));
}

// Cube root: a first guess from a third of the exponent, then two steps of
// Halley's method. The error is one or two units in the last place. Cheaper than
// pow on CPU adapters.
fn cube_root(x: f32) -> f32 {
    let m = max(abs(x), 1e-30);
    var r = bitcast<f32>(bitcast<u32>(m) / 3u + 0x2a514067u);
    for (var i = 0; i < 2; i++) {
        let c = r * r * r;
        r *= (c + 2.0 * m) / (2.0 * c + m);
    }
    return select(sign(x) * r, 0.0, x == 0.0);
}

// Linear sRGB to OKLab (Ottosson 2020): x is lightness, yz the chroma vector
// (a, b).
fn linear_to_oklab(c: vec3<f32>) -> vec3<f32> {
    let l = cube_root(dot(c, vec3(0.4122214708, 0.5363325363, 0.0514459929)));
    let m = cube_root(dot(c, vec3(0.2119034982, 0.6806995451, 0.1073969566)));
    let s = cube_root(dot(c, vec3(0.0883024619, 0.2817188376, 0.6299787005)));
    return vec3(
        0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
    );
}

// OKLab to linear sRGB.
fn oklab_to_linear(lab: vec3<f32>) -> vec3<f32> {
    let l = lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z;
    let m = lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z;
    let s = lab.x - 0.0894841775 * lab.y - 1.2914855480 * lab.z;
    let l3 = l * l * l;
    let m3 = m * m * m;
    let s3 = s * s * s;
    return vec3(
        4.0767416621 * l3 - 3.3077115913 * m3 + 0.2309699292 * s3,
        -1.2684380046 * l3 + 2.6097574011 * m3 - 0.3413193965 * s3,
        -0.0041960863 * l3 - 0.7034186147 * m3 + 1.7076147010 * s3,
    );
}

// The middle of the band that a lightness `y` falls into, of `levels` (2 or more) equal bands from
// 0 to 1. `step_width` is the width of the step between two bands in lightness; it is at most one band.
fn banded(levels: f32, y: f32, step_width: f32) -> f32 {
    let t = y * levels;
    let step = clamp(round(t), 1.0, levels - 1.0);
    // At least one display code on either side: otherwise the dither of a flat area
    // whose tone lies on a step would speckle.
    let half = 0.5 * clamp(step_width * levels, levels / 128.0, 1.0);
    return (step - 0.5 + smoothstep(step - half, step + half, t)) / levels;
}

// The same where every band has split into two `splits` times, of which there can be a fraction:
// the borders of fewer bands are borders of more bands too.
fn split_bands(levels: f32, splits: f32, y: f32, step_width: f32) -> f32 {
    let whole = floor(splits);
    let bands = levels * exp2(whole);
    let fewer = banded(bands, y, step_width);
    return mix(fewer, banded(2.0 * bands, y, step_width), smoothstep(0.0, 1.0, splits - whole));
}

// The picture, after tonemapping, in the compositing space of the camera, as linear
// light: the effects work on linear light.
fn to_linear(stored: vec3<f32>) -> vec3<f32> {
    let c = finite_color(stored);
#ifdef STORED_SRGB
    return srgb_decode(c);
#else ifdef STORED_OKLAB
    return oklab_to_linear(c);
#else
    return c;
#endif
}

// The inverse of to_linear.
fn to_stored(linear: vec3<f32>) -> vec3<f32> {
#ifdef STORED_SRGB
    return srgb_encode(linear);
#else ifdef STORED_OKLAB
    return linear_to_oklab(linear);
#else
    return linear;
#endif
}

// Moves a color towards the gray of its OKLab lightness, as little as possible, until all
// components are from 0 to 1, or within those of `before` if these are beyond.
fn in_gamut(c: vec3<f32>, lab_lightness: f32, before: vec3<f32>) -> vec3<f32> {
    let gray = vec3(lab_lightness * lab_lightness * lab_lightness);
    let low = min(vec3(min(smallest(before), 0.0)), gray);
    let high = max(vec3(max(largest(before), 1.0)), gray);
    let away = c - gray;
    let room = select(low, high, away > vec3(0.0)) - gray;
    let kept = select(vec3(1.0), room / away, abs(away) > abs(room));
    return clamp(gray + smallest(kept) * away, low, high);
}

// The tones of four inks for a color of 0 to 1 in linear light: cyan, magenta, yellow,
// black. Printed with ideal inks, they have the color as their mean. `black`: fraction of
// the darkness that all three share which is printed in black.
fn separated(c: vec3<f32>, black: f32) -> vec4<f32> {
    let light = 1.0 - black * (1.0 - largest(c));
    let per_light = 1.0 / max(light, 1e-6);
    let inks = 1.0 - min(c * per_light, vec3(1.0));
    return vec4(select(inks, vec3(0.0), light <= 1e-6), 1.0 - light);
}
