//! Reference of `effects/desaturation/desaturation.wgsl` (\[CS\] Eq. 5 to 7).

use super::{
    Rgb,
    color::{largest, luminance, srgb_decode, srgb_encode},
};
use bevy_comics::{Desaturation, effects::Equations};

/// Fraction of the saturation that is left; `l`: complement of the depth map.
pub fn saturation_left(s: &Desaturation, l: f64) -> f64 {
    let k = l.max(0.0).powf(f64::from(s.exponent));
    let [near, far] = [s.amount_near, s.amount].map(f64::from);
    1.0 - (near + (far - near) * (1.0 - k))
}

pub fn desaturate(s: &Desaturation, linear: Rgb, k: f64) -> Rgb {
    match s.equations {
        Equations::Faithful => {
            // Eq. 5 scales the saturation by k and keeps hue and value V. In HSV,
            // this scales the distance of every component from V by k.
            let c = srgb_encode(linear);
            let v = largest(c);
            srgb_decode(c.map(|x| v - (v - x) * k))
        }
        Equations::Corrected => {
            let y = luminance(linear);
            linear.map(|x| y + (x - y) * k)
        }
    }
}
