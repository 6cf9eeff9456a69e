//! How well screens print flat tones, gradients and rings. Computed with the shader's reference,
//! which every pixel of a picture equals.

use std::f64::consts::TAU;

use bevy::color::Color;
use bevy_comics::{Halftone, effects::ScreenShape};

use crate::reference::{
    color::luminance,
    halftone::{Plate, inked, plate_cover, plate_tones},
};

/// All shapes.
pub const SHAPES: [ScreenShape; 6] = [
    ScreenShape::Round,
    ScreenShape::Euclidean,
    ScreenShape::Line,
    ScreenShape::Diamond,
    ScreenShape::Cross,
    ScreenShape::Stochastic,
];

/// The angles of the plates in degrees.
pub const ANGLES: [f64; 4] = [15.0, 75.0, 0.0, 45.0];

/// Sizes of cells that are measured, in pixels.
pub const CELL_SIZES: [f64; 5] = [3.0, 4.0, 6.0, 8.0, 12.5];

/// The tile of 64 x 64 grains that the crate prints with: the classes of their thresholds.
pub(crate) const TILE: &[u8; 4096] = include_bytes!("../../../src/fused/pass/blue_noise.bin");

/// Thresholds of grains by column and row.
pub fn tile(x: i64, y: i64) -> f64 {
    let class = TILE[(y.rem_euclid(64) * 64 + x.rem_euclid(64)) as usize];
    (f64::from(class) + 0.5) / 256.0
}

/// A plate of a screen that begins in the middle.
pub fn plate(degrees: f64, cell_size: f64) -> Plate {
    Plate {
        degrees,
        cell_size,
        phase: 0.0,
        number: 0,
        ink_bleed: 0.0,
        height: 0.0,
    }
}

/// Pixels of a square whose side is a multiple of `cell_size`, around where screens begin.
pub fn square(cell_size: f64) -> impl Iterator<Item = [f64; 2]> + Clone {
    let side = (cell_size * (250.0 / cell_size).floor()).round() as i32;
    (0..side)
        .flat_map(move |y| (0..side).map(move |x| [x, y].map(|v| f64::from(v - side / 2) + 0.25)))
}

/// Inks and paper that print exactly the light that the plates ask for.
pub fn ideal() -> Halftone {
    Halftone {
        cyan: Color::srgb(0.0, 1.0, 1.0),
        magenta: Color::srgb(1.0, 0.0, 1.0),
        yellow: Color::srgb(1.0, 1.0, 0.0),
        black: Color::BLACK,
        paper: Color::WHITE,
        ..Halftone::default()
    }
}

/// 20 colors in linear light, spread over all.
pub fn colors() -> impl Iterator<Item = [f64; 3]> {
    (0..20u32).map(|i| {
        let part = |k: u32| f64::from((i * 7 + 3) * k % 19) / 18.0;
        [part(5), part(11), part(13)]
    })
}

/// The mean of some values.
pub fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    sum / f64::from(count)
}

/// Of 11 tones at four angles, the one whose print departs most from it: (mean of a flat area
/// less its tone, tone, degrees).
pub fn tone_error(shape: ScreenShape, cell_size: f64) -> (f64, f64, f64) {
    let mut most = (0.0, 0.0, 0.0);
    for degrees in ANGLES {
        for tone in (0..=10).map(|i| f64::from(i) / 10.0) {
            let cover = plate_cover(shape, plate(degrees, cell_size), tone, &tile);
            let error = mean(square(cell_size).map(cover)) - tone;
            if error.abs() > f64::abs(most.0) {
                most = (error, tone, degrees);
            }
        }
    }
    most
}

/// The largest change of a pixel when the tone changes by 1 / 1024, of 300 pixels and all tones:
/// (change, tone).
pub fn largest_jump(shape: ScreenShape, cell_size: f64) -> (f64, f64) {
    let places: Vec<_> = (0..300)
        .map(|i| [f64::from(i) * 1.618 % 50.0, f64::from(i) * 2.414 % 50.0])
        .collect();
    let mut before = vec![0.0; places.len()];
    let mut most = (0.0, 0.0);
    for step in 0..=1024 {
        let tone = f64::from(step) / 1024.0;
        let cover = plate_cover(shape, plate(15.0, cell_size), tone, &tile);
        for (place, before) in places.iter().zip(&mut before) {
            let k = cover(*place);
            if (k - *before).abs() > most.0 {
                most = ((k - *before).abs(), tone);
            }
            *before = k;
        }
    }
    most
}

/// Side of the pictures whose prints are searched for slow parts.
const SIDE: usize = 240;

/// The tone of a picture at a place from its middle, as it is stored: in 8 bits. A slow gradient,
/// or rings that become finer towards the border (`zones`).
fn picture_tone([x, y]: [f64; 2], cell_size: f64, zones: bool) -> f64 {
    let tone = if zones {
        // At the border: a period of 12 cells.
        let frequency = 1.0 / (12.0 * cell_size);
        let square = (x * x + y * y) / (SIDE as f64 / 2.0);
        0.5 + 0.35 * (0.5 * TAU * frequency * square).cos()
    } else {
        0.5 + x / SIDE as f64
    };
    (tone.clamp(0.0, 1.0) * 255.0).round() / 255.0
}

