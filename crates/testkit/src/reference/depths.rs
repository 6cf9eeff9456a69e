//! Reference of `objects/depths.wgsl`: the place of an object in the depth map.

use super::{map::Frame, smoothstep};

/// D of the centre of an object, and how much its pixels follow it. `distance`: of the centre,
/// `reach`: of its nearest and farthest point from there, along the view's axis; `raw`: raw depth
/// at a distance in front of the eye.
pub fn object_place(
    frame: &Frame,
    raw: impl Fn(f64) -> f64,
    distance: f64,
    reach: f64,
) -> [f64; 2] {
    let at = |distance: f64| {
        let raw = if distance > 0.0 {
            raw(distance).clamp(0.0, 1.0)
        } else {
            1.0
        };
        frame.depth_map(raw)[0]
    };
    let extent = at(distance + reach) - at(distance - reach);
    [at(distance), 1.0 - smoothstep(0.25, 0.4, extent)]
}
