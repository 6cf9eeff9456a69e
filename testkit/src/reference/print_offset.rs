//! Twin of `effects/print_offset/print_offset.wgsl`.

use bevy_comics::PrintOffset;

use super::{Rgb, Rgba, color};

/// The offsets of cyan, magenta, yellow and black in pixels.
pub fn offsets(s: &PrintOffset, scale: f64) -> [[f64; 2]; 4] {
    [
        [s.cyan_x, s.cyan_y],
        [s.magenta_x, s.magenta_y],
        [s.yellow_x, s.yellow_y],
        [s.black_x, s.black_y],
    ]
    .map(|offset| offset.map(|v| f64::from(v) * f64::from(s.amount) * scale))
}

/// The picture with its plates moved, at a place in pixels. `picture`: colour multiplied by
/// its opacity, and the opacity, at any place.
pub fn print_offset(
    s: &PrintOffset,
    picture: &dyn Fn([f64; 2]) -> Rgba,
    at: [f64; 2],
    scale: f64,
) -> Rgb {
    let [r, g, b, alpha] = picture(at);
    let own = [r, g, b].map(|c| c / alpha.max(1e-3));
    let moved = offsets(s, scale);
    let tones: [f64; 4] = std::array::from_fn(|plate| {
        let [x, y] = moved[plate];
        let found = picture([at[0] - x, at[1] - y]);
        let linear = std::array::from_fn(|c| found[c] + (1.0 - found[3]) * own[c]);
        color::separated(
            linear.map(|c: f64| c.clamp(0.0, 1.0)),
            f64::from(s.black_generation),
        )[plate]
    });
    [0, 1, 2].map(|c| (1.0 - tones[c]) * (1.0 - tones[3]) * alpha)
}
