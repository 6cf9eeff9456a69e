//! Twin of `effects/print_offset/print_offset.wgsl`.

use bevy_comics::PrintOffset;

use super::{Rgb, Rgba, color, noise::hash};

/// Where the page of a cut and a drawing has its plates, as fractions of the drift: cyan, magenta
/// and yellow, to the right and down.
pub fn strays(cuts: u32, drawing: u32) -> [[f64; 2]; 3] {
    let page = hash(cuts) ^ drawing;
    let number = |axis: u32| f64::from(hash(page ^ hash(axis)) >> 8) / f64::from(1 << 23) - 1.0;
    [[0, 1], [2, 3], [4, 5]].map(|axes| axes.map(number))
}

/// The offsets of cyan, magenta, yellow and black in pixels, on the first page.
pub fn offsets(s: &PrintOffset, scale: f64) -> [[f64; 2]; 4] {
    let strays = strays(0, 0);
    let fixed = [
        [s.cyan_x, s.cyan_y],
        [s.magenta_x, s.magenta_y],
        [s.yellow_x, s.yellow_y],
        [s.black_x, s.black_y],
    ];
    let factor = f64::from(s.amount) * scale;
    std::array::from_fn(|plate| {
        [0, 1].map(|axis| {
            let strayed = f64::from(s.drift) * strays.get(plate).map_or(0.0, |plate| plate[axis]);
            factor * (f64::from(fixed[plate][axis]) + strayed)
        })
    })
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
