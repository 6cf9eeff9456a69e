#define_import_path bevy_comics::effects::tone_ramp

// Three tones by the lightness of the picture, which change with depth (Barla, Thollot and
// Markosian 2006).

#import bevy_comics::effect::color::{largest, lightness, linear_to_oklab, oklab_to_linear}
#import bevy_comics::effect::pixel::Pixel

struct ToneRamp {
    // OKLab: near, and far away.
    dark: vec3<f32>,
    middle_at: f32,
    middle: vec3<f32>,
    light_at: f32,
    light: vec3<f32>,
    softness: f32,
    distant_dark: vec3<f32>,
    distant_middle_at: f32,
    distant_middle: vec3<f32>,
    distant_light_at: f32,
    distant_light: vec3<f32>,
    distant_softness: f32,
    // Place in the depth map with all detail, and how far from it there is none.
    focus: f32,
    reach: f32,
    keep_color: f32,
    amount: f32,
}

// How much of the near tones there is at a place of the depth map and its complement.
fn tone_detail(s: ToneRamp, depth: vec2<f32>) -> f32 {
    // Exact at the far end.
    let behind = (1.0 - s.focus) - depth.y;
    let away = select(behind, s.focus - depth.x, depth.x < s.focus);
    return 1.0 - clamp(away / s.reach, 0.0, 1.0);
}

fn mixed_tone(near: vec3<f32>, distant: vec3<f32>, detail: f32) -> vec3<f32> {
    return max(oklab_to_linear(mix(distant, near, detail)), vec3(0.0));
}

fn tone_edge(at: f32, y: f32, width: f32) -> f32 {
    return smoothstep(at - 0.5 * width, at + 0.5 * width, y);
}

// The tone of a lightness `y`, which changes by `change` over a pixel.
fn ramp_tone(s: ToneRamp, y: f32, change: f32, detail: f32) -> vec3<f32> {
    // At least eight display codes, so that the dither of a flat area does not speckle.
    let width = max(mix(s.distant_softness, s.softness, detail), max(change, 8.0 / 255.0));
    let middle = tone_edge(mix(s.distant_middle_at, s.middle_at, detail), y, width);
    let light = tone_edge(mix(s.distant_light_at, s.light_at, detail), y, width);
    let below = mix(
        mixed_tone(s.dark, s.distant_dark, detail),
        mixed_tone(s.middle, s.distant_middle, detail),
        middle,
    );
    return mix(below, mixed_tone(s.light, s.distant_light, detail), light);
}

// The picture in tones. Some of the color of things is kept: that of their brightest light.
fn toned(s: ToneRamp, linear: vec3<f32>, change: f32, detail: f32) -> vec3<f32> {
    let tone = ramp_tone(s, lightness(linear), change, detail);
    let brightest = largest(linear);
    let own = select(vec3(1.0), linear / max(brightest, 1e-6), brightest > 1e-6);
    return mix(linear, tone * mix(vec3(1.0), own, s.keep_color), s.amount);
}

fn tone_ramp(s: ToneRamp, p: Pixel) -> Pixel {
    var out = p;
    let opacity = max(p.alpha, 1e-3);
    let tones = toned(s, max(p.color / opacity, vec3(0.0)), p.change, tone_detail(s, p.depth));
    // Light that is added to what is behind has no opacity, and stays as it is.
    out.color = mix(p.color, tones * p.alpha, min(1e3 * p.alpha, 1.0));
    return out;
}
