//! Reference of `effects/color_harmony/color_harmony.wgsl`.

use std::f64::consts::PI;

use super::{
    Rgb,
    color::{
        hue_color, hue_of, in_gamut, largest, linear_to_oklab, oklab_to_linear, smallest,
        srgb_decode, srgb_encode,
    },
    mix,
};
use bevy::color::Color;
use bevy_comics::{
    ColorHarmony,
    effects::{Equations, HarmonyCurve, HarmonyMode},
};

/// The unit vector (a, b) of a color's hue in `OKLab`; 0 for grays.
pub fn hue(color: Color) -> [f64; 2] {
    let c = color.to_linear();
    let [_, a, b] = linear_to_oklab([c.red, c.green, c.blue].map(f64::from));
    let chroma = a.hypot(b);
    if chroma > 1e-4 {
        [a / chroma, b / chroma]
    } else {
        [0.0, 0.0]
    }
}

fn weight(s: &ColorHarmony, lightness: f64, d: f64, l: f64) -> f64 {
    match (s.mode, s.curve) {
        (HarmonyMode::Shade, _) => f64::from(s.shade) * (1.0 - lightness.clamp(0.0, 1.0)).powi(2),
        (_, HarmonyCurve::Linear) => d,
        (_, HarmonyCurve::SquareRoot) => d.sqrt() / (d.sqrt() + l.sqrt()),
    }
}

/// The chroma after the whole change.
fn chroma(s: &ColorHarmony, [lightness, a, b]: Rgb, d: f64, l: f64) -> [f64; 2] {
    let [pull, offset] = [s.pull, s.offset].map(f64::from);
    match s.mode {
        HarmonyMode::TwoHues => {
            let [x, y] = hue(s.color);
            // Coordinates along the hue and across.
            let (along, across) = (a * x + b * y, b * x - a * y);
            let (along, across) = if x == 0.0 && y == 0.0 {
                // There is no such line: everything is across.
                return [a * (1.0 - pull), b * (1.0 - pull)];
            } else {
                (along + offset * (l - d), across * (1.0 - pull))
            };
            [along * x - across * y, along * y + across * x]
        }
        HarmonyMode::Rotation => {
            let turn = b.atan2(a) + PI * weight(s, lightness, d, l);
            [a.hypot(b) * turn.cos(), a.hypot(b) * turn.sin()]
        }
        _ => {
            let w = weight(s, lightness, d, l);
            let opposite = -f64::from(s.complement);
            [mix(a, opposite * a, w), mix(b, opposite * b, w)]
        }
    }
}

/// `d`, `l`: depth map and its complement.
pub fn harmonize(s: &ColorHarmony, linear: Rgb, d: f64, l: f64) -> Rgb {
    let amount = f64::from(s.amount);
    if s.equations == Equations::Faithful && s.mode != HarmonyMode::TwoHues {
        let c = srgb_encode(linear);
        let (v, chroma) = (largest(c), largest(c) - smallest(c));
        let p = hue_color(hue_of(c) + weight(s, v, d, l) / 2.0);
        return srgb_decode(std::array::from_fn(|i| {
            mix(c[i], v - chroma * (1.0 - p[i]), amount)
        }));
    }
    let lab = linear_to_oklab(linear);
    let [a, b] = chroma(s, lab, d, l);
    let mixed = [lab[0], mix(lab[1], a, amount), mix(lab[2], b, amount)];
    in_gamut(oklab_to_linear(mixed), lab[0], linear)
}
