#define_import_path bevy_comics::effects::desaturation

// Colours fade with distance ([CS] Eq. 5 to 7).

#import bevy_comics::effect::color::{largest, luminance, srgb_decode, srgb_encode}
#import bevy_comics::effect::pixel::Pixel

const CURVE_LINEAR: u32 = 0u;
const CURVE_ROOT: u32 = 1u;
const CURVE_POWER: u32 = 2u;

struct Desaturation {
    amount: f32,
    exponent: f32,
    // How the exponent is applied: CURVE_LINEAR, CURVE_ROOT or CURVE_POWER.
    curve: u32,
    faithful: u32,
}

// Modes are compiled in where they are known: see has() in map.wgsl.
fn curve_of(s: Desaturation) -> u32 {
#ifdef DESATURATION_CURVE
    return #{DESATURATION_CURVE}u;
#else
    return s.curve;
#endif
}

fn is_faithful(s: Desaturation) -> bool {
#ifdef DESATURATION_FAITHFUL
    let compiled = #{DESATURATION_FAITHFUL}u;
    return compiled != 0u;
#else
    return s.faithful != 0u;
#endif
}

// What is left of the saturation: Eq. 6 (exponent 1) and Eq. 7 (exponent 1/2),
// from the complement L of the depth map, which keeps its relative precision
// where 1 - D would have none.
fn saturation_left(s: Desaturation, l: f32) -> f32 {
    var k = l;
    let curve = curve_of(s);
    if curve == CURVE_ROOT {
        k = sqrt(max(l, 0.0));
    } else if curve == CURVE_POWER {
        k = select(pow(max(l, 1e-30), s.exponent), 0.0, l <= 0.0);
    }
    return 1.0 - s.amount * (1.0 - k);
}

// Eq. 5-7. Faithful: towards the value V of the display code. Corrected:
// towards the luminance of the light, so that nothing grows brighter.
fn desaturate(s: Desaturation, linear: vec3<f32>, k: f32) -> vec3<f32> {
    if is_faithful(s) {
        let c = srgb_encode(linear);
        let value = vec3(largest(c));
        return srgb_decode(value * (1.0 - k) + c * k);
    }
    let grey = vec3(luminance(linear));
    return grey * (1.0 - k) + linear * k;
}

fn desaturation(s: Desaturation, p: Pixel) -> Pixel {
    var out = p;
    out.saturation = saturation_left(s, p.depth.y);
    out.color = desaturate(s, p.color, out.saturation);
    return out;
}
