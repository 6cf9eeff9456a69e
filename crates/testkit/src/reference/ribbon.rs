//! Reference of `motion_lines/ribbon.wgsl`.

use bevy::math::{DVec2, DVec4};

/// A place in clip space as a place in the picture, in pixels from its middle, up being positive.
pub fn on_screen(clip: DVec4, size: DVec2) -> DVec2 {
    0.5 * size * clip.truncate().truncate() / clip.w
}

/// The direction of a path on the screen; to the right if it has none.
pub fn direction_on_screen(at: DVec4, beside: DVec4, size: DVec2) -> DVec2 {
    let step = on_screen(beside, size) - on_screen(at, size);
    match step.length() > 0.5e-6 {
        true => step.normalize(),
        false => DVec2::X,
    }
}

/// What a line covers of a pixel at a distance from its middle: the overlap of the line and of the
/// pixel, both as intervals across the line. A line that is thinner than a pixel fades.
pub fn coverage(distance: f64, half_width: f64) -> f64 {
    let thick = half_width.max(0.5);
    let overlap = (distance + 0.5).min(thick) - (distance - 0.5).max(-thick);
    overlap.clamp(0.0, 1.0) * (half_width / 0.5).min(1.0)
}
