//! Reference of `toon/stroke_level.wgsl`.

use bevy::math::DVec2;

use super::footprint::singular_values;

/// The level of strokes along x.
pub fn stroke_level(right: DVec2, down: DVec2) -> f64 {
    let [long, _] = singular_values(right, down);
    right.y.hypot(down.y).max(0.25 * long).log2()
}
