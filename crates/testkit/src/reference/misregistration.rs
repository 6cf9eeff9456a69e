//! Reference of `effects/misregistration/misregistration.wgsl`.

use bevy_comics::Misregistration;

use super::{Rgb, Rgba, color, noise::hash};

/// Where the page of a cut and a drawing has its plates, as fractions of the drift: cyan, magenta
/// and yellow, to the right and down.
pub fn strays(cuts: u32, drawing: u32) -> [[f64; 2]; 3] {
    let page = hash(cuts) ^ drawing;
    let number = |axis: u32| f64::from(hash(page ^ hash(axis)) >> 8) / f64::from(1 << 23) - 1.0;
    [[0, 1], [2, 3], [4, 5]].map(|axes| axes.map(number))
}

/// The offsets of cyan, magenta, yellow and black in pixels, on the first page.
pub fn offsets(s: &Misregistration, scale: f64) -> [[f64; 2]; 4] {
    let strays = strays(0, 0);
    let fixed = [s.cyan, s.magenta, s.yellow, s.black].map(|plate| plate.to_array());
    let factor = f64::from(s.amount) * scale;
    std::array::from_fn(|plate| {
        [0, 1].map(|axis| {
            let strayed = f64::from(s.drift) * strays.get(plate).map_or(0.0, |plate| plate[axis]);
            factor * (f64::from(fixed[plate][axis]) + strayed)
        })
    })
}

/// The picture with its plates moved, at a place in pixels. `picture`: color multiplied by
/// its opacity, and the opacity, at any place.
pub fn misregistration(
    s: &Misregistration,
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
