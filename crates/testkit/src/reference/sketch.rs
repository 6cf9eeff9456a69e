//! Reference of `effects/sketch/sketch.wgsl`.

use super::{Rgb, Rgba, mix, noise::wave};
use bevy_comics::Sketch;

/// Displacement of a stroke in physical pixels. `at`: pixels from the corner of the
/// viewport; `scale`: physical pixels per logical pixel.
pub fn stray(s: &Sketch, at: [f64; 2], stroke: u32, drawing: u32, scale: f64) -> [f64; 2] {
    let seed = drawing * 16 + stroke * 4;
    let p = at.map(|v| v / (f64::from(s.wavelength) * scale));
    [seed, seed + 1].map(|seed| f64::from(s.jitter) * scale * wave(p, seed))
}

/// Pressure of the pen, 0 to 1, at the same place.
pub fn pen_pressure(s: &Sketch, at: [f64; 2], stroke: u32, drawing: u32, scale: f64) -> f64 {
    let p = at.map(|v| v / (f64::from(s.wavelength) * scale) * 1.7);
    let n = wave(p, drawing * 16 + stroke * 4 + 2);
    1.0 - f64::from(s.pressure) * (0.5 + 0.5 * n)
}

/// Ink on opaque paper, which is blank where there is no picture.
pub fn draw_sketch(s: &Sketch, picture: Rgba, inked: f64) -> Rgb {
    let rgb = |color: bevy::color::Color| {
        let c = color.to_linear();
        [c.red, c.green, c.blue].map(f64::from)
    };
    let (paper, ink) = (rgb(s.paper), rgb(s.ink));
    let amount = inked.max(0.0).powf(f64::from(s.gamma)).min(1.0);
    std::array::from_fn(|i| {
        let ground = {
            let washed = paper[i] * (picture[i] + 1.0 - picture[3]);
            mix(paper[i], washed, f64::from(s.wash))
        };
        mix(ground, ink[i], amount)
    })
}
