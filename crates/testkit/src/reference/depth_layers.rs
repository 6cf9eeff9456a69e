//! Reference of `effects/depth_layers/depth_layers.wgsl`; that of `lines/cracks/planes.wgsl` has
//! its name.

use super::{
    Rgb,
    color::{in_gamut, linear_to_oklab, oklab_to_linear},
    mix, smoothstep, tone_bands,
    view::View,
};
use bevy_comics::{DepthLayers, effects::DepthLayer};

/// Fractions of near, middle and far at a depth of the map.
pub fn weights([near_end, far_start]: [f64; 2], softness: f64, d: f64) -> [f64; 3] {
    let behind = |border: f64| {
        if softness < 1e-6 {
            return f64::from(u8::from(d > border));
        }
        smoothstep(border - softness / 2.0, border + softness / 2.0, d)
    };
    let (far, not_near) = (behind(far_start), behind(near_end));
    [1.0 - not_near, not_near - far, far]
}

/// The `OKLab` color of one plane.
fn plane(s: &DepthLayer, [lightness, a, b]: Rgb, change: f64) -> Rgb {
    let tone = match s.bands {
        0 => lightness,
        1 => 0.5,
        n => tone_bands::band_tone(f64::from(n), 1.0, lightness, change),
    };
    let tint = s.tint.to_linear();
    let [_, ta, tb] = linear_to_oklab([tint.red, tint.green, tint.blue].map(f64::from));
    let [saturation, amount] = [s.saturation, s.tint_amount].map(f64::from);
    [
        (tone - 0.5) * f64::from(s.contrast) + 0.5 + f64::from(s.brightness),
        mix(a * saturation, ta, amount),
        mix(b * saturation, tb, amount),
    ]
}

/// `change`: of the square root of the luminance, over a pixel.
pub fn color(s: &DepthLayers, linear: Rgb, weights: [f64; 3], change: f64) -> Rgb {
    let lab = linear_to_oklab(linear);
    let change = change * (2.0 / 3.0) / lab[0].max(1e-3).sqrt();
    let planes = [s.foreground, s.middle, s.background].map(|s| plane(&s, lab, change));
    let mut mixed: Rgb =
        std::array::from_fn(|i| (0..3).map(|plane| weights[plane] * planes[plane][i]).sum());
    mixed[0] = mixed[0].clamp(0.0, lab[0].max(1.0));
    let mixed: Rgb = std::array::from_fn(|i| mix(lab[i], mixed[i], f64::from(s.amount)));
    in_gamut(oklab_to_linear(mixed), mixed[0], linear)
}

/// The weights of a pixel with [`LayerBorders::Fixed`](bevy_comics::effects::LayerBorders::Fixed):
/// the mean over its samples.
pub fn pixel_weights(s: &DepthLayers, view: &View, [x, y]: [u32; 2]) -> [f64; 3] {
    let near_end = f64::from(s.foreground_end);
    let borders = [near_end, f64::from(s.background_start).max(near_end)];
    let mut sum = [0.0; 3];
    for sample in 0..view.samples {
        let [d, _] = view.frame.depth_map(view.depth(x, y, sample));
        let w = weights(borders, f64::from(s.softness), d);
        sum = std::array::from_fn(|i| sum[i] + w[i] / f64::from(view.samples));
    }
    if view.flip {
        sum.reverse();
    }
    sum
}
