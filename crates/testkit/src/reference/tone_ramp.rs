//! Reference of `effects/tone_ramp/tone_ramp.wgsl`.

use bevy::color::Color;
use bevy_comics::ToneRamp;

use super::{
    Rgb,
    color::{lightness, linear_to_oklab, oklab_to_linear},
    mix, smoothstep,
};

/// How much of the near tones there is at a place of the depth map.
pub fn tone_detail(s: &ToneRamp, depth: f64) -> f64 {
    let away = (depth - f64::from(s.focus)).abs();
    1.0 - (away / f64::from(s.reach)).clamp(0.0, 1.0)
}

fn tone(near: Color, far: Color, detail: f64) -> Rgb {
    let lab = |color: Color| {
        let c = color.to_linear();
        linear_to_oklab([c.red, c.green, c.blue].map(f64::from))
    };
    let (near, far) = (lab(near), lab(far));
    let mixed = oklab_to_linear(std::array::from_fn(|c| mix(far[c], near[c], detail)));
    mixed.map(|c| c.max(0.0))
}

/// The picture in tones.
pub fn toned(s: &ToneRamp, linear: Rgb, change: f64, detail: f64) -> Rgb {
    let between = |near: f32, far: f32| mix(f64::from(far), f64::from(near), detail);
    let width = between(s.softness, s.distant_softness).max(change.max(8.0 / 255.0));
    let y = lightness(linear);
    let above = |at: f64| smoothstep(at - 0.5 * width, at + 0.5 * width, y);
    let middle = above(between(s.middle_at, s.distant_middle_at));
    let light = above(between(s.light_at, s.distant_light_at));
    let tones = [
        tone(s.dark, s.distant_dark, detail),
        tone(s.middle, s.distant_middle, detail),
        tone(s.light, s.distant_light, detail),
    ];
    let brightest = linear.into_iter().fold(0.0, f64::max);
    std::array::from_fn(|c| {
        let tone = mix(mix(tones[0][c], tones[1][c], middle), tones[2][c], light);
        let own = if brightest > 1e-6 {
            linear[c] / brightest
        } else {
            1.0
        };
        let kept = mix(1.0, own, f64::from(s.keep_color));
        mix(linear[c], tone * kept, f64::from(s.amount))
    })
}
