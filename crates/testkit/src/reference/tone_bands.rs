//! Reference of `effects/tone_bands/tone_bands.wgsl`.

use super::{
    Rgb,
    color::{lightness, luminance, srgb_decode, srgb_encode},
    mix, smoothstep,
};
use bevy_comics::{ToneBands, effects::Equations};

/// \[CL\] Eq. 6 for one channel of the display code, with its three ranges joined at
/// 0.33 and 0.66.
fn equation_6(c: f64) -> f64 {
    match c {
        c if c < 0.33 => c / 1.5,
        c if c < 0.66 => 0.33 + (c - 0.33) / 2.0,
        c => 0.66 + (c - 0.66) / 2.0,
    }
}

/// The middle of the band of the lightness `y`, with a smooth step between two
/// bands. `softness`: width of the step in physical pixels; `change`: change of the
/// lightness over a pixel.
pub fn band_tone(levels: f64, softness: f64, y: f64, change: f64) -> f64 {
    let half = 0.5 * (softness * change * levels).clamp(levels / 128.0, 1.0);
    // A step is at most one band wide, so only the nearest border counts.
    let t = y * levels;
    let border = t.round().clamp(1.0, levels - 1.0);
    let below = border - 1.0;
    let passed = smoothstep(border - half, border + half, t);
    (below + 0.5 + passed) / levels
}

/// Bands that have split `splits` times. `step`: the width of a step in lightness.
pub fn split_bands(levels: f64, splits: f64, y: f64, step: f64) -> f64 {
    let whole = splits.floor();
    let [fewer, more] =
        [0.0, 1.0].map(|one| band_tone(levels * (whole + one).exp2(), step, y, 1.0));
    mix(fewer, more, smoothstep(0.0, 1.0, splits - whole))
}

/// The color at the luminance `target`, mixed with gray as far as the display needs
/// it.
fn with_luminance(linear: Rgb, target: f64) -> Rgb {
    let y = luminance(linear);
    if y < 1e-6 {
        return [target; 3];
    }
    let scaled = linear.map(|c| c * target / y);
    let largest = scaled.into_iter().fold(f64::MIN, f64::max);
    if largest <= 1.0 {
        return scaled;
    }
    let room = ((1.0 - target) / (largest - target).max(1e-6)).clamp(0.0, 1.0);
    scaled.map(|c| mix(target, c, room))
}

/// `scale`: physical pixels per logical pixel.
pub fn banded_color(s: &ToneBands, linear: Rgb, change: f64, scale: f64) -> Rgb {
    let banded = match s.equations {
        Equations::Faithful => srgb_decode(srgb_encode(linear).map(equation_6)),
        Equations::Corrected => {
            let tone = band_tone(
                f64::from(s.levels),
                f64::from(s.softness) * scale,
                lightness(linear),
                change,
            );
            with_luminance(linear, tone * tone)
        }
    };
    std::array::from_fn(|i| mix(linear[i], banded[i], f64::from(s.amount)))
}
