//! The places of objects in the depth map.

use bevy_comics_testkit::reference::depths;

use super::*;

/// In an infinite perspective whose near plane is at 0.1, and in an orthographic view of 200 units.
#[test]
fn the_places_of_objects_match_the_reference() {
    let row = (
        any::<bool>(),
        -20.0f32..150.0,
        0.0f32..40.0,
        0.2f32..10.0,
        11.0f32..120.0,
    )
        .prop_map(|(orthographic, distance, reach, near, far)| {
            let raw = |z: f32| {
                if orthographic {
                    1.0 - z / 200.0
                } else {
                    0.1 / z
                }
            };
            let flag = f32::from(u8::from(orthographic));
            [flag, distance, reach, raw(near), raw(far)]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::depth::map::{DepthFrame, ORTHOGRAPHIC}
             #import bevy_comics::objects::depths::{kept_place, object_place}",
            "let o = i(0u) != 0.0;
             let f = DepthFrame(i(3u), i(4u), 0.0, 0.0, 200.0, 200.0, 0.0, select(0u, ORTHOGRAPHIC, o));
             let axis = select(vec2(0.1, 0.0), vec2(200.0, -200.0), o);
             let place = object_place(f, axis, o, i(1u), i(2u));
             return vec4(place, kept_place(place.x + 0.02, place.x), kept_place(0.0, place.x));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [orthographic, distance, reach, near, far] = row.map(f64::from);
            let is_orthographic = orthographic != 0.0;
            let frame = Frame {
                projection: if is_orthographic {
                    Projection::Orthographic {
                        plane_far: 200.0,
                        extent: 200.0,
                    }
                } else {
                    Projection::Perspective { offset: 0.0 }
                },
                ends: Some([near, far]),
                logarithmic: false,
                floor: 0.0,
                sky_gap: 0.0,
            };
            let raw = |z: f64| {
                if is_orthographic {
                    1.0 - z / 200.0
                } else {
                    0.1 / z
                }
            };
            let reference = depths::object_place(&frame, raw, distance, reach);
            // Raw depth has an error of an ulp of 1, which the shortest range, a unit of 200 or
            // the reciprocal of 10, makes 200 times as large; an extent has two, and
            // smoothstep's slope is 10.
            let error = 2f64.powi(-23) * 200.0;
            assert!(
                (f64::from(found[0]) - reference[0]).abs() < 2.0 * error
                    && (f64::from(found[1]) - reference[1]).abs() < 40.0 * error,
                "{row:?}: {found:?}, {reference:?}"
            );
            let [place, near_it, far_from_it] = [found[0], found[2], found[3]];
            let ignored = (0.15 * place).min(0.03);
            let wanted = place + ignored.min(0.02);
            assert!((near_it - wanted).abs() < 1e-6, "{row:?}: {found:?}");
            assert!(
                (far_from_it - place + ignored).abs() < 1e-6,
                "{row:?}: {found:?}"
            );
        }
    });
}
