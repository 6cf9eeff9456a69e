//! Twin of `cartoon/contact.wgsl`.

use bevy::math::{DVec2, DVec3};

use super::surface::Surface;

/// The place of the surface at an offset in pixels.
pub fn place_at(s: &Surface, offset: DVec2) -> DVec3 {
    let [right, down] = s.foot.position;
    s.position + offset.x * right + offset.y * down
}

/// What a surface leaves of a light that is this deep behind it, in thicknesses: the shadow is whole up
/// to a half, and fades from there to the whole thickness.
pub fn left_at(depth: f64) -> f64 {
    1.0 - ((1.0 - depth) / 0.5).clamp(0.0, 1.0)
}
