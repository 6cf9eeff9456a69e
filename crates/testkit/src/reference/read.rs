//! Reference of `lines/draw/read.wgsl`: the drawn lines at a place.

use super::{Rgb, Rgba, draw::Ink, mix, over};
use bevy_comics::Outlines;

/// The ink at the center of a pixel, or between the centers of four, by kind. `at` is in
/// pixels of the viewport.
pub fn lines_at(ink: &Ink, at: [f64; 2], anywhere: bool, nudge: f64) -> [f64; 3] {
    if !anywhere {
        return ink.texel(at[0].floor() as i64, at[1].floor() as i64, nudge);
    }
    let corner = at.map(|v| (v - 0.5).floor());
    let f = [0, 1].map(|i: usize| at[i] - 0.5 - corner[i]);
    let texel = |i: i64, j: i64| ink.texel(corner[0] as i64 + i, corner[1] as i64 + j, nudge);
    let row = |j: i64| {
        let (a, b) = (texel(0, j), texel(1, j));
        [0, 1, 2].map(|k: usize| mix(a[k], b[k], f[0]))
    };
    let (above, below) = (row(0), row(1));
    std::array::from_fn(|k| mix(above[k], below[k], f[1]))
}

/// (opacity, color) of silhouettes, object edges and creases, in this order.
fn strength(s: &Outlines, ink: [f64; 3]) -> [(f64, Rgb); 3] {
    let rgb = |color: bevy::color::Color| {
        let c = color.to_linear();
        [c.red, c.green, c.blue].map(f64::from)
    };
    let (a, b, c) = (
        s.silhouettes.unwrap_or_default(),
        s.creases.unwrap_or_default(),
        s.objects.unwrap_or_default(),
    );
    [
        (ink[0] * f64::from(a.opacity), rgb(a.color)),
        (ink[2] * f64::from(c.opacity), rgb(c.color)),
        (ink[1] * f64::from(b.opacity), rgb(b.color)),
    ]
}

/// The picture with the strongest line drawn over it. Of lines whose opacity differs
/// by at most 0.01, the silhouette is drawn, else the object edge.
pub fn draw(s: &Outlines, picture: Rgba, ink: [f64; 3]) -> Rgba {
    let kinds = strength(s, ink);
    let mut best = kinds[0];
    for kind in kinds {
        if kind.0 > best.0 + 0.01 {
            best = kind;
        }
    }
    over(picture, best.1, best.0)
}

/// The opacity of the strongest line.
pub fn total(s: &Outlines, ink: [f64; 3]) -> f64 {
    strength(s, ink)
        .map(|k| k.0)
        .into_iter()
        .fold(0.0, f64::max)
}
