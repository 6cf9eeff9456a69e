//! How hard the pen presses at a place of an object.

use bevy_comics_testkit::reference::pressure::{
    Frame as ObjectFrame, nested_wave, pressure_factor, solid_wave, stored_factor,
};

use super::*;

const PRESSURE: &str = "#import bevy_comics::objects::pressure::{
        Frame, Pressure, frame_scale, loaded_factor, nested_wave, place_on_object,
        pressure_factor, solid_wave, stored_factor,
    }";

fn place() -> impl Strategy<Value = [f32; 3]> {
    (-30.0f32..30.0, -30.0f32..30.0, -30.0f32..30.0).prop_map(|(x, y, z)| [x, y, z])
}

/// Noise changes by at most 3 a cell per axis, and coordinates below 64 cells are exact to
/// 2^-18 of a cell: 3 axes of it, and a few roundings of the sums.
const NOISE: f64 = 1e-4;

#[test]
fn noise_of_a_solid_matches_the_reference() {
    let row = (place(), 0u32..65536).prop_map(|([x, y, z], seed)| [x, y, z, seed as f32]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            PRESSURE,
            "return vec4(solid_wave(vec3(i(0u), i(1u), i(2u)), u(3u)));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, z, _] = row.map(f64::from);
            let want = solid_wave([x, y, z], row[3] as u32);
            assert!(
                (f64::from(found[0]) - want).abs() < NOISE,
                "{row:?}: {found:?}, {want}"
            );
            assert!(want.abs() <= 1.0, "{row:?}: {want}");
        }
    });
}

#[test]
fn nested_noise_and_its_factor_match_the_reference() {
    let row = (place(), -1.0f32..6.0, 0u32..65536, 0.0f32..=1.0)
        .prop_map(|([x, y, z], level, seed, amount)| [x, y, z, level, seed as f32, amount]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            PRESSURE,
            "let at = vec3(i(0u), i(1u), i(2u));
             let p = Pressure(i(5u), 60.0, 0.0, 0.0);
             let factor = pressure_factor(p, at, 60.0 / exp2(i(3u)), u(4u));
             return vec4(nested_wave(at, i(3u), u(4u)), factor, stored_factor(factor), loaded_factor(stored_factor(factor)));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [x, y, z, level, _, amount] = row.map(f64::from);
            let seed = row[4] as u32;
            let want = nested_wave([x, y, z], level, seed);
            let pixels = 60.0 / level.exp2();
            let factor = pressure_factor([amount, 60.0], [x, y, z], pixels, seed);
            let stored = stored_factor(factor) / 255.0;
            let wants = [want, factor, stored, factor.min(2.0)];
            for (found, want) in found.iter().zip(wants) {
                // Two octaves, the finer one of cells half as long.
                assert!(
                    (f64::from(*found) - want).abs() < 4.0 * NOISE,
                    "{row:?}: {found:?}, {wants:?}"
                );
            }
        }
    });
}

