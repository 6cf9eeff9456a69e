//! Twin of `effects/desaturation/desaturation.wgsl` ([CS] Eq. 5 to 7).

use super::{
    Rgb,
    color::{largest, luminance, srgb_decode, srgb_encode},
};
use bevy_comics::{Desaturation, Form};

pub fn saturation_left(s: &Desaturation, l: f64) -> f64 {
    let k = l.max(0.0).powf(f64::from(s.exponent));
    1.0 - f64::from(s.amount) * (1.0 - k)
}

pub fn desaturate(s: &Desaturation, linear: Rgb, k: f64) -> Rgb {
    match s.form {
        Form::Faithful => {
            // f_v = t_v, f_s = t_s k, through the definition of HSV: with V and
            // hue kept, every component keeps its place between V and V - C.
            let c = srgb_encode(linear);
            let v = largest(c);
            srgb_decode(c.map(|x| v - (v - x) * k))
        }
        Form::Corrected => {
            let y = luminance(linear);
            linear.map(|x| y + (x - y) * k)
        }
    }
}
