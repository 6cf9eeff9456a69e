//! Reference of `toon/shadow_texels.wgsl`.

use bevy::math::{DMat2, DVec2};

/// The engine's Gaussian filter of flat shadow maps at a place in texels: nine bilinear samples, as
/// it reads them. `texel`: the shadow in the texel with a column and a row.
pub fn filtered(texel: impl Fn(i64, i64) -> f64, at: DVec2) -> f64 {
    let bilinear = |at: DVec2| {
        let first = (at - 0.5).floor();
        let part = at - 0.5 - first;
        let of = |x: i64, y: i64| texel(first.x as i64 + x, first.y as i64 + y);
        let row = |y| of(0, y) + (of(1, y) - of(0, y)) * part.x;
        row(0) + (row(1) - row(0)) * part.y
    };
    let corner = (at + 0.5).floor();
    let part = at + 0.5 - corner;
    // Weights and places of the three samples of a row (Castaño 2013).
    let samples = |s: f64| {
        let [first, last] = [4.0 - 3.0 * s, 1.0 + 3.0 * s];
        [
            (first, (3.0 - 2.0 * s) / first - 2.0),
            (7.0, (3.0 + s) / 7.0),
            (last, s / last + 2.0),
        ]
    };
    let mut sum = 0.0;
    for (wy, y) in samples(part.y) {
        for (wx, x) in samples(part.x) {
            sum += wx * wy * bilinear(corner - 0.5 + DVec2::new(x, y));
        }
    }
    sum / 144.0
}

/// The eight samples of cube maps: the places that Direct3D 11 has for eight samples per pixel, in
/// parts of half the pattern's width, and the engine's weights.
pub const SAMPLES: [(DVec2, f64); 8] = [
    (DVec2::new(0.125, -0.375), 0.157112),
    (DVec2::new(-0.125, 0.375), 0.157112),
    (DVec2::new(0.625, 0.125), 0.138651),
    (DVec2::new(-0.375, -0.625), 0.130251),
    (DVec2::new(-0.625, 0.625), 0.114946),
    (DVec2::new(-0.875, -0.125), 0.114946),
    (DVec2::new(0.375, 0.875), 0.107982),
    (DVec2::new(0.875, -0.875), 0.079001),
];

/// The slope of the plane that is nearest to eight samples, by least squares.
pub fn nearest_plane(samples: [f64; 8]) -> DVec2 {
    let all: f64 = SAMPLES.iter().map(|(_, weight)| weight).sum();
    let middle = SAMPLES
        .iter()
        .map(|(at, weight)| *at * *weight)
        .sum::<DVec2>()
        / all;
    let mut spread = DMat2::ZERO;
    let mut sum = DVec2::ZERO;
    for ((at, weight), sample) in SAMPLES.into_iter().zip(samples) {
        let away = at - middle;
        spread += DMat2::from_cols(away * away.x, away * away.y) * weight;
        sum += away * weight * sample;
    }
    spread.inverse() * sum
}
