//! How much of a line the engine's distance fog hides.

use bevy::math::Vec4Swizzles;
use bevy_comics_testkit::reference::fog::{Falloff, fog_fraction};

use super::*;
use crate::prelude::*;

const FOG: &str = "#import bevy_comics::lines::fog::{Fog, fog_distance, fog_fraction}";

/// Every falloff at distances from 0 to infinity: that of the reference, which is the engine's
/// formula; no fog at 0, and never more than the opacity of the fog's colour.
#[test]
fn fog_grows_with_distance() {
    let row = (
        0u32..4,
        0.001f32..50.0,
        0.001f32..50.0,
        0.0f32..=1.0,
        0.0f32..1000.0,
    )
        .prop_map(|(falloff, a, b, most, distance)| [falloff as f32, a, a + b, most, distance]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            FOG,
            "var f: Fog;
             f.falloff = u(0u);
             f.numbers = vec3(i(1u), i(2u), 0.5 * (i(1u) + i(2u)));
             if f.falloff == 3u { f.numbers *= 0.02; }
             f.most = i(3u);
             return vec4(
                 fog_fraction(f, i(4u)), fog_fraction(f, 0.0),
                 fog_fraction(f, 2.0 * i(4u)), fog_fraction(f, 3e38),
             );",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [kind, a, b, most, distance] = row.map(f64::from);
            let falloff = match kind as u32 {
                0 => Falloff::Linear { start: a, end: b },
                1 => Falloff::Exponential { density: a },
                2 => Falloff::ExponentialSquared { density: a },
                _ => Falloff::Atmospheric([a, b, 0.5 * (a + b)].map(|e| 0.02 * e)),
            };
            let want = fog_fraction(falloff, most, distance);
            assert!(
                (f64::from(found[0]) - want).abs() < 1e-4,
                "{row:?}: {found:?}, {want}"
            );
            assert!(found[1].abs() < 1e-6, "{row:?}: {found:?}");
            assert!(found[2] >= found[0] - 1e-6, "{row:?}: {found:?}");
            assert!((found[3] - row[3]).abs() < 1e-6, "{row:?}: {found:?}");
        }
    });
}

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
        let points: Vec<[f32; 16]> = rows
            .iter()
            .map(|[x, y, z, kind]| {
                let m = cameras[*kind as usize];
                let clip = m * Vec3::new(*x, *y, -z).extend(1.0);
                let seen = clip.xyz() / clip.w;
                let orthographic = *kind == 2.0;
                let (scale, shift) = (m.z_axis.z, m.w_axis.z);
                let axis = if orthographic {
                    [shift / scale, -1.0 / scale]
                } else {
                    [shift, scale]
                };
                let column = if orthographic { -m.w_axis } else { m.z_axis };
                let ray = [m.x_axis.x.recip(), m.y_axis.y.recip()];
                let moved = [column.x * ray[0], column.y * ray[1]];
                let flag = if orthographic { 1.0 } else { 0.0 };
                let distance = Vec3::new(*x, *y, *z).length();
                [
                    ray[0], ray[1], moved[0], moved[1], axis[0], axis[1], flag, seen.x, seen.y,
                    seen.z, distance, 0.0, 0.0, 0.0, 0.0, 0.0,
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
