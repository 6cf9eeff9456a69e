#define_import_path bevy_comics::effects::color_harmony

// Moves colors to the other side of the wheel of hues, or to two hues that lie opposite each
// other.

#import bevy_comics::depth::map::root_fraction
#import bevy_comics::effect::color::{
    hue_color, hue_of, in_gamut, largest, linear_to_oklab, oklab_to_linear, smallest, srgb_decode, srgb_encode,
}
#import bevy_comics::effect::pixel::Pixel

const MODE_TWO_HUES: u32 = 0u;
const MODE_DISTANCE: u32 = 1u;
const MODE_ROTATION: u32 = 2u;
const MODE_SHADE: u32 = 3u;

const HALF_TURN: f32 = 3.1415927;

struct ColorHarmony {
    // Direction of one of the two hues in OKLab: a unit vector (a, b), or 0 if there is none.
    hue: vec2<f32>,
    complement: f32,
    shade: f32,
    pull: f32,
    offset: f32,
    amount: f32,
    mode: u32,
    square_root: u32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn mode_of(s: ColorHarmony) -> u32 {
#ifdef EFFECT_COLOR_HARMONY_MODE
    return #{EFFECT_COLOR_HARMONY_MODE}u;
#else
    return s.mode;
#endif
}

fn is_square_root(s: ColorHarmony) -> bool {
#ifdef EFFECT_COLOR_HARMONY_SQUARE_ROOT
    let compiled = #{EFFECT_COLOR_HARMONY_SQUARE_ROOT}u;
    return compiled != 0u;
#else
    return s.square_root != 0u;
#endif
}

// How far a color is on its way to its complement, 0 to 1, from its lightness (0 black, 1
// white), the depth map `d` and its complement `l`.
fn complement_weight(s: ColorHarmony, lightness: f32, d: f32, l: f32) -> f32 {
    if mode_of(s) == MODE_SHADE {
        let dark = 1.0 - clamp(lightness, 0.0, 1.0);
        return s.shade * dark * dark;
    }
    if is_square_root(s) {
        return root_fraction(d, l);
    }
    return d;
}

// The chroma vector that takes the place of the one of `lab`.
fn harmonized_chroma(s: ColorHarmony, lab: vec3<f32>, d: f32, l: f32) -> vec2<f32> {
    let chroma = lab.yz;
    if mode_of(s) == MODE_TWO_HUES {
        let along = s.hue * dot(chroma, s.hue);
        return along + (1.0 - s.pull) * (chroma - along) + s.offset * (l - d) * s.hue;
    }
    let w = complement_weight(s, lab.x, d, l);
    if mode_of(s) == MODE_ROTATION {
        let c = cos(HALF_TURN * w);
        let n = sin(HALF_TURN * w);
        return vec2(c * chroma.x - n * chroma.y, n * chroma.x + c * chroma.y);
    }
    // mix(chroma, -complement * chroma, w), through gray.
    return chroma * (1.0 - w * (1.0 + s.complement));
}

// Turns the HSV hue by at most half a turn: the complement in the form of [CS] Eq. 9 to 11.
// Value and saturation stay, so grays stay gray.
fn faithful_harmonize(s: ColorHarmony, linear: vec3<f32>, d: f32, l: f32) -> vec3<f32> {
    let c = srgb_encode(linear);
    let value = largest(c);
    let chroma = value - smallest(c);
    let hue = fract(hue_of(c) + 0.5 * complement_weight(s, value, d, l));
    let turned = vec3(value) - chroma * (1.0 - hue_color(hue));
    return srgb_decode(mix(c, turned, s.amount));
}

// Changes the chroma in OKLab and keeps the lightness. A color inside the display's gamut
// stays inside, and one outside of it does not get farther out.
fn harmonize(s: ColorHarmony, linear: vec3<f32>, d: f32, l: f32) -> vec3<f32> {
#ifdef EFFECT_COLOR_HARMONY_FAITHFUL
    if mode_of(s) != MODE_TWO_HUES {
        return faithful_harmonize(s, linear, d, l);
    }
#endif
    let lab = linear_to_oklab(linear);
    let chroma = mix(lab.yz, harmonized_chroma(s, lab, d, l), s.amount);
    let changed = in_gamut(oklab_to_linear(vec3(lab.x, chroma)), lab.x, linear);
    // Without the rounding of the conversions.
    let keeps_grays = mode_of(s) != MODE_TWO_HUES || s.offset == 0.0;
    return select(changed, linear, keeps_grays && largest(linear) == smallest(linear));
}

fn color_harmony(s: ColorHarmony, p: Pixel) -> Pixel {
    var out = p;
    // The lightness of what is seen, not of what is left of it at the edge of an object.
    let opacity = max(p.alpha, 1e-3);
    out.color = harmonize(s, p.color / opacity, p.depth.x, p.depth.y) * opacity;
    return out;
}
