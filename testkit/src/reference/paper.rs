//! Twin of `effects/paper/paper.wgsl`.

use super::{Rgb, Rgba, mix, noise::wave};
use bevy_comics::{Paper, linear_rgb};

/// Height of the sheet, -1 to 1, at a place in units of the grain.
pub fn height(at: [f64; 2], sheet: u32) -> f64 {
    let first = 0x7061_7065 + 3 * sheet;
    // Value noise whose grid is turned by an angle with this cosine and sine.
    let octave = |[cos, sin]: [f64; 2], period: f64, seed: u32| {
        let [x, y] = at;
        wave(
            [(cos * x - sin * y) / period, (sin * x + cos * y) / period],
            seed,
        )
    };
    let fine = octave([0.8, 0.6], 1.5, first);
    let middle = octave([5.0 / 13.0, 12.0 / 13.0], 4.0, first + 1);
    let coarse = octave([15.0 / 17.0, 8.0 / 17.0], 12.0, first + 2);
    (fine + 0.6 * middle + 0.4 * coarse).clamp(-1.0, 1.0)
}

/// Linear light of a page where the sheet has a height.
pub fn on_paper(s: &Paper, page: Rgb, height: f64) -> Rgb {
    let color = linear_rgb(s.color).to_array().map(f64::from);
    std::array::from_fn(|i| {
        let k = (1.0 - page[i]).clamp(0.0, 1.0);
        let inked = k - f64::from(s.grain) * height * k * (1.0 - k);
        (page[i] + k - inked) * color[i] * (1.0 + 0.5 * f64::from(s.shading) * height)
    })
}

/// The colour of a pixel, multiplied by its opacity. `at`: physical pixels from the render
/// target's top left corner; `scale`: physical pixels per logical pixel.
pub fn paper(s: &Paper, picture: Rgba, at: [f64; 2], scale: f64, sheet: u32) -> Rgb {
    let alpha = picture[3];
    let page = [0, 1, 2].map(|i| picture[i] / alpha.max(1e-3));
    let height = height(at.map(|v| v / (f64::from(s.size) * scale)), sheet);
    let printed = on_paper(s, page, height);
    std::array::from_fn(|i| mix(picture[i], printed[i] * alpha, f64::from(s.amount)))
}
