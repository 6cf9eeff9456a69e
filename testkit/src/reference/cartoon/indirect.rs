//! Twin of `cartoon/indirect.wgsl`.

use bevy::math::DVec3;

use super::super::surroundings;

/// Light of the surroundings in two parts: everywhere, and in addition on the brighter side; and the
/// direction to it. `sides`: light at surfaces that face along +X, -X, +Y, -Y, +Z and -Z; `own`: at the
/// surface. `flat`: how much of it is in two tones.
pub fn light_around(sides: [DVec3; 6], own: DVec3, flat: f64) -> [DVec3; 2] {
    let (bright, dark) = surroundings::two_tones(sides.map(|side| side.to_array()));
    let [bright, dark] = [bright, dark].map(DVec3::from_array);
    [flat * dark + (1.0 - flat) * own, flat * (bright - dark)]
}

/// Ambient light at a mesh.
pub fn ambient(color: DVec3, has_lightmap: bool, affects_lightmapped: bool) -> DVec3 {
    match has_lightmap && !affects_lightmapped {
        true => DVec3::ZERO,
        false => color,
    }
}
