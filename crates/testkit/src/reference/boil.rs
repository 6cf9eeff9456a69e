//! Reference of `lines/settings/boil.wgsl`: how far lines are displaced.

use bevy_comics::lines::LineBoil;

use super::noise::wave;

/// Where the lines are found that are drawn at a place of the viewport, in physical pixels
/// from its corner. `scale`: physical pixels per logical pixel.
pub fn boiled(b: &LineBoil, at: [f64; 2], scale: f64, seconds: f64) -> [f64; 2] {
    let drawing = (seconds * f64::from(b.rate)).floor() as u32;
    let seed = 0x6c69_6e65 + 2 * drawing;
    let p = at.map(|v| v / (f64::from(b.wavelength) * scale));
    [0, 1].map(|axis| at[axis] + f64::from(b.amplitude) * scale * wave(p, seed + axis as u32))
}
