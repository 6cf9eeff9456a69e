#define_import_path bevy_comics::effects::tone_bands

// Divides the picture into areas of uniform tone ([CL] 3.1, Eq. 6).

#import bevy_comics::effect::color::{banded, largest, lightness, luminance, split_bands, srgb_decode, srgb_encode}
#import bevy_comics::effect::pixel::Pixel

struct ToneBands {
    // Number of bands; the faithful equations always have three.
    levels: f32,
    // Width of the step between two bands, physical pixels.
    softness: f32,
    amount: f32,
}

// Compresses one channel of a display code in three ranges ([CL] Eq. 6, without its
// gaps at 0.33 and 0.66).
fn equation_6(c: f32) -> f32 {
    if c < 0.33 {
        return c / 1.5;
    }
    if c < 0.66 {
        return 0.33 + (c - 0.33) / 2.0;
    }
    return 0.66 + (c - 0.66) / 2.0;
}

// The middle of the band that a lightness `y` falls into, 0 to 1. `change` is the
// change of the lightness over a pixel. The step between two bands is `softness`
// pixels wide, and at most one band. `splits`: how often bands have split.
fn band_tone(s: ToneBands, y: f32, change: f32, splits: f32) -> f32 {
    // A constant without an effect that splits them.
    if splits == 0.0 {
        return banded(s.levels, y, s.softness * change);
    }
    return split_bands(s.levels, splits, y, s.softness * change);
}

// The color with another luminance and the same chromaticity. If the display cannot
// show it, it is mixed with gray of that luminance until it can.
fn with_luminance(linear: vec3<f32>, target_luminance: f32) -> vec3<f32> {
    let y = luminance(linear);
    let gray = vec3(target_luminance);
    if y < 1e-6 {
        return gray;
    }
    let scaled = linear * (target_luminance / y);
    let over = largest(scaled) - 1.0;
    if over <= 0.0 {
        return scaled;
    }
    let room = clamp((1.0 - target_luminance) / max(largest(scaled) - target_luminance, 1e-6), 0.0, 1.0);
    return mix(gray, scaled, room);
}

fn banded_color(s: ToneBands, linear: vec3<f32>, change: f32, splits: f32) -> vec3<f32> {
#ifdef EFFECT_TONE_BANDS_FAITHFUL
    let c = srgb_encode(linear);
    let banded = srgb_decode(vec3(equation_6(c.r), equation_6(c.g), equation_6(c.b)));
#else
    let tone = band_tone(s, lightness(linear), change, splits);
    let banded = with_luminance(linear, tone * tone);
#endif
    return mix(linear, banded, s.amount);
}

fn tone_bands(s: ToneBands, p: Pixel) -> Pixel {
    var out = p;
    let banded = banded_color(s, p.color / max(p.alpha, 1e-3), p.change, p.splits) * p.alpha;
    // Light that is added to what is behind has no opacity, and stays as it is.
    out.color = mix(p.color, banded, min(1e3 * p.alpha, 1.0));
    return out;
}

// The debug view, in display codes: the lightness after banding.
fn tone_bands_view(s: ToneBands, p: Pixel) -> vec3<f32> {
    return vec3(clamp(lightness(p.color), 0.0, 1.0));
}
