//! Surfaces of the toon material at rest, for strokes.

use super::*;
use crate::prelude::*;

/// The unit normal is that of the mesh, or of the plane that the place changes in. What has no
/// extent has one, too.
#[test]
fn surfaces_at_rest_have_a_normal() {
    let directions = (vec(-1.0f32..=1.0, 9), -12i32..12, any::<bool>());
    let row = directions.prop_filter_map("two directions", |(values, exponent, is_bare)| {
        let mut row: [f32; 9] = std::array::from_fn(|k| values[k]);
        row[..6]
            .iter_mut()
            .for_each(|value| *value *= 2f32.powi(exponent));
        if is_bare {
            row[6..].fill(0.0);
        }
        let [across, down, _] = three(&row);
        let across = across.normalize().cross(down.normalize());
        (across.length() > 0.1).then_some(row)
    });
    let rest = |rows: &[[f32; 9]]| {
        let found = gpu().evaluate(
            "#import bevy_comics::toon::hatch::rest_surface",
            "let on = rest_surface(vec3(1.0, 2.0, 3.0), vec3(i(0u), i(1u), i(2u)),
                 vec3(i(3u), i(4u), i(5u)), vec3(i(6u), i(7u), i(8u)));
             return vec4(on.normal, on.place.y + on.eye.x);",
            rows,
        );
        found.into_iter().map(|found| found.map(f64::from))
    };
    for_batches(row, |rows| {
        for (row, [x, y, z, place]) in rows.iter().zip(rest(rows)) {
            let [across, down, normal] = three(row);
            let face = across.normalize().cross(down.normalize()).normalize();
            let want = normal.try_normalize().unwrap_or(face);
            let found = DVec3::new(x, y, z);
            assert!(found.distance(want) < 1e-4, "{row:?}: {found}, {want}");
            assert_eq!(place, 2.0);
        }
    });
    let flat = [0.0, 1e-30, 1e-38, 1e30].map(|x| [x, 0.0, 0.0, x, 0.0, 0.0, 0.0, 0.0, 0.0]);
    for (row, [x, y, z, _]) in flat.iter().zip(rest(&flat)) {
        let long = DVec3::new(x, y, z).length();
        assert!((long - 1.0).abs() < 1e-5, "{row:?}: {long}");
    }
}

fn three(row: &[f32; 9]) -> [DVec3; 3] {
    [0, 3, 6].map(|k| DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into()))
}
