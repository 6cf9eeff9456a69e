//! How screens follow objects.

use bevy::math::{DVec4, Vec4Swizzles};
use bevy_comics_testkit::reference::similarity::similarity_of;

use super::*;
use crate::prelude::*;

/// A view from 8 units away and above, an orthographic one, and one off its axis.
fn views() -> [Mat4; 3] {
    let eye = Mat4::look_at_rh(Vec3::new(3.0, 4.0, 8.0), Vec3::ZERO, Vec3::Y);
    [
        Mat4::perspective_infinite_reverse_rh(0.8, 16.0 / 9.0, 0.1) * eye,
        Mat4::orthographic_rh(-8.0, 8.0, -4.5, 4.5, 100.0, 0.1) * eye,
        Mat4::frustum_rh(-0.2, 0.05, -0.1, 0.06, 0.1, 100.0) * eye,
    ]
}

/// What a shader makes of the similarity `f` of objects: place, size and rotation.
fn evaluate(view: Mat4, rows: &[[f32; 8]], result: &str) -> Vec<DVec4> {
    let columns = view.to_cols_array().map(|v| format!("{v:?}")).join(", ");
    let body = format!(
        "let f = similarity_of(mat4x4({columns}), vec4(10.0, 20.0, 1280.0, 720.0),
             vec3(i(0u), i(1u), i(2u)), i(3u), vec4(i(4u), i(5u), i(6u), i(7u)));
         return {result};"
    );
    let import = "#import bevy_comics::effect::similarity::similarity_of";
    let found = gpu().evaluate(import, &body, rows).into_iter();
    found.map(|v| DVec4::from_array(v.map(f64::from))).collect()
}

/// Objects in front of the camera, of any size and rotation. Not whose Y axis nearly points at
/// it: there, rounding decides about the axis. At the border between two octaves, both are seen
/// equally, in either order.
#[test]
fn objects_are_followed_as_by_the_reference() {
    let places = [-3.0f32..3.0, -2.0f32..2.0, -3.0f32..2.0];
    let row = (places, -6.0f32..6.0, vec(-1.0f32..1.0, 4)).prop_map(|([x, y, z], size, turn)| {
        let q = Quat::from_xyzw(turn[0], turn[1], turn[2], turn[3] + 1e-3).normalize();
        [x, y, z, size.exp2(), q.x, q.y, q.z, q.w]
    });
    for view in views() {
        for_batches(row.clone(), |rows| {
            let sizes = evaluate(view, rows, "vec4(f.size, f.other, f.fade, 0.0)");
            let places = evaluate(view, rows, "vec4(f.origin, f.turn)");
            for ((row, size), place) in rows.iter().zip(sizes).zip(places) {
                let [x, y, z, radius, a, b, c, d] = row.map(f64::from);
                let (matrix, rotation) = (view.as_dmat4(), DQuat::from_xyzw(a, b, c, d));
                let viewport = [10.0, 20.0, 1280.0, 720.0];
                let at = similarity_of(matrix, viewport, DVec3::new(x, y, z), radius, rotation);
                let want = at.expect("in front of the camera");
                let of = |size, other| DVec4::new(size, other, want.fade, 0.0);
                let off = |of: DVec4| (size - of).abs().max_element();
                let at_border = (want.fade - 0.5).abs() < 1e-5;
                let is_near = off(of(want.size, want.other)) < 1e-5
                    || at_border && off(of(want.other, want.size)) < 1e-5;
                assert!(is_near, "{row:?}: {size}, {want:?}");
                let away = (place.xy() - DVec2::from_array(want.origin)).abs();
                assert!(away.max_element() < 2e-3, "{row:?}: {place}, {want:?}");
                if (steepness(matrix, rotation) - 0.1).abs() > 1e-3 {
                    let turn = place.w.atan2(place.z).to_degrees();
                    let off = (turn - want.turn + 540.0).rem_euclid(360.0) - 180.0;
                    assert!(off.abs() < 2e-3, "{row:?}: {turn}, {want:?}");
                }
            }
        });
    }
}

/// The length of the Y axis on the page, of that of an axis that lies on it.
fn steepness(matrix: DMat4, rotation: DQuat) -> f64 {
    let seen = matrix * (rotation * DVec3::Y).extend(0.0);
    let page = seen.truncate().truncate() * DVec2::new(1280.0, 720.0);
    page.length() / (720.0 * matrix.row(1).truncate().length())
}

/// Behind the camera, and for what is not a number, there is nothing to follow.
#[test]
fn nothing_behind_the_camera_is_followed() {
    let objects = [[20.0, 1.0], [0.0, 0.0], [0.0, f32::INFINITY], [0.0, 1.0]];
    let rows = objects.map(|[x, size]| [x, x, x, size, 0.0, 0.0, 0.0, 1.0]);
    let found = evaluate(views()[0], &rows, "vec4(f.size, f.fade, 0.0, 0.0)");
    assert_eq!(found[..3], [DVec4::ZERO; 3]);
    assert!(found[3].x > 0.7);
}
