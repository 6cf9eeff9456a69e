//! Reference of `toon/detail.wgsl`, and of the mixture of two ramps in `toon/ramp.wgsl`.

use bevy_comics::toon::{DetailAxis, Ramp, RampStop};

use super::{
    Rgb,
    color::{linear_to_oklab, oklab_to_linear},
    light::edge_at,
    mix,
};

/// How much detail there is. `at` is the distance from the eye along the view axis or the cosine
/// that the axis asks for.
pub fn detail(axis: DetailAxis, at: f64) -> f64 {
    match axis {
        DetailAxis::Depth { from: near, ratio } => {
            1.0 - (at / f64::from(near)).ln() / f64::from(ratio).ln()
        }
        DetailAxis::Focus {
            distance,
            clear,
            ratio,
        } => {
            let away = (at / f64::from(distance)).ln().abs() - f64::from(clear).ln_1p();
            1.0 - away / f64::from(ratio).ln()
        }
        DetailAxis::Rim { power } => at.abs().powf(f64::from(power)),
        DetailAxis::Highlight { power } => at.max(0.0).powf(f64::from(power)),
        DetailAxis::Constant(detail) => f64::from(detail),
        DetailAxis::VisibleRange => panic!("the range of a view is needed: see `in_range`"),
        _ => panic!("an axis without a reference"),
    }
    .clamp(0.0, 1.0)
}

/// How much detail there is at a distance, between the ends of the visible range.
pub fn in_range(z: f64, near: f64, far: f64) -> f64 {
    (1.0 - (z / near).ln() / (far / near).ln()).clamp(0.0, 1.0)
}

/// The tone of a ramp and its second ramp, with as many stops each.
pub fn tone(ramp: &Ramp, plain: &[RampStop], detail: f64, arriving: f64, width: f64) -> Rgb {
    let lab = |stop: &RampStop| {
        let color = stop.color.to_linear();
        linear_to_oklab([color.red, color.green, color.blue].map(f64::from))
    };
    let between = |plain: f32, full: f32| mix(f64::from(plain), f64::from(full), detail);
    let mut tone = [0.0; 3];
    for (k, (full, plain)) in ramp.stops.iter().zip(plain).enumerate() {
        let (a, b) = (lab(plain), lab(full));
        let color = oklab_to_linear(std::array::from_fn(|c| mix(a[c], b[c], detail)));
        let color = color.map(|c| c.max(0.0));
        let wide = between(plain.softness, full.softness).max(width);
        let above = match k {
            0 => 1.0,
            _ => edge_at(between(plain.at, full.at), arriving, wide),
        };
        tone = std::array::from_fn(|c| mix(tone[c], color[c], above));
    }
    tone
}
