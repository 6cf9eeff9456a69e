//! Reference of `effect/footprint.wgsl`.

use bevy::math::DVec2;

/// The singular values of a change, by the angle at which its length is extreme: by another way
/// than the shader.
pub fn singular_values(right: DVec2, down: DVec2) -> [f64; 2] {
    let cross = right.dot(down);
    let angle = 0.5 * (2.0 * cross).atan2(right.length_squared() - down.length_squared());
    let [long, short] = [angle, angle + std::f64::consts::FRAC_PI_2]
        .map(|angle| (right * angle.cos() + down * angle.sin()).length());
    [long.max(short), long.min(short)]
}
