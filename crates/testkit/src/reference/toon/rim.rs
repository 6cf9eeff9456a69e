//! Reference of `toon/rim.wgsl`.

use bevy_comics::toon::{Rim, RimWidth};

use super::super::{light::edge_at, mix, smoothstep};

/// How much of the rim there is on a side. `cosine` is that between normal and light.
pub fn rim_side(rim: &Rim, cosine: f64) -> f64 {
    mix(1.0, smoothstep(-0.2, 0.4, cosine), f64::from(rim.lit_side))
}

/// A rim where the surface turns away from the eye. `cosine` is that between normal and eye,
/// `width` its change over a pixel.
pub fn facing_rim(rim: &Rim, cosine: f64, width: f64) -> f64 {
    let RimWidth::Facing { share, softness } = rim.width else {
        panic!("a rim of constant width");
    };
    let [share, softness] = [share, softness].map(f64::from);
    edge_at(1.0 - share, 1.0 - cosine.abs(), width.max(softness))
}

/// Whether what is this many times as far away is behind a surface that recedes by `slope` of its
/// distance.
pub fn is_behind(ratio: f64, slope: f64) -> f64 {
    smoothstep(1.01, 1.03, ratio - 2.5 * slope.max(0.0))
}
