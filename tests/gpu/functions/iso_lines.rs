//! Lines of equal values.

use bevy_comics::effects::IsoField;
use bevy_comics_testkit::reference::iso_lines::{iso_coverage, iso_error, iso_place, iso_value};

use super::*;
use crate::prelude::*;

const ISO: &str = "#import bevy_comics::effects::iso_lines::{
        IsoLines, iso_coverage, iso_error, iso_place, iso_value,
    }
    #import bevy_comics::depth::window::minmod";

/// Away from the middle between two lines, where rounding decides which one is nearest.
#[test]
fn the_coverage_of_lines_matches_the_reference() {
    let row = (
        -30.0f32..=30.0,
        -0.4f32..=0.4,
        -0.4f32..=0.4,
        0.05f32..=4.0,
        0u32..=7,
    )
        .prop_map(|(value, x, y, step, major)| {
            [value * step, x * step, y * step, step, major as f32]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            ISO,
            "var s: IsoLines;
             s.step = i(3u); s.major = i32(u(4u)); s.half_width = 0.5; s.major_half_width = 1.25;
             return vec4(iso_coverage(s, i(0u), vec2(i(1u), i(2u)), 0.003), minmod(i(1u), i(2u)), 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let s = IsoLines {
                step: row[3],
                major: row[4] as u32,
                major_width: 2.5,
                ..IsoLines::default()
            };
            let [value, x, y] = [0, 1, 2].map(|i| f64::from(row[i]));
            let from_middle = ((value / f64::from(s.step)).fract().abs() - 0.5).abs();
            let want = iso_coverage(&s, value, [x, y], 0.003, 1.0);
            if from_middle > 1e-3 {
                assert!(
                    (f64::from(found[0]) - want).abs() < 2e-3,
                    "{row:?}: {found:?}, {want}"
                );
            }
            assert_eq!(f64::from(found[1]), window::minmod(x, y), "{row:?}");
        }
    });
}

/// Positions from every direction, in a perspective view.
#[test]
fn values_are_those_of_the_world() {
    let clip_from_view = Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.1);
    let eye = Mat4::look_at_rh(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO, Vec3::Y);
    let inverse = (clip_from_view * eye).inverse();
    let columns = inverse.to_cols_array().map(|v| format!("{v:?}")).join(", ");
    let row = (-1.0f32..=1.0, -1.0f32..=1.0, 1.0f32..=50.0).prop_map(|(x, y, z)| [x, y, 0.1 / z]);
    for field in [IsoField::Depth, IsoField::Height, IsoField::Distance] {
        let s = IsoLines {
            field,
            center: Vec3::new(1.0, -2.0, 0.5),
            ..IsoLines::default()
        };
        let number = field as u32;
        for_batches(row.clone(), |rows| {
            let results = gpu().evaluate(
                ISO,
                &format!(
                    "var s: IsoLines;
                     s.field = {number}u;
                     s.center = vec3(1.0, -2.0, 0.5);
                     s.world_from_clip = mat4x4<f32>({columns});
                     let p = iso_place(s, vec2(i(0u), i(1u)), i(2u));
                     return vec4(iso_value(s, p, 0.25), 1e6 * iso_error(s, p), 0.0, 0.0);"
                ),
                rows,
            );
            for (row, found) in rows.iter().zip(results) {
                let [x, y, d] = row.map(f64::from);
                let inverse = DMat4::from_cols_array(&inverse.to_cols_array().map(f64::from));
                let p = iso_place(inverse, [x, y], d);
                let want = iso_value(&s, p, 0.25);
                let error = 1e6 * iso_error(&s, p);
                assert!(
                    (f64::from(found[1]) - error).abs() < 1e-3 * error,
                    "{row:?}"
                );
                let apart = (f64::from(found[0]) - want).abs();
                assert!(
                    apart < 1e-4 * want.abs().max(1.0),
                    "{field:?}, {row:?}: {found:?}, {want}"
                );
            }
        });
    }
}