/// A place that moves, turns and grows with an object is the same place; its reference agrees.
#[test]
fn places_on_an_object_go_with_it() {
    let row = (place(), place(), place(), 0.2f32..5.0).prop_map(|(at, origin, turn, scale)| {
        let [[x, y, z], [ox, oy, oz], [tx, ty, tz]] = [at, origin, turn];
        [x, y, z, ox, oy, oz, tx, ty, tz, scale]
    });
    for_batches(row, |rows| {
        let rows: Vec<[f32; 16]> = rows.iter().map(|row| moved(row).0).collect();
        let results = gpu().evaluate(
            PRESSURE,
            "let f = Frame(
                 vec3(i(3u), i(4u), i(5u)), vec3(i(6u), i(7u), i(8u)),
                 vec3(i(9u), i(10u), i(11u)), vec3(i(12u), i(13u), i(14u)),
             );
             return vec4(place_on_object(f, vec3(i(0u), i(1u), i(2u))), frame_scale(f));",
            &rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let v = row.map(f64::from);
            let three = |i: usize| [v[i], v[i + 1], v[i + 2]];
            let frame = ObjectFrame {
                origin: three(3),
                axes: [three(6), three(9), three(12)],
            };
            let want = frame.place(three(0));
            for i in 0..3 {
                let apart = (f64::from(found[i]) - want[i]).abs();
                // World coordinates below 256 units, divided by a scale of at least 0.2.
                assert!(apart < 2e-4, "{row:?}: {found:?}, {want:?}");
            }
            assert!((f64::from(found[3]) / frame.scale() - 1.0).abs() < 1e-5);
        }
    });
    // Truth: the place is that of the object before it was moved.
    for i in 0..100 {
        let t = |k: f32| (i as f32 * k).sin();
        let (row, local) = moved(&[
            20.0 * t(1.1),
            9.0 * t(2.3),
            5.0 * t(3.7),
            30.0 * t(0.7),
            t(4.1),
            t(5.9),
            3.0 * t(1.9),
            2.0 * t(2.9),
            t(7.7),
            1.0 + 0.5 * t(8.3),
        ]);
        let v = row.map(f64::from);
        let three = |i: usize| [v[i], v[i + 1], v[i + 2]];
        let frame = ObjectFrame {
            origin: three(3),
            axes: [three(6), three(9), three(12)],
        };
        let found = frame.place(three(0));
        for k in 0..3 {
            assert!(
                (found[k] - f64::from(local[k])).abs() < 1e-4,
                "{found:?}, {local:?}"
            );
        }
    }
}

/// A place in the world and the frame of an object that was moved, turned and scaled: from the
/// place on the object, the object's origin, its turn and its scale. Also that place.
fn moved(row: &[f32; 10]) -> ([f32; 16], [f32; 3]) {
    use bevy::math::{EulerRot, Quat, Vec3};
    let turn = Quat::from_euler(EulerRot::XYZ, row[6], row[7], row[8]);
    let origin = Vec3::new(row[3], row[4], row[5]);
    let local = Vec3::new(row[0], row[1], row[2]);
    let world = origin + row[9] * (turn * local);
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| row[9] * (turn * axis));
    let all = [world, origin, axes[0], axes[1], axes[2]];
    let mut found = [0.0; 16];
    for (i, v) in all.iter().enumerate() {
        found[3 * i..3 * i + 3].copy_from_slice(&v.to_array());
    }
    (found, local.to_array())
}

/// Truth: the mean of the noise is 0 and its deviation the same at all levels, and a step of
/// 5 % of the level's length changes it by at most pi / 2 * sqrt(2) * log2(1.05).
#[test]
fn nested_noise_has_the_same_variance_at_all_levels() {
    let places: Vec<[f64; 3]> = (0..20_000)
        .map(|i| {
            let t = f64::from(i);
            [0.731 * t, 1.913 * t % 977.0, 3.177 * t % 1013.0]
        })
        .collect();
    let bound = std::f64::consts::FRAC_PI_2 * 2f64.sqrt() * 1.05f64.log2() + 1e-9;
    let mut deviations = Vec::new();
    for step in 0..15 {
        let level = 1.05f64.powi(step).log2();
        let values: Vec<f64> = places.iter().map(|p| nested_wave(*p, level, 7)).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.02, "{step}: {mean}");
        deviations.push(square.sqrt());
        let next = 1.05f64.powi(step + 1).log2();
        for (place, value) in places.iter().zip(&values) {
            let change = (nested_wave(*place, next, 7) - value).abs();
            assert!(change < bound, "{step}, {place:?}: {change}");
        }
    }
    // Of uniform numbers, 1 / sqrt(3), interpolated along three axes: (26 / 35)^(3 / 2) of it.
    let want = (26.0f64 / 35.0).powf(1.5) / 3f64.sqrt();
    for deviation in deviations {
        assert!((deviation / want - 1.0).abs() < 0.04, "{deviation}, {want}");
    }
}
