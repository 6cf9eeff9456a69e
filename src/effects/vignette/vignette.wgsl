#define_import_path bevy_comics::effects::vignette

// Mixes a color into the corners of the picture.

#import bevy_comics::effect::pixel::Pixel

struct Vignette {
    color: vec3<f32>,
    amount: f32,
    // 2 / size of the viewport in physical pixels.
    scale: vec2<f32>,
    // Distances from the center at which the color begins and is complete, as
    // fractions of the distance to the corners.
    low: f32,
    high: f32,
}

// Fraction of the color in the mix at a place, in physical pixels from the
// viewport's top left corner.
fn vignette_cover(s: Vignette, at: vec2<f32>) -> f32 {
    let from_center = at * s.scale - 1.0;
    let distance = length(from_center) / sqrt(2.0);
    return s.amount * smoothstep(s.low, s.high, distance);
}

fn vignette(s: Vignette, p: Pixel) -> Pixel {
    var out = p;
    // Nothing is added where the background shows through.
    out.color = mix(p.color, s.color * p.alpha, vignette_cover(s, p.inside + 0.5));
    return out;
}
