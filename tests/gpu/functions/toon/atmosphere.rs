//! What the atmosphere leaves of the sun. The engine's atmosphere crashes CPU adapters, so no
//! picture shows it.

use std::fs;

use bevy_comics_testkit::{ROOT, device::gpu};

use super::Numbers;
use crate::prelude::*;

/// What the shipped function imports of the engine, as simple functions.
const ENGINE: &str = "struct Atmosphere { world_to_atmosphere: mat4x4<f32>, inner_radius: f32 }
    var<private> atmosphere: Atmosphere;
    fn clamp_to_surface(air: Atmosphere, at: vec3<f32>) -> vec3<f32> {
        return at * max(air.inner_radius / length(at), 1.0);
    }
    fn calculate_visible_sun_ratio(air: Atmosphere, radius: f32, height: f32, disk: f32) -> f32 {
        return clamp(0.5 + height / disk, 0.0, 1.0);
    }
    fn sample_transmittance_lut(radius: f32, height: f32) -> vec3<f32> {
        return vec3(1.0, 0.5 + 0.5 * height, 1.0 / (1.0 + radius));
    }
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }";

#[test]
fn air_dims_the_sun_by_its_height_over_the_ground() {
    let path = Path::new(ROOT).join("src/toon/lights.wgsl");
    let text = fs::read_to_string(path).expect("a shader");
    let begin = text.find("fn through_atmosphere").expect("a function");
    let end = begin + text[begin..].find("\n}").expect("its end") + 2;
    let function = text[begin..end].replace("view_bindings::", "");
    let import = format!("{ENGINE}\n{function}");
    let body = "atmosphere.inner_radius = 3.0;
         atmosphere.world_to_atmosphere = mat4x4(vec4(1.0, 0.0, 0.0, 0.0),
             vec4(0.0, 1.0, 0.0, 0.0), vec4(0.0, 0.0, 1.0, 0.0), vec4(0.5, 1.0, 0.0, 1.0));
         return vec4(through_atmosphere(v(0u), v(3u), 0.5), 0.0);";
    let mut n = Numbers::new(72);
    let mut row = |_| {
        let place = [0; 3].map(|_| n.within(-5.0, 5.0));
        <[f32; 6]>::try_from([place, n.unit()].concat()).expect("six numbers")
    };
    let rows: Vec<[f32; 6]> = (0..2048).map(&mut row).collect();
    for (row, found) in rows.iter().zip(gpu().evaluate(&import, body, &rows)) {
        let vector = |k: usize| DVec3::new(row[k].into(), row[k + 1].into(), row[k + 2].into());
        let at = vector(0) + DVec3::new(0.5, 1.0, 0.0);
        let place = at * (3.0 / at.length()).max(1.0);
        let height = vector(3).dot(place.normalize());
        let through = DVec3::new(1.0, 0.5 + 0.5 * height, 1.0 / (1.0 + place.length()));
        let wanted = through * (0.5 + height / 0.5).clamp(0.0, 1.0);
        for (found, wanted) in found.into_iter().zip(wanted.to_array()) {
            assert!(
                (f64::from(found) - wanted).abs() < 2e-6,
                "{row:?}: {found}, not {wanted}"
            );
        }
    }
}
