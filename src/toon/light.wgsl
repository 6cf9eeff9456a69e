#define_import_path bevy_comics::toon::light

// The lighting of the toon material: pure functions.

struct ToonLight {
    // Cosine of the angle between normal and light at which the form shadow
    // begins.
    shadow_threshold: f32,
    // Fraction of a light that the form shadow and the cast shadow remove.
    form_shadow: f32,
    cast_shadow: f32,
    // Strength of the highlights, 0 to 4.
    highlight: f32,
    // Fraction of its peak at which a highlight ends.
    highlight_edge: f32,
    // Stops between two rings of light; 0: no rings.
    falloff: f32,
    // 0: light of environments as it is; 1: in two tones.
    environment: f32,
}

// 0 where `x` is below `edge`, 1 above, with a transition one pixel wide. `width` is
// the change of `x` over a pixel.
fn edge_at(edge: f32, x: f32, width: f32) -> f32 {
    let half_width = max(0.5 * width, 1e-5);
    return smoothstep(edge - half_width, edge + half_width, x);
}

// 1 where a surface faces a light, 0 where it faces away. `cosine` is that of the
// angle between normal and light, `width` its change over a pixel.
fn facing(s: ToonLight, cosine: f32, width: f32) -> f32 {
    return edge_at(s.shadow_threshold, cosine, width);
}

// Change of a filtered shadow over a pixel, from the shadow at the pixel and at two
// neighbors.
fn slope_over_pixel(here: f32, beside: f32, below: f32) -> f32 {
    return abs(beside - here) + abs(below - here);
}

// Turns a filtered shadow (0 dark, 1 lit) into a hard one, whose edge is where half
// of the light arrives.
fn sharpen(shadow: f32, width: f32) -> f32 {
    return edge_at(0.5, shadow, width);
}

// A highlight at an angle, as a fraction of its peak: the microfacet distribution of
// Trowbridge and Reitz, divided by its maximum. `n_dot_h` is the cosine between the
// normal and the half vector.
fn highlight_fraction(roughness: f32, n_dot_h: f32) -> f32 {
    let a2 = roughness * roughness;
    let f = (1.0 - n_dot_h * n_dot_h) + a2 * n_dot_h * n_dot_h;
    let r = a2 / max(f, 1e-12);
    return r * r;
}

// A highlight with a hard edge; that of a rough surface is large and faint. `width`
// is the change of `n_dot_h` over a pixel.
fn highlight(s: ToonLight, perceptual_roughness: f32, n_dot_h: f32, width: f32) -> f32 {
    let roughness = max(perceptual_roughness * perceptual_roughness, 0.002);
    let inner = highlight_fraction(roughness, min(n_dot_h + 0.5 * width, 1.0));
    let outer = highlight_fraction(roughness, max(n_dot_h - 0.5 * width, 0.0));
    let fraction = highlight_fraction(roughness, n_dot_h);
    // A matt surface has no highlight: it would have no visible edge.
    let polish = max(1.0 - 1.4 * perceptual_roughness, 0.0);
    return s.highlight * polish * polish * edge_at(s.highlight_edge, fraction, inner - outer);
}

// Light of a point at a distance, as a multiple of the light at distance 1: the inverse
// square with the engine's smooth end at the light's range.
fn smooth_falloff(distance_squared: f32, inverse_range_squared: f32) -> f32 {
    let factor = distance_squared * inverse_range_squared;
    let end = clamp(1.0 - factor * factor, 0.0, 1.0);
    return end * end / max(distance_squared, 1e-4);
}

// Rounds light down to whole steps of `falloff` stops. Step 0 is an exposed light of 1.
// `brightest` is the exposed light where `smooth_light` is 1, `width` the change of stops
// over a pixel.
fn rings(s: ToonLight, smooth_light: f32, brightest: f32, width: f32) -> f32 {
    if s.falloff <= 0.0 || smooth_light <= 0.0 {
        return smooth_light;
    }
    let stops = log2(max(smooth_light * brightest, 1e-30)) / s.falloff;
    // Light more than seven steps down is not visible.
    let lowest = -7.0;
    let step = round(stops);
    let above = edge_at(step, stops, width / s.falloff);
    let level = step - 1.0 + above;
    let kept = select(exp2(level * s.falloff) / max(brightest, 1e-30), 0.0, level < lowest);
    return min(kept, 1e4);
}

// Change of stops over a pixel at a distance from a light: light loses two stops with
// every doubling of the distance. `pixel` is the size of a pixel in world units.
fn stops_over_pixel(distance_squared: f32, pixel: f32) -> f32 {
    return 2.0 * pixel * inverseSqrt(max(distance_squared, 1e-8)) * 1.442695;
}

// 1 inside the cone of a spot light, 0 outside: the middle of the penumbra becomes a
// hard edge. `inside` is 0 at the outer angle and 1 at the inner angle, `width` its
// change over a pixel.
fn cone(inside: f32, width: f32) -> f32 {
    return edge_at(0.5, inside, width);
}
