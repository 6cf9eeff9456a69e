#define_import_path bevy_comics::tones

// Tones of a picture: as numbers that the reduction of the depth range counts and its smoothing follows, and
// brought into a range. The only module that declares binding 34.

#import bevy_comics::effect::color::{finite, luminance, to_linear}

// The luminance divided by the largest that a picture has takes the place of raw depth: light is near, dark is
// far. 2^-16, because half floats end below 2^16; a power of two loses no digits.
const UNIT: f32 = 1.52587890625e-5;
// What is darker than this luminance is black, which does not count. The darkest gray of 8 bits is twenty times as
// light.
const BLACK: f32 = 1.52587890625e-5;

// The bits of that number for a pixel as it is stored; 0 where it is black or the background shows through.
fn tone_key(stored: vec4<f32>) -> u32 {
    let alpha = clamp(finite(stored.a), 0.0, 1.0);
    let light = luminance(to_linear(stored.rgb)) / max(alpha, 1e-3);
    if alpha < 0.5 || !(light >= BLACK) {
        return 0u;
    }
    return bitcast<u32>(min(light * UNIT, 1.0));
}

struct ToneRange {
    // Lightness that the percentiles are brought to.
    dark: f32,
    light: f32,
    // Largest factor of lightness.
    max_gain: f32,
    amount: f32,
}

var<private> tone_range: ToneRange;

fn set_tone_range(range: ToneRange) {
    tone_range = range;
}

#ifdef TONE_RANGE
// As VisibleRange::keys of depth/view.wgsl.
@group(0) @binding(34) var<uniform> tone_keys: vec4<u32>;
#endif

// Square roots of the luminances that some of the picture is darker than, and lighter than; 0 if all of it is
// black.
fn tone_percentiles() -> vec2<f32> {
#ifdef TONE_RANGE
    if tone_keys.x == 0u {
        return vec2(0.0);
    }
    return sqrt(bitcast<vec2<f32>>(vec2(0u - tone_keys.y, tone_keys.x)) / UNIT);
#else
    return vec2(0.0);
#endif
}

// The factor of lightness, and what is added to it. `found`: the percentiles.
fn tone_line(s: ToneRange, found: vec2<f32>) -> vec2<f32> {
    if found.y <= 0.0 {
        return vec2(1.0, 0.0);
    }
    // What is darker would not reach `dark` by the largest gain. With it, nothing is lifted: black stays black.
    let low = max(found.x, s.dark / s.max_gain);
    let high = max(found.y, low);
    let gain = min((s.light - s.dark) / max(high - low, 1e-6), s.max_gain);
    // Where that is the limit, there is room left: the middle moves no farther than it must.
    let half = 0.5 * gain * (high - low);
    let middle = 0.5 * (low + high);
    let moved = max(min(middle, s.light - half), s.dark + half);
    return vec2(gain, moved - gain * middle);
}

// A color of linear light. `line`: see tone_line.
fn on_tone_line(line: vec2<f32>, color: vec3<f32>) -> vec3<f32> {
    let light = max(luminance(color), 0.0);
    let before = sqrt(light);
    let after = max(line.x * before + line.y, 0.0);
    // The hue of what is nearly black is noise: what lifts it is gray.
    let ratio = min(after / max(before, 1e-6), line.x);
    let factor = ratio * ratio;
    return color * factor + (after * after - factor * light);
}

// The factor of changes of lightness.
fn tone_gain() -> f32 {
    return mix(1.0, tone_line(tone_range, tone_percentiles()).x, tone_range.amount);
}

// A picture in the range: linear light multiplied by its opacity, from that and the opacity.
fn in_tone_range(picture: vec4<f32>) -> vec3<f32> {
    let alpha = max(picture.a, 1e-3);
    let line = tone_line(tone_range, tone_percentiles());
    let brought = on_tone_line(line, picture.rgb / alpha) * picture.a;
    // Light that is added to what is behind has no opacity, and stays as it is.
    return mix(picture.rgb, brought, tone_range.amount * min(1e3 * picture.a, 1.0));
}
