//! Twin of `effects/iso_lines/iso_lines.wgsl`.

use bevy::math::{DMat4, DVec3, DVec4};
use bevy_comics::{IsoField, IsoLines};

use super::{edge::line_coverage, smoothstep};

/// The value at a place in normalized device coordinates, where the depth texture has `d`
/// and the depth map is `map`.
pub fn iso_value(s: &IsoLines, world_from_clip: DMat4, place: [f64; 2], d: f64, map: f64) -> f64 {
    let h = world_from_clip * DVec4::new(place[0], place[1], d, 1.0);
    let p: DVec3 = h.truncate() / h.w;
    match s.field {
        IsoField::Depth => map,
        IsoField::Height => p.y,
        _ => p.distance(s.centre.as_dvec3()),
    }
}

/// Coverage of the line nearest to a pixel with this value, and its change over a pixel.
/// `scale`: physical pixels per logical pixel.
pub fn iso_coverage(s: &IsoLines, value: f64, change: [f64; 2], scale: f64) -> f64 {
    let step = f64::from(s.step);
    let line = (value / step).round();
    let density = change[0].hypot(change[1]) / step;
    let is_major = s.major > 0 && line as i64 % i64::from(s.major) == 0;
    let width = if is_major { s.major_width } else { s.width };
    let away = (value / step - line).abs() / density.max(1e-6);
    let coverage = line_coverage(away, 0.5 * f64::from(width) * scale);
    coverage * (1.0 - smoothstep(0.25, 0.5, density)) * smoothstep(5e-4, 2e-3, density)
}

/// The smaller of two slopes of the same sign, otherwise 0.
pub fn flatter(before: f64, after: f64) -> f64 {
    if before * after <= 0.0 {
        0.0
    } else if before.abs() < after.abs() {
        before
    } else {
        after
    }
}
