#define_import_path bevy_comics::effects::two_tone

// Paints the picture with two colors, divided by lightness.

#import bevy_comics::effect::color::luminance
#import bevy_comics::effect::pixel::Pixel

struct TwoTone {
    dark: vec3<f32>,
    threshold: f32,
    light: vec3<f32>,
    // Width of the edge between the tones, physical pixels.
    softness: f32,
    amount: f32,
}

// Fraction of the light tone at a lightness. `change`: change of the lightness over a pixel.
fn light_fraction(s: TwoTone, y: f32, change: f32) -> f32 {
    // Flat areas are as good as never in between.
    let half = max(0.5 * s.softness * change, 1e-4);
    // At the thresholds 0 and 1 everything is light or dark.
    let threshold = mix(-half, 1.0 + half, s.threshold);
    return smoothstep(threshold - half, threshold + half, y);
}

// Fraction of the light tone where ink was drawn over a picture: the luminance `before` and
// `after` the ink. How much of the pixel is ink follows from the light that it takes away or
// adds, so that lines keep their smooth edges.
fn inked_light_fraction(s: TwoTone, before: f32, after: f32, change: f32) -> f32 {
    let light = light_fraction(s, sqrt(before), change);
    // Ink is rarely quite black or white: what is nearly covered is all ink.
    let taken = min(1.15 * (before - after) / max(before, 1e-4), 1.0);
    let added = min(1.15 * (after - before) / max(1.0 - before, 1e-4), 1.0);
    return select(mix(light, 1.0, added), light * (1.0 - taken), after < before);
}

fn two_tone(s: TwoTone, p: Pixel) -> Pixel {
    let opacity = max(p.alpha, 1e-3);
    let before = clamp(luminance(p.colored / opacity), 0.0, 1.0);
    let after = clamp(luminance(p.color / opacity), 0.0, 1.0);
    let tone = mix(s.dark, s.light, inked_light_fraction(s, before, after, p.change));
    var out = p;
    // Nothing is added where the background shows through.
    out.color = mix(p.color, tone * p.alpha, s.amount);
    return out;
}
