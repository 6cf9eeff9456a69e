#define_import_path bevy_comics::effects::desaturation

// Removes saturation with distance ([CS] Eq. 5 to 7).

#import bevy_comics::effect::color::{largest, luminance, srgb_decode, srgb_encode}
#import bevy_comics::effect::pixel::Pixel

const CURVE_LINEAR: u32 = 0u;
const CURVE_ROOT: u32 = 1u;
const CURVE_POWER: u32 = 2u;

struct Desaturation {
    amount: f32,
    amount_near: f32,
    exponent: f32,
    // Formula of the exponent: CURVE_LINEAR (1), CURVE_ROOT (0.5) or CURVE_POWER
    // (any).
    curve: u32,
}

// A constant where the pass defines it: see has() in map.wgsl.
fn curve_of(s: Desaturation) -> u32 {
#ifdef EFFECT_DESATURATION_CURVE
    return #{EFFECT_DESATURATION_CURVE}u;
#else
    return s.curve;
#endif
}

// Fraction of the saturation that remains, from the complement `l` of the depth map,
// which is precise where 1 - D would lose its digits ([CS] Eq. 6 with exponent 1,
// Eq. 7 with 0.5).
fn saturation_left(s: Desaturation, l: f32) -> f32 {
    var k = l;
    let curve = curve_of(s);
    if curve == CURVE_ROOT {
        k = sqrt(max(l, 0.0));
    } else if curve == CURVE_POWER {
        k = select(pow(max(l, 1e-30), s.exponent), 0.0, l <= 0.0);
    }
    return 1.0 - mix(s.amount_near, s.amount, 1.0 - k);
}

// Mixes a color with gray; `k` is the fraction of the saturation that remains. The
// gray has the same luminance or, with the faithful equations, the same HSV value, which
// makes colors brighter ([CS] Eq. 5).
fn desaturate(s: Desaturation, linear: vec3<f32>, k: f32) -> vec3<f32> {
#ifdef EFFECT_DESATURATION_FAITHFUL
    let c = srgb_encode(linear);
    let value = vec3(largest(c));
    return srgb_decode(value * (1.0 - k) + c * k);
#else
    let gray = vec3(luminance(linear));
    return gray * (1.0 - k) + linear * k;
#endif
}

fn desaturation(s: Desaturation, p: Pixel) -> Pixel {
    var out = p;
    out.saturation = saturation_left(s, p.depth.y);
    let opacity = max(p.alpha, 1e-3);
    out.color = desaturate(s, p.color / opacity, out.saturation) * opacity;
    return out;
}
