//! How exact the strokes of hatching and the tones of abstraction are, by their references.

use std::{f64::consts::PI, thread};

use bevy::math::DVec3;
use bevy_comics::{Hatching, effects::HatchingKind};

use crate::reference::{
    hatching::{Hatch, Surface},
    tone_bands::split_bands,
};

/// A part of a wall that is turned by an angle about the vertical axis, in an orthographic view
/// whose pixels are `unit` wide, at a place in pixels.
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

/// The largest difference of the mean darkness of a wall from the one that is asked for: twenty
/// tones, nine angles up to 80 degrees, and 32 zooms over an octave. `random`: of breaks and
/// wobble, and twice the pressure.
pub fn mean_tone_error(kind: HatchingKind, random: f32, samples: u32) -> f64 {
    let settings = Hatching {
        kind,
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
    let worst = |zooms: std::ops::Range<u32>| {
        let mut largest = 0.0f64;
        for (zoom, tilt, tone) in zooms.flat_map(|z| (0..180).map(move |k| (z, k / 20, k % 20))) {
            let unit = 0.01 * (0.031_25 * f64::from(zoom)).exp2();
            let angle = f64::from(10 * tilt).to_radians();
            let tone = 0.025 + 0.05 * f64::from(tone);
            let cover = |at| hatch.cover(&wall(angle, unit, at), tone);
            let mean = if random > 0.0 {
                spread_mean(cover, samples)
            } else {
                let mean = window_mean(cover, samples);
                // Directions beat with each other and with the pixels; some beats are as long as
                // the window.
                if (mean - tone).abs() > 0.002 {
                    window_mean(cover, 9 * samples)
                } else {
                    mean
                }
            };
            largest = largest.max((mean - tone).abs());
        }
        largest
    };
    thread::scope(|scope| {
        let halves = [0..16, 16..32].map(|zooms| scope.spawn(|| worst(zooms)));
        let found = halves.map(|half| half.join().expect("numbers"));
        found[0].max(found[1])
    })
}

/// The mean over even places in a square of 768 pixels. A random mean of n places is off by half of
/// `1 / sqrt(n)`.
fn spread_mean(cover: impl Fn([f64; 2]) -> f64, samples: u32) -> f64 {
    let of = |n: u32| {
        let n = f64::from(n);
        cover([n * 0.754_877_666_2, n * 0.569_840_291].map(|x| 768.0 * x.fract()))
    };
    (0..samples).map(of).sum::<f64>() / f64::from(samples)
}

/// The mean over all pixels of a square with that many, whose weights fall to nothing at its border
/// (Hann), so that it does not matter how many strokes it contains.
fn window_mean(cover: impl Fn([f64; 2]) -> f64, samples: u32) -> f64 {
    let side = samples.isqrt();
    let weight = |x: u32| (PI * (f64::from(x) + 0.5) / f64::from(side)).sin().powi(2);
    let (mut sum, mut all) = (0.0, 0.0);
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let w = weight(x) * weight(y);
        sum += w * cover([f64::from(x), f64::from(y)]);
        all += w;
    }
    sum / all
}

/// The largest change of a tone, in parts of the widest band, while the abstraction grows
/// by a two-hundredth: 2 to 8 bands that split up to three times.
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
