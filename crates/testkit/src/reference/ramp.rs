//! Reference of `toon/ramp.wgsl`.

use bevy_comics::toon::Ramp;

use super::{Rgb, light::edge_at, mix};

/// The tone where `arriving` of the light arrives. `width` is its change over a pixel.
pub fn tone(ramp: &Ramp, arriving: f64, width: f64) -> Rgb {
    let ramp = ramp.clone().sanitized();
    let color = |k: usize| {
        let color = ramp.stops[k].color.to_linear();
        [color.red, color.green, color.blue].map(f64::from)
    };
    let mut tone = color(0);
    for (k, stop) in ramp.stops.iter().enumerate().skip(1) {
        let wide = f64::from(stop.softness).max(width);
        let above = edge_at(f64::from(stop.at), arriving, wide);
        tone = std::array::from_fn(|c| mix(tone[c], color(k)[c], above));
    }
    tone
}

/// The same with `lit` of the light arriving, as far as shadows of other things go: the tones on
/// both sides of the border of a shadow are mixed.
pub fn shadowed_tone(ramp: &Ramp, arriving: f64, width: f64, lit: f64) -> Rgb {
    let lowest = tone(ramp, -1e9, 0.0);
    let full = tone(ramp, arriving, width);
    let highest = (ramp.clone().sanitized().stops.iter().skip(1))
        .map(|stop| {
            let wide = f64::from(stop.softness).max(width);
            edge_at(f64::from(stop.at), arriving, wide)
        })
        .fold(0.0, f64::max);
    // Where an edge and the border of the shadow meet in a pixel, the darker one counts.
    let kept = if highest > 0.0 {
        lit.min(highest) / highest
    } else {
        0.0
    };
    std::array::from_fn(|c| mix(lowest[c], full[c], kept))
}
