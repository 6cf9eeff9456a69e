//! How exact the strokes of hatching and the tones of abstraction are, by their twins.

use bevy::math::DVec3;
use bevy_comics::{Hatching, HatchingMarks};

use crate::reference::{
    abstraction::split_bands,
    hatching::{Hatch, Surface},
};

/// A part of a wall that is turned by an angle about the vertical axis, in an orthographic view whose
/// pixels are `unit` wide, at a place in pixels.
fn wall(angle: f64, unit: f64, [x, y]: [f64; 2]) -> Surface {
    let (sin, cos) = angle.sin_cos();
    let [across, down] = [DVec3::new(unit, 0.0, unit * sin / cos), -unit * DVec3::Y];
    Surface {
        place: across * x + down * y,
        across,
        down,
        normal: DVec3::new(-sin, 0.0, cos),
    }
}

/// The largest difference of the mean darkness of a wall from the one that is asked for: twenty tones,
/// nine angles up to 80 degrees, and 32 zooms over an octave. `random`: of breaks and wobble, and
/// twice the pressure.
pub fn mean_tone_error(marks: HatchingMarks, random: f32, samples: u32) -> f64 {
    let settings = Hatching {
        marks,
        breaks: random,
        wobble: random,
        pressure: 0.5 * random,
        ..Hatching::default()
    };
    let hatch = Hatch {
        settings: &settings,
        scale: 1.0,
        drawing: 0,
    };
    let mut largest = 0.0f64;
    for zoom in 0..32 {
        let unit = 0.01 * (0.031_25 * f64::from(zoom)).exp2();
        for tilt in 0..9 {
            let angle = f64::from(10 * tilt).to_radians();
            for tone in 0..20 {
                let tone = 0.025 + 0.05 * f64::from(tone);
                let cover = |n: u32| {
                    // Even places in a square of 768 pixels.
                    let n = f64::from(n);
                    let at = [n * 0.754_877_666_2, n * 0.569_840_291].map(|x| 768.0 * x.fract());
                    hatch.cover(&wall(angle, unit, at), tone)
                };
                let sum: f64 = (0..samples).map(cover).sum();
                largest = largest.max((sum / f64::from(samples) - tone).abs());
            }
        }
    }
    largest
}

/// The largest change of a tone, in parts of the widest band, while the dial of abstraction turns by
/// a two-hundredth: 2 to 8 bands that split up to three times.
pub fn largest_tone_step() -> f64 {
    let mut largest = 0.0f64;
    for levels in 2..=8 {
        for turn in 0..200 {
            let splits = [turn, turn + 1].map(|turn| 3.0 * (1.0 - f64::from(turn) / 200.0));
            for light in 0..=200 {
                let light = f64::from(light) / 200.0;
                let tones = splits.map(|splits| split_bands(levels.into(), splits, light, 0.02));
                largest = largest.max((tones[0] - tones[1]).abs() * f64::from(levels));
            }
        }
    }
    largest
}
