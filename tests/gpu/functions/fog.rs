//! The distance at which the engine's fog hides a line.

use bevy::math::Vec4Swizzles;

use super::*;
use crate::prelude::*;

const FOG: &str = "#import bevy_comics::lines::fog::{Fog, fog_distance}";

/// The distance of points in front of cameras of every kind, from where they are in the
/// picture and their raw depth: the length of their position in view space.
#[test]
fn the_distance_of_a_pixel_is_that_of_its_point() {
    let row = (-1.0f32..1.0, -1.0f32..1.0, 1.0f32..80.0, 0u32..3)
        .prop_map(|(x, y, z, kind)| [x * z, y * z, z, kind as f32]);
    for_batches(row, |rows| {
        let cameras = [
            Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.1),
            // Shifted, with a far plane.
            Mat4::from_cols_array_2d(&[
                [1.2, 0.0, 0.0, 0.0],
                [0.0, 1.7, 0.0, 0.0],
                [0.3, -0.2, 0.1 / 99.9, -1.0],
                [0.0, 0.0, 10.0 / 99.9, 0.0],
            ]),
            // Shifted, orthographic.
            Mat4::orthographic_rh(-30.0, 50.0, -20.0, 40.0, 100.0, 0.1),
        ];
        let points: Vec<[f32; 11]> = rows
            .iter()
            .map(|[x, y, z, kind]| {
                let m = cameras[*kind as usize];
                let clip = m * Vec3::new(*x, *y, -z).extend(1.0);
                let seen = clip.xyz() / clip.w;
                let (scale, shift) = (m.z_axis.z, m.w_axis.z);
                let (axis, column, flag) = match kind {
                    2.0 => ([shift / scale, -1.0 / scale], -m.w_axis, 1.0),
                    _ => ([shift, scale], m.z_axis, 0.0),
                };
                let ray = [m.x_axis.x.recip(), m.y_axis.y.recip()];
                let moved = [column.x * ray[0], column.y * ray[1]];
                let distance = Vec3::new(*x, *y, *z).length();
                [
                    ray[0], ray[1], moved[0], moved[1], axis[0], axis[1], flag, seen.x, seen.y,
                    seen.z, distance,
                ]
            })
            .collect();
        let results = gpu().evaluate(
            FOG,
            "var f: Fog;
             f.ray = vec4(i(0u), i(1u), i(2u), i(3u));
             f.axis = vec2(i(4u), i(5u));
             f.orthographic = u(6u);
             return vec4(fog_distance(f, vec2(i(7u), i(8u)), i(9u)));",
            &points,
        );
        for (point, found) in points.iter().zip(results) {
            let want = point[10];
            assert!((found[0] / want - 1.0).abs() < 2e-3, "{point:?}: {found:?}");
        }
    });
}
