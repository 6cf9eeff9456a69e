//! Reference of `effect/color.wgsl`.

use super::Rgb;

/// Infinity becomes 65504, the largest `f16`; NaN and minus infinity become 0.
pub fn finite(x: f32) -> f64 {
    if x.is_finite() {
        f64::from(x)
    } else if x == f32::INFINITY {
        65504.0
    } else {
        0.0
    }
}

pub fn srgb_encode_one(c: f64) -> f64 {
    let m = c.abs();
    let e = if m <= 0.003_130_8 {
        12.92 * m
    } else {
        1.055 * m.powf(1.0 / 2.4) - 0.055
    };
    e.copysign(c)
}

pub fn srgb_decode_one(c: f64) -> f64 {
    let m = c.abs();
    let d = if m <= 0.040_45 {
        m / 12.92
    } else {
        ((m + 0.055) / 1.055).powf(2.4)
    };
    d.copysign(c)
}

pub fn srgb_encode(c: Rgb) -> Rgb {
    c.map(srgb_encode_one)
}

pub fn srgb_decode(c: Rgb) -> Rgb {
    c.map(srgb_decode_one)
}

pub fn luminance([r, g, b]: Rgb) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Lightness of a linear color by Hunter's formula (1948): the square root of
/// the luminance.
pub fn lightness(linear: Rgb) -> f64 {
    luminance(linear).clamp(0.0, 1.0).sqrt()
}

pub fn largest(c: Rgb) -> f64 {
    c.into_iter().fold(f64::MIN, f64::max)
}

pub fn smallest(c: Rgb) -> f64 {
    c.into_iter().fold(f64::MAX, f64::min)
}

/// HSV hue in turns, [0, 1); 0 for grays.
pub fn hue_of([r, g, b]: Rgb) -> f64 {
    let (v, c) = (largest([r, g, b]), largest([r, g, b]) - smallest([r, g, b]));
    if c <= 0.0 {
        return 0.0;
    }
    let sextant = if v == r {
        (g - b) / c
    } else if v == g {
        2.0 + (b - r) / c
    } else {
        4.0 + (r - g) / c
    };
    (sextant / 6.0).rem_euclid(1.0)
}

/// The color with HSV saturation and value 1 at a hue in turns, by the six
/// sectors of the HSV hexagon.
pub fn hue_color(hue: f64) -> Rgb {
    let h = hue.rem_euclid(1.0) * 6.0;
    let x = 1.0 - (h % 2.0 - 1.0).abs();
    match h as u32 {
        0 => [1.0, x, 0.0],
        1 => [x, 1.0, 0.0],
        2 => [0.0, 1.0, x],
        3 => [0.0, x, 1.0],
        4 => [x, 0.0, 1.0],
        _ => [1.0, 0.0, x],
    }
}

/// `OKLab` (lightness, a, b) of a linear color, with the matrices that Ottosson
/// published (2020).
pub fn linear_to_oklab(c: Rgb) -> Rgb {
    const M1: [Rgb; 3] = [
        [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
        [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
        [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
    ];
    const M2: [Rgb; 3] = [
        [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
        [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
        [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
    ];
    apply(M2, apply(M1, c).map(f64::cbrt))
}

pub fn oklab_to_linear(lab: Rgb) -> Rgb {
    const M2: [Rgb; 3] = [
        [1.0, 0.396_337_777_4, 0.215_803_757_3],
        [1.0, -0.105_561_345_8, -0.063_854_172_8],
        [1.0, -0.089_484_177_5, -1.291_485_548_0],
    ];
    const M1: [Rgb; 3] = [
        [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
        [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
        [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0],
    ];
    apply(M1, apply(M2, lab).map(|x| x * x * x))
}

/// Mixes a color with the gray of the same `OKLab` lightness, as little as possible, until it is
/// displayable, or no farther from that than `before` was.
pub fn in_gamut(c: Rgb, lab_lightness: f64, before: Rgb) -> Rgb {
    let gray = lab_lightness.powi(3);
    let low = smallest(before).min(0.0).min(gray);
    let high = largest(before).max(1.0).max(gray);
    let kept = c
        .into_iter()
        .map(|x| match x {
            x if x > high => (high - gray) / (x - gray),
            x if x < low => (gray - low) / (gray - x),
            _ => 1.0,
        })
        .fold(1.0, f64::min);
    c.map(|x| super::mix(gray, x, kept))
}

/// Tones of cyan, magenta, yellow and black ink for a color of 0 to 1. `black`: fraction of
/// the darkness that all channels share which black takes.
pub fn separated(c: Rgb, black: f64) -> [f64; 4] {
    let k = black * (1.0 - largest(c));
    if k >= 1.0 {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let [cyan, magenta, yellow] = c.map(|light| 1.0 - light / (1.0 - k));
    [cyan, magenta, yellow, k]
}

fn apply(m: [Rgb; 3], v: Rgb) -> Rgb {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}
