//! What strokes on surfaces look like: for the effect `Hatching` and the toon material.

use bevy::{math::DVec3, prelude::*, render::render_resource::ShaderType};

/// `Strokes` in `strokes.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Strokes {
    pub(crate) axes: Mat3,
    pub(crate) ink: Vec3,
    pub(crate) opacity: f32,
    pub(crate) paper: Vec3,
    pub(crate) spacing: f32,
    pub(crate) length: f32,
    pub(crate) layers: u32,
    pub(crate) layer_darkness: f32,
    pub(crate) solid_below: f32,
    pub(crate) bare_above: f32,
    pub(crate) gamma: f32,
    pub(crate) levels: f32,
    pub(crate) breaks: f32,
    pub(crate) wobble: f32,
    pub(crate) pressure: f32,
    pub(crate) seed: u32,
    pub(crate) ground: u32,
}

/// Coordinates of a place along the directions of marks. The numbers of these: of each axis; of the
/// sum and the difference of each two axes, from 3 on.
pub(crate) fn stroke_eyes(axes: [DVec3; 3], place: DVec3) -> [IVec4; 15] {
    let [x, y, z] = axes;
    let between = [(x, y), (x, z), (y, z)].map(|(a, b)| [a + b, a - b].map(DVec3::normalize));
    eyes(axes.into_iter().chain(between.into_iter().flatten()), place)
}

/// The same for dots: `2 (3 layer + plane)` is the number of the first direction of a lattice.
pub(crate) fn dot_eyes(axes: [DVec3; 3], place: DVec3) -> [IVec4; 15] {
    let directions = (0..15).flat_map(|lattice| {
        let (sin, cos) = (0.35 + 0.6 * f64::from(lattice / 3)).sin_cos();
        let [a, b] = [1, 2].map(|by| axes[(lattice as usize + by) % 3]);
        [a * cos + b * sin, b * cos - a * sin]
    });
    eyes(directions, place)
}

fn eyes(directions: impl Iterator<Item = DVec3>, place: DVec3) -> [IVec4; 15] {
    let mut split = directions.map(|direction| split(direction.dot(place)));
    std::array::from_fn(|_| {
        let [a, b] = [(); 2].map(|()| split.next().unwrap_or_default());
        IVec4::new(a.x, a.y, b.x, b.y)
    })
}

/// A coordinate for `place_of_split` in `nested.wgsl`.
fn split(x: f64) -> IVec2 {
    let units = 4096.0 * x;
    let rest = (units - units.floor()) * 16_777_216.0;
    // Modulo 2^32, as an i32 has it.
    let whole = units.floor().rem_euclid(4_294_967_296.0);
    IVec2::new((whole as u32).cast_signed(), rest as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that an f64 has exactly, up to 2^39 and down to 2^-36.
    #[test]
    fn coordinates_are_split_exactly() {
        let mut random = 1u64;
        for _ in 0..10_000 {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            // Units of 2^-36.
            let exact = i128::from(random.cast_signed() >> 12) << (random % 24);
            let x = exact as f64 / 68_719_476_736.0;
            let found = split(x);
            let whole = (exact >> 24) as i32;
            assert_eq!(
                (found.x, found.y as i128),
                (whole, exact & 0xff_ffff),
                "{x}"
            );
        }
    }
}