/// The part of the power of a print less its picture that is below half of the screen's frequency.
/// `rest`: the print less the picture, at a place where the picture has a tone.
fn slow_part(cell_size: f64, zones: bool, rest: impl Fn([f64; 2], f64) -> f64) -> f64 {
    let place = |i: usize| [i % SIDE, i / SIDE].map(|v| v as f64 + 0.25 - SIDE as f64 / 2.0);
    let rest: Vec<f64> = (0..SIDE * SIDE)
        .map(|i| rest(place(i), picture_tone(place(i), cell_size, zones)))
        .collect();
    let power = mean(rest.iter().map(|v| v * v));
    let slow = blurred(&rest, SIDE, 1.2 * cell_size);
    let margin = (3.0 * cell_size) as usize;
    let inside =
        (margin..SIDE - margin).flat_map(|y| (margin..SIDE - margin).map(move |x| y * SIDE + x));
    mean(inside.map(|i| slow[i] * slow[i])) / power
}

/// The slow part of a print with one plate, of a gradient or of rings.
pub fn moire(shape: ScreenShape, cell_size: f64, degrees: f64, zones: bool) -> f64 {
    slow_part(cell_size, zones, |place, tone| {
        plate_cover(shape, plate(degrees, cell_size), tone, &tile)(place) - tone
    })
}

/// The slow part of the light of a gray print with all four inks, whose screens beat with each
/// other.
pub fn moire_of_inks(s: &Halftone, zones: bool) -> f64 {
    let plates = Plate::all(s, 1.0);
    slow_part(f64::from(s.cell_size), zones, |place, tone| {
        let tones = plate_tones(s, [1.0 - tone; 3]);
        let covers =
            std::array::from_fn(|i| plate_cover(s.shape, plates[i], tones[i], &tile)(place));
        luminance(inked(s, covers)) - luminance(inked(s, tones))
    })
}

/// The mean light of a print of a flat color with these plates. `tones`: those of the plates.
pub fn printed_mean(s: &Halftone, plates: [Plate; 4], tones: [f64; 4]) -> [f64; 3] {
    let covers: [_; 4] = std::array::from_fn(|i| plate_cover(s.shape, plates[i], tones[i], &tile));
    let prints = square(6.0).map(|place| inked(s, std::array::from_fn(|i| covers[i](place))));
    let (sum, count) = prints.fold(([0.0; 3], 0.0), |(sum, count), print| {
        ([0, 1, 2].map(|c| sum[c] + print[c]), count + 1.0)
    });
    sum.map(|v| v / count)
}

/// The plates of an effect if black had no phase of its own.
pub fn in_phase(s: &Halftone) -> [Plate; 4] {
    Plate::all(s, 1.0).map(|plate| Plate {
        phase: 0.0,
        ..plate
    })
}

/// Inks that each take some of all light away: what they print depends on whether their screens
/// are independent.
pub fn gray_inks(s: Halftone) -> Halftone {
    let gray = Color::linear_rgb(0.2, 0.2, 0.2);
    Halftone {
        cyan: gray,
        magenta: gray,
        yellow: Color::WHITE,
        ..s
    }
}

/// The largest difference of the mean light of a print from that of independent screens
/// (Demichel), of 20 colors and three grays.
pub fn color_error(s: &Halftone, plates: [Plate; 4]) -> f64 {
    let grays = [0.25, 0.4, 0.6].map(|v| [v; 3]);
    let apart = colors().chain(grays).flat_map(|light| {
        let tones = plate_tones(s, light);
        let (printed, want) = (printed_mean(s, plates, tones), inked(s, tones));
        [0, 1, 2].map(|c| (printed[c] - want[c]).abs())
    });
    apart.fold(0.0, f64::max)
}

/// A Gaussian blur of a square picture.
pub fn blurred(picture: &[f64], side: usize, sigma: f64) -> Vec<f64> {
    let reach = (3.0 * sigma) as i64;
    let weights: Vec<f64> = (-reach..=reach)
        .map(|d| (-0.5 * (d as f64 / sigma).powi(2)).exp())
        .collect();
    let total: f64 = weights.iter().sum();
    let pass = |from: &[f64], dx: i64, dy: i64| -> Vec<f64> {
        (0..side * side)
            .map(|i| {
                let (x, y) = ((i % side) as i64, (i / side) as i64);
                let last = side as i64 - 1;
                let at = |d: i64| {
                    let (x, y) = (x + d * dx, y + d * dy);
                    from[(y.clamp(0, last) * side as i64 + x.clamp(0, last)) as usize]
                };
                let sum = (-reach..=reach).zip(&weights).map(|(d, w)| w * at(d));
                sum.sum::<f64>() / total
            })
            .collect()
    };
    pass(&pass(picture, 1, 0), 0, 1)
}
