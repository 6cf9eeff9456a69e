//! Reference of `toon/octahedral.wgsl`.

use bevy::math::DVec3;

/// The point of the surface `|x| + |y| + |z| = 1` above or below a
/// place of the square, whose lower half is folded outwards over the four edges.
pub fn octahedral(place: [f64; 2]) -> [f64; 3] {
    let [x, y] = place;
    let z = 1.0 - x.abs() - y.abs();
    // Mirrored at the edge of its quadrant: (x, y) becomes (1 - y, 1 - x) where both are positive.
    let [sx, sy] = place.map(|c| if c < 0.0 { -1.0 } else { 1.0 });
    let point = match z >= 0.0 {
        true => DVec3::new(x, y, z),
        false => DVec3::new(sx * (1.0 - sy * y), sy * (1.0 - sx * x), z),
    };
    point.normalize().to_array()
}
