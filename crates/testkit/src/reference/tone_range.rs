//! Reference of `tones/tones.wgsl`, and of the percentiles that it reads, without smoothing.

use bevy_comics::ToneRange;

use super::{
    Rgb,
    color::{finite, luminance},
    histogram::Bins,
    range,
};

/// The luminance that counts as 1, and the least that is not black.
const LARGEST: f64 = 65536.0;
const BLACK: f64 = 1.0 / 65536.0;

/// The number that takes the place of raw depth for a pixel in linear light, multiplied by its
/// opacity, and the opacity; 0 where it does not count.
pub fn number([r, g, b, a]: [f32; 4]) -> f32 {
    let alpha = finite(a).clamp(0.0, 1.0);
    let light = luminance([r, g, b].map(finite)) / alpha.max(1e-3);
    if alpha < 0.5 || light < BLACK {
        return 0.0;
    }
    (light / LARGEST).min(1.0) as f32
}

/// Lightness that this fraction of the pixels is darker than, and lighter than; `None` if none
/// counts.
pub fn percentiles(pixels: impl IntoIterator<Item = [f32; 4]>, outliers: f32) -> Option<[f64; 2]> {
    let numbers: Vec<f32> = pixels.into_iter().map(number).collect();
    let ends = range::scan(numbers.iter().copied())?;
    let ends = ends.map(|bits| f64::from(f32::from_bits(bits)));
    let (bins, total) = Bins::Octaves.count(numbers);
    let [light, dark] = Bins::Octaves.percentiles(&bins, total, f64::from(outliers), ends);
    Some([dark, light].map(|number| (number * LARGEST).sqrt()))
}

/// The factor of lightness, and what is added to it.
pub fn line(s: &ToneRange, found: Option<[f64; 2]>) -> [f64; 2] {
    let Some([low, high]) = found else {
        return [1.0, 0.0];
    };
    let [dark, light, most] = [s.dark, s.light, s.max_gain].map(f64::from);
    let low = low.max(dark / most);
    let high = high.max(low);
    let gain = (light - dark) / (high - low);
    if gain <= most {
        return [gain, dark - gain * low];
    }
    // Less contrast than there is room for: the ends move no farther than to `dark` or `light`.
    let middle = 0.5 * (low + high);
    let half = 0.5 * most * (high - low);
    let moved = middle.clamp(dark + half, light - half);
    [most, moved - most * middle]
}

/// A color of linear light.
pub fn brought([gain, shift]: [f64; 2], linear: Rgb) -> Rgb {
    let light = luminance(linear).max(0.0);
    let after = (gain * light.sqrt() + shift).max(0.0);
    // What the gain does not give is gray.
    let ratio = (after / light.sqrt().max(1e-6)).min(gain);
    let gray = after * after - ratio * ratio * light;
    linear.map(|c| c * ratio * ratio + gray)
}
