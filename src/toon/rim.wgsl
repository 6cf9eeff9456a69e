#define_import_path bevy_comics::toon::rim

// Light along the borders of things: pure functions.

#import bevy_comics::toon::light::edge_at

struct Rim {
    // Linear light.
    color: vec3<f32>,
    strength: f32,
    // Facing rims: how far from the border, as 1 minus the cosine between normal and eye.
    begin: f32,
    softness: f32,
    // Rims of constant width: pixels, or page pixels.
    pixels: f32,
    // 0: all around; 1: only on the side of the brightest light.
    lit_side: f32,
}

// How much of the rim there is on a side: `cosine` is that between normal and light.
fn rim_side(r: Rim, cosine: f32) -> f32 {
    return mix(1.0, smoothstep(-0.2, 0.4, cosine), r.lit_side);
}

// A rim where the surface turns away from the eye. `cosine` is that between normal and eye,
// `width` its change over a pixel.
fn facing_rim(r: Rim, cosine: f32, width: f32) -> f32 {
    return edge_at(r.begin, 1.0 - abs(cosine), max(width, r.softness));
}

// Whether what lies beside a surface is farther away. `ratio` is its distance over that of the
// surface, `slope` by how much the surface recedes up to there, over its distance: near its border
// a ball recedes by twice that.
fn is_behind(ratio: f32, slope: f32) -> f32 {
    let own = 2.5 * max(slope, 0.0);
    return smoothstep(1.01 + own, 1.03 + own, ratio);
}
