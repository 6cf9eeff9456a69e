//! Reference of `effects/iso_lines/iso_lines.wgsl`.

use bevy::math::{DMat4, DVec3, DVec4};
use bevy_comics::{IsoLines, effects::IsoField};

use super::{edge::line_coverage, smoothstep};

/// The world position at a place in normalized device coordinates, where the depth texture
/// has `d`.
pub fn iso_place(world_from_clip: DMat4, place: [f64; 2], d: f64) -> DVec3 {
    let h = world_from_clip * DVec4::new(place[0], place[1], d, 1.0);
    h.truncate() / h.w
}

/// The value at a world position. `map`: the depth map there.
pub fn iso_value(s: &IsoLines, p: DVec3, map: f64) -> f64 {
    match s.field {
        IsoField::Depth => map,
        IsoField::Height => p.y,
        _ => p.distance(s.center.as_dvec3()),
    }
}

/// How exact the value is.
pub fn iso_error(s: &IsoLines, p: DVec3) -> f64 {
    match s.field {
        IsoField::Depth => 1e-6,
        _ => 1e-6 * p.abs().max_element(),
    }
}

/// Coverage of the line nearest to a pixel with this value, its change over a pixel, and its
/// error.
/// `scale`: physical pixels per logical pixel.
pub fn iso_coverage(s: &IsoLines, value: f64, change: [f64; 2], error: f64, scale: f64) -> f64 {
    let step = f64::from(s.step);
    let line = (value / step).round();
    let density = change[0].hypot(change[1]) / step;
    if density >= 0.5 {
        return 0.0;
    }
    let least = (error / step).max(5e-4);
    let is_major = s.major > 0 && line as i64 % i64::from(s.major) == 0;
    let width = if is_major { s.major_width } else { s.width };
    let away = (value / step - line).abs() / density.max(1e-6);
    let coverage = line_coverage(away, 0.5 * f64::from(width) * scale);
    coverage * (1.0 - smoothstep(0.25, 0.5, density)) * smoothstep(least, 4.0 * least, density)
}
