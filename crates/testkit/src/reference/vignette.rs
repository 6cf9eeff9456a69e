//! Reference of `effects/vignette/vignette.wgsl`.

use super::{Rgb, Rgba, mix, smoothstep};
use bevy_comics::{Vignette, effect::linear_rgb};

/// Fraction of the color that is mixed in. `at`: pixels from the top left corner of
/// the viewport; `size`: of the viewport, pixels.
fn cover(s: &Vignette, at: [f64; 2], size: [f64; 2]) -> f64 {
    let half = 0.5 * f64::from(s.softness.max(1e-3));
    let radius = f64::from(s.radius);
    // The viewport is [-1, 1] x [-1, 1] here: the corners are sqrt(2) from the center.
    let [x, y] = [0, 1].map(|i| (at[i] - 0.5 * size[i]) / (0.5 * size[i]));
    let distance = x.hypot(y) / 2f64.sqrt();
    f64::from(s.amount) * smoothstep(radius - half, radius + half, distance)
}

/// Mixed into what is there of a picture.
pub fn vignette(s: &Vignette, picture: Rgba, at: [f64; 2], size: [f64; 2]) -> Rgb {
    let ink = linear_rgb(s.color).to_array().map(f64::from);
    let cover = cover(s, at, size);
    std::array::from_fn(|i| mix(picture[i], ink[i] * picture[3], cover))
}
