//! Reference of `effects/colorization/colorization.wgsl` (\[CS\] Eq. 8 to 11).

use super::{
    Rgb,
    color::{
        hue_color, hue_of, largest, linear_to_oklab, oklab_to_linear, smallest, srgb_decode,
        srgb_encode,
    },
    mix,
};
use bevy::color::{Color, Hsva};
use bevy_comics::{
    Colorization,
    effects::{ColorizationMode, Equations},
};

fn linear_of(color: Color) -> Rgb {
    let c = color.to_linear();
    [c.red, c.green, c.blue].map(f64::from)
}

/// (lightness, chroma) in `OKLab` of the displayable color with the most chroma
/// in the direction (`a`, `b`), a unit vector. Bisection finds the largest ratio of
/// chroma to lightness at which no linear component is negative; the lightness
/// then makes the largest component 1.
fn cusp(a: f64, b: f64) -> (f64, f64) {
    let at = |s: f64| oklab_to_linear([1.0, s * a, s * b]);
    let (mut low, mut high) = (0.0f64, 2.0f64);
    while high - low > 1e-14 {
        let s = low.midpoint(high);
        if smallest(at(s)) >= 0.0 {
            low = s;
        } else {
            high = s;
        }
    }
    let lightness = largest(at(low)).recip().cbrt();
    (lightness, lightness * low)
}

/// The most chroma that is displayable at the lightness `l`. The gamut is
/// approximated by the triangle black, cusp, white.
fn room(l: f64, cusp: (f64, f64)) -> f64 {
    cusp.1 * (l / cusp.0).min((1.0 - l) / (1.0 - cusp.0)).clamp(0.0, 1.0)
}

/// (unit direction of the atmosphere's chroma, lightness of the cusp of its hue,
/// the atmosphere's chroma scaled to the cusp).
pub fn atmosphere(color: Color) -> ([f64; 2], f64, f64) {
    let [l, a, b] = linear_to_oklab(linear_of(color));
    let chroma = a.hypot(b);
    if chroma <= 1e-4 {
        return ([1.0, 0.0], cusp(1.0, 0.0).0, 0.0);
    }
    let direction = [a / chroma, b / chroma];
    let cusp = cusp(direction[0], direction[1]);
    let fraction = if room(l, cusp) > 1e-6 {
        (chroma / room(l, cusp)).min(1.0)
    } else {
        0.0
    };
    (direction, cusp.0, cusp.1 * fraction)
}

/// `d`, `l`: depth map and its complement; `saturation`: fraction of the saturation
/// that desaturation left.
pub fn colorize(s: &Colorization, linear: Rgb, d: f64, l: f64, saturation: f64) -> Rgb {
    if s.mode == ColorizationMode::KeepHue {
        return linear;
    }
    let amount = f64::from(s.amount);
    if s.equations == Equations::Faithful {
        let c = srgb_encode(linear);
        let (v, chroma) = (largest(c), largest(c) - smallest(c));
        let atmosphere = f64::from(Hsva::from(s.color).hue) / 360.0;
        let hue = match s.mode {
            ColorizationMode::Linear => hue_of(c) * l + atmosphere * d,
            ColorizationMode::SquareRoot => hue_of(c) * l.sqrt() + atmosphere * d.sqrt(),
            _ => atmosphere,
        };
        let p = hue_color(hue);
        let tinted = p.map(|p| v - chroma * (1.0 - p));
        return srgb_decode(std::array::from_fn(|i| mix(c[i], tinted[i], amount)));
    }
    let lab = linear_to_oklab(linear);
    let (direction, lightness, chroma) = atmosphere(s.color);
    let mut atmosphere = direction.map(|x| x * room(lab[0], (lightness, chroma)));
    let w = match s.mode {
        ColorizationMode::Atmosphere => {
            atmosphere = atmosphere.map(|x| x * saturation);
            1.0
        }
        ColorizationMode::Linear => d,
        _ => d.sqrt() / (d.sqrt() + l.sqrt()),
    } * amount;
    oklab_to_linear([
        lab[0],
        mix(lab[1], atmosphere[0], w),
        mix(lab[2], atmosphere[1], w),
    ])
}
