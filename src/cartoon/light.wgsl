#define_import_path bevy_comics::cartoon::light

// The light of the cartoon material: pure functions.

struct CartoonLight {
    // Cosine at which the backface shadow begins.
    terminator: f32,
    // How much each kind of shadow takes away, 0 to 1.
    backface: f32,
    projected: f32,
    highlight: f32,
    highlight_edge: f32,
    // Stops between two rings; 0: smooth.
    falloff: f32,
}

// An edge one pixel wide where `x` passes `edge`; `width` is how much x changes
// over a pixel.
fn edge_at(edge: f32, x: f32, width: f32) -> f32 {
    let half_width = max(0.5 * width, 1e-5);
    return smoothstep(edge - half_width, edge + half_width, x);
}

// Whether a surface faces a light: 1 or 0, and the pixel in between.
fn facing(s: CartoonLight, cosine: f32, width: f32) -> f32 {
    return edge_at(s.terminator, cosine, width);
}

// How much a filtered shadow changes over a pixel, from its neighbours'.
fn slope_over_pixel(here: f32, beside: f32, below: f32) -> f32 {
    return abs(beside - here) + abs(below - here);
}

// A filtered shadow as a hard one: its edge lies where half the light arrives.
fn sharpen(shadow: f32, width: f32) -> f32 {
    return edge_at(0.5, shadow, width);
}

// The share of its peak that a highlight has at this angle: the microfacet
// distribution of Trowbridge and Reitz over its maximum.
fn highlight_share(roughness: f32, n_dot_h: f32) -> f32 {
    let a2 = roughness * roughness;
    let f = (1.0 - n_dot_h * n_dot_h) + a2 * n_dot_h * n_dot_h;
    let r = a2 / max(f, 1e-12);
    return r * r;
}

// A hard-edged highlight. Rough surfaces have a large and faint one.
// `width` is how much the cosine changes over a pixel.
fn highlight(s: CartoonLight, perceptual_roughness: f32, n_dot_h: f32, width: f32) -> f32 {
    let roughness = max(perceptual_roughness * perceptual_roughness, 0.002);
    let inner = highlight_share(roughness, min(n_dot_h + 0.5 * width, 1.0));
    let outer = highlight_share(roughness, max(n_dot_h - 0.5 * width, 0.0));
    let share = highlight_share(roughness, n_dot_h);
    // A matt surface has no edge to its highlight, so it has none.
    let polish = max(1.0 - 1.4 * perceptual_roughness, 0.0);
    return s.highlight * polish * polish * edge_at(s.highlight_edge, share, inner - outer);
}

// Light left at a distance: the inverse square with the engine's soft end, in
// steps of `falloff` stops below what the camera is exposed for. `brightest` is
// the exposed light at distance one, `pixel` the size of a pixel there.
fn flat_falloff(s: CartoonLight, distance_squared: f32, inverse_range_squared: f32, brightest: f32, pixel: f32) -> f32 {
    let factor = distance_squared * inverse_range_squared;
    let end = clamp(1.0 - factor * factor, 0.0, 1.0);
    let smooth_light = end * end / max(distance_squared, 1e-4);
    if s.falloff <= 0.0 || smooth_light <= 0.0 {
        return smooth_light;
    }
    // Seven steps down there is nothing left to see.
    let stops = log2(max(smooth_light * brightest, 1e-30)) / s.falloff;
    let lowest = -7.0;
    // Two stops for every doubling of the distance.
    let width = 2.0 * pixel * inverseSqrt(max(distance_squared, 1e-8)) * 1.442695 / s.falloff;
    let step = round(stops);
    let above = edge_at(step, stops, width);
    let level = step - 1.0 + above;
    let kept = select(exp2(level * s.falloff) / max(brightest, 1e-30), 0.0, level < lowest);
    return min(kept, 1e4);
}

// Inside a spot light's cone: its penumbra as a hard edge. `inside` runs from 0
// at the outer to 1 at the inner angle.
fn cone(inside: f32, width: f32) -> f32 {
    return edge_at(0.5, inside, width);
}
