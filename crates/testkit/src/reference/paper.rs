//! Reference of `effects/paper/paper.wgsl`.

use super::{Rgb, Rgba, mix, sheet::height};
use bevy_comics::{Paper, effect::linear_rgb};

/// Linear light of a page where the sheet has a height.
pub fn on_paper(s: &Paper, page: Rgb, height: f64) -> Rgb {
    let color = linear_rgb(s.color).to_array().map(f64::from);
    std::array::from_fn(|i| {
        let k = (1.0 - page[i]).clamp(0.0, 1.0);
        let inked = k - f64::from(s.grain) * height * k * (1.0 - k);
        (page[i] + k - inked) * color[i] * (1.0 + 0.5 * f64::from(s.shading) * height)
    })
}

/// The color of a pixel, multiplied by its opacity. `at`: physical pixels from the render
/// target's top left corner; `scale`: physical pixels per logical pixel.
pub fn paper(s: &Paper, picture: Rgba, at: [f64; 2], scale: f64, sheet: u32) -> Rgb {
    let alpha = picture[3];
    let page = [0, 1, 2].map(|i| picture[i] / alpha.max(1e-3));
    let height = height(at.map(|v| v / (f64::from(s.size) * scale)), sheet);
    let printed = on_paper(s, page, height);
    std::array::from_fn(|i| mix(picture[i], printed[i] * alpha, f64::from(s.amount)))
}
