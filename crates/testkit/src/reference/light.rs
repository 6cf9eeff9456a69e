//! Reference of `toon/light.wgsl`.

use super::smoothstep;
use bevy_comics::ToonLight;

/// A smooth step from 0 to 1, `width` wide, with its middle at `edge`.
pub fn edge_at(edge: f64, x: f64, width: f64) -> f64 {
    let half = (0.5 * width).max(1e-5);
    smoothstep(edge - half, edge + half, x)
}

/// The microfacet distribution of Trowbridge and Reitz (GGX) as a fraction of its
/// peak. `roughness`: the square of the perceptual roughness.
pub fn highlight_fraction(roughness: f64, n_dot_h: f64) -> f64 {
    let a2 = roughness * roughness;
    let d = |c: f64| a2 / (std::f64::consts::PI * ((1.0 - c * c) + a2 * c * c).powi(2));
    d(n_dot_h) / d(1.0)
}

/// Strength of the highlight. `width`: change of `n_dot_h` over a pixel.
pub fn highlight(s: &ToonLight, perceptual_roughness: f64, n_dot_h: f64, width: f64) -> f64 {
    let roughness = (perceptual_roughness * perceptual_roughness).max(0.002);
    let fraction = |c: f64| highlight_fraction(roughness, c.clamp(0.0, 1.0));
    let change = fraction(n_dot_h + 0.5 * width) - fraction(n_dot_h - 0.5 * width);
    let polish = (1.0 - 1.4 * perceptual_roughness).max(0.0);
    f64::from(s.highlight)
        * polish
        * polish
        * edge_at(f64::from(s.highlight_edge), fraction(n_dot_h), change)
}

/// Attenuation of a point light at a squared distance, in rings of constant light.
/// `brightest`: exposed light at distance 1; `pixel`: size of a pixel at the lit
/// place, world units.
pub fn flat_falloff(
    s: &ToonLight,
    distance_squared: f64,
    inverse_range_squared: f64,
    brightest: f64,
    pixel: f64,
) -> f64 {
    let end = (1.0 - (distance_squared * inverse_range_squared).powi(2)).clamp(0.0, 1.0);
    let smooth = end * end / distance_squared.max(1e-4);
    let step = f64::from(s.falloff);
    if step <= 0.0 || smooth <= 0.0 {
        return smooth;
    }
    let rings = (smooth * brightest).max(1e-30).log2() / step;
    let width = 2.0 * pixel / distance_squared.max(1e-8).sqrt() / std::f64::consts::LN_2 / step;
    let border = rings.round();
    let level = border - 1.0 + edge_at(border, rings, width);
    if level < -7.0 {
        return 0.0;
    }
    ((level * step).exp2() / brightest.max(1e-30)).min(1e4)
}
