#define_import_path bevy_comics::effects::colorization

// Colors the picture with an atmosphere ([CS] Eq. 8 to 11).

#import bevy_comics::depth::map::root_fraction
#import bevy_comics::effect::color::{hue_color, hue_of, largest, linear_to_oklab, oklab_to_linear, smallest, srgb_decode, srgb_encode}
#import bevy_comics::effect::pixel::Pixel

const MODE_HUE: u32 = 0u;
const MODE_ATMOSPHERE: u32 = 1u;
const MODE_LINEAR: u32 = 2u;
const MODE_SQUARE_ROOT: u32 = 3u;

struct Colorization {
    // Direction of the atmosphere's chroma in OKLab: a unit vector (a, b).
    direction: vec2<f32>,
    // Lightness of the most saturated displayable color of that hue, and the
    // chroma of the atmosphere at that lightness.
    cusp_lightness: f32,
    cusp_chroma: f32,
    // HSV hue of the atmosphere in [0, 1).
    hue: f32,
    amount: f32,
    mode: u32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn mode_of(s: Colorization) -> u32 {
#ifdef EFFECT_COLORIZATION_MODE
    return #{EFFECT_COLORIZATION_MODE}u;
#else
    return s.mode;
#endif
}

// Fraction of the atmosphere in the chroma blend, 0 to 1, from the depth map `d`
// and its complement `l`.
fn atmosphere_weight(mode: u32, d: f32, l: f32) -> f32 {
    if mode == MODE_ATMOSPHERE {
        return 1.0;
    }
    if mode == MODE_LINEAR {
        return d;
    }
    return root_fraction(d, l);
}

// Replaces the HSV hue of the display code; value and saturation stay, so grays
// stay gray. The weights of Eq. 11 sum to more than 1, as printed ([CS] Eq. 9 to
// 11).
fn faithful_colorize(s: Colorization, linear: vec3<f32>, d: f32, l: f32) -> vec3<f32> {
    let c = srgb_encode(linear);
    let value = largest(c);
    let chroma = value - smallest(c);
    var hue = s.hue;
    if mode_of(s) == MODE_LINEAR {
        hue = fract(hue_of(c) * l + s.hue * d);
    } else if mode_of(s) == MODE_SQUARE_ROOT {
        hue = fract(hue_of(c) * sqrt(max(l, 0.0)) + s.hue * sqrt(max(d, 0.0)));
    }
    let tinted = vec3(value) - chroma * (1.0 - hue_color(hue));
    return srgb_decode(mix(c, tinted, s.amount));
}

// Blends chroma vectors in OKLab and keeps the lightness: hues do not wrap round,
// opposite hues meet in gray, and grays take the atmosphere too. `saturation` is
// the fraction that Desaturation has left; MODE_ATMOSPHERE, which does not depend
// on distance itself, scales the atmosphere by it.
fn colorize(s: Colorization, linear: vec3<f32>, d: f32, l: f32, saturation: f32) -> vec3<f32> {
    if mode_of(s) == MODE_HUE {
        return linear;
    }
#ifdef EFFECT_COLORIZATION_FAITHFUL
    return faithful_colorize(s, linear, d, l);
#else
    let lab = linear_to_oklab(linear);
    let room = min(lab.x / s.cusp_lightness, (1.0 - lab.x) / (1.0 - s.cusp_lightness));
    var atmosphere = s.direction * (s.cusp_chroma * clamp(room, 0.0, 1.0));
    if mode_of(s) == MODE_ATMOSPHERE {
        atmosphere *= saturation;
    }
    let w = s.amount * atmosphere_weight(mode_of(s), d, l);
    let chroma = lab.yz * (1.0 - w) + atmosphere * w;
    return oklab_to_linear(vec3(lab.x, chroma));
#endif
}

fn colorization(s: Colorization, p: Pixel) -> Pixel {
    var out = p;
    let opacity = max(p.alpha, 1e-3);
    out.color = colorize(s, p.color / opacity, p.depth.x, p.depth.y, p.saturation) * opacity;
    return out;
}
