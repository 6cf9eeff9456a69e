//! Reference of `toon/light_textures.wgsl`.

use bevy::math::{DVec2, DVec3};

/// Where the ray from a spot light through a place meets its picture, which fills the square around
/// its outer cone, seen from the light. The light shines along -Z.
pub fn spot_uv(place: DVec3, tan_angle: f64) -> DVec2 {
    let ahead = -place.z;
    let at = DVec2::new(place.x, place.y) / (ahead * tan_angle);
    DVec2::new(0.5 * (1.0 + at.x), 0.5 * (1.0 - at.y))
}

/// Where a place lies in the picture of a directional light, which is two units wide.
pub fn directional_uv(place: DVec3) -> DVec2 {
    DVec2::new(0.5 * (1.0 - place.x), 0.5 * (1.0 + place.y))
}
