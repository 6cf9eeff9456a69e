//! How screens follow objects.

use bevy::math::Quat;
use bevy_comics_testkit::reference::similarity::similarity_of;

use super::*;
use crate::prelude::*;

const SIMILARITY: &str = "#import bevy_comics::effect::similarity::similarity_of";

/// A view from 8 units away and above, an orthographic one, and one off its axis.
fn views() -> [Mat4; 3] {
    let eye = Mat4::look_at_rh(Vec3::new(3.0, 4.0, 8.0), Vec3::ZERO, Vec3::Y);
    [
        Mat4::perspective_infinite_reverse_rh(0.8, 16.0 / 9.0, 0.1) * eye,
        Mat4::orthographic_rh(-8.0, 8.0, -4.5, 4.5, 100.0, 0.1) * eye,
        Mat4::frustum_rh(-0.2, 0.05, -0.1, 0.06, 0.1, 100.0) * eye,
    ]
}

/// Objects in front of the camera, of any size and rotation. Not whose Y axis nearly points at
/// it: there, rounding decides about the axis. At the border between two octaves, both are seen
/// equally, in either order.
#[test]
fn objects_are_followed_as_by_the_reference() {
    let row = (
        (-3.0f32..3.0, -2.0f32..2.0, -3.0f32..2.0),
        -6.0f32..6.0,
        (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0),
    )
        .prop_map(|((x, y, z), size, (a, b, c, d))| {
            let q = Quat::from_xyzw(a, b, c, d + 1e-3).normalize();
            [x, y, z, size.exp2(), q.x, q.y, q.z, q.w]
        });
    for view in views() {
        let columns = view.to_cols_array().map(|v| format!("{v:?}")).join(", ");
        for_batches(row.clone(), |rows| {
            let call = format!(
                "let f = similarity_of(mat4x4({columns}), vec4(10.0, 20.0, 1280.0, 720.0),
                     vec3(i(0u), i(1u), i(2u)), i(3u), vec4(i(4u), i(5u), i(6u), i(7u)));"
            );
            let sizes = format!("{call} return vec4(f.size, f.other, f.fade, 0.0);");
            let places = format!("{call} return vec4(f.origin, f.turn);");
            let sizes = gpu().evaluate(SIMILARITY, &sizes, rows);
            let places = gpu().evaluate(SIMILARITY, &places, rows);
            for ((row, size), place) in rows.iter().zip(sizes).zip(places) {
                let v = row.map(f64::from);
                let matrix = view.as_dmat4();
                let rotation = DQuat::from_xyzw(v[4], v[5], v[6], v[7]);
                let centre = DVec3::new(v[0], v[1], v[2]);
                let at = similarity_of(matrix, [10.0, 20.0, 1280.0, 720.0], centre, v[3], rotation);
                let want = at.expect("in front of the camera");
                check_size(row, size, [want.size, want.other, want.fade]);
                let place = place.map(f64::from);
                for (found, want) in place.into_iter().zip(want.origin) {
                    assert!((found - want).abs() < 2e-3, "{row:?}: {found}, {want}");
                }
                if (steepness(matrix, rotation) - 0.1).abs() > 1e-3 {
                    let turn = place[3].atan2(place[2]).to_degrees();
                    let off = (turn - want.turn + 540.0).rem_euclid(360.0) - 180.0;
                    assert!(off.abs() < 2e-3, "{row:?}: {turn}, {want:?}");
                }
            }
        });
    }
}

fn check_size(row: &[f32], found: [f32; 4], want: [f64; 3]) {
    let [size, other, fade] = want;
    let near = |want: [f64; 3]| {
        let pairs = found.into_iter().zip(want);
        pairs
            .map(|(a, b)| (f64::from(a) - b).abs())
            .fold(0.0, f64::max)
            < 1e-5
    };
    let at_border = (fade - 0.5).abs() < 1e-5;
    assert!(
        near(want) || at_border && near([other, size, fade]),
        "{row:?}: {found:?}, {want:?}"
    );
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
    let columns = views()[0]
        .to_cols_array()
        .map(|v| format!("{v:?}"))
        .join(", ");
    let found = gpu().evaluate(
        SIMILARITY,
        &format!(
            "let f = similarity_of(mat4x4({columns}), vec4(0.0, 0.0, 1280.0, 720.0),
                 vec3(i(0u)), i(1u), vec4(0.0, 0.0, 0.0, 1.0));
             return vec4(f.size, f.fade, f.turn.x, 0.0);"
        ),
        &[[20.0, 1.0], [0.0, 0.0], [0.0, f32::INFINITY], [0.0, 1.0]],
    );
    for nothing in &found[..3] {
        assert_eq!(nothing[..2], [0.0; 2]);
    }
    assert!(found[3][0] > 0.7);
}
