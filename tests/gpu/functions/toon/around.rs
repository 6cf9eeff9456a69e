//! Light from all around and contact shadows, against references.

use bevy_comics_testkit::{
    device::gpu,
    reference::{Rgb, toon::ambient::two_tones},
};

use super::Numbers;
use crate::prelude::*;

/// Light on the six axes, a normal, the setting, ambient light, and whether it affects lightmapped
/// meshes.
type Row = [f32; 26];

const READ: &str = "#import bevy_comics::toon::indirect::{ambient, light_around, surroundings}
    #import bevy_comics::toon::light::ToonLight
    #import bevy_comics::toon::surface::Surface
    #import bevy_pbr::clustered_forward::ClusterableObjectIndexRanges
    #import bevy_pbr::irradiance_volume::sides
    #import bevy_pbr::mesh_view_bindings::lights
    fn v(n: u32) -> vec3<f32> { return vec3(i(n), i(n + 1u), i(n + 2u)); }";

fn rows() -> Vec<Row> {
    let mut n = Numbers::new(31);
    let row = |_| {
        let mut row: Row = [0.0; 26];
        let scale = 10f32.powf(n.within(-6.0, 6.0));
        let even = n.once_in(6);
        for slot in &mut row[..18] {
            *slot = if even { scale } else { scale * n.part() };
        }
        row[18..21].copy_from_slice(&n.unit());
        row[21] = match n.once_in(3) {
            true => n.part().round(),
            false => n.part(),
        };
        for slot in &mut row[22..25] {
            *slot = scale * n.part();
        }
        row[25] = n.part().round();
        row
    };
    (0..2048).map(row).collect()
}

fn sides(row: &Row) -> [Rgb; 6] {
    std::array::from_fn(|k| std::array::from_fn(|c| f64::from(row[3 * k + c])))
}

/// Light at a surface with a normal, as the stand-in of the engine's volumes has it.
fn towards(sides: &[Rgb; 6], normal: DVec3) -> DVec3 {
    let axes = normal.to_array().into_iter().enumerate();
    axes.map(|(axis, n)| {
        let side = 2 * axis + usize::from(n <= 0.0);
        n * n * DVec3::from_array(sides[side])
    })
    .sum()
}

/// What is found: `part` of the two tones, towards the normal of a row.
fn found(definitions: &[Definition], part: &str, rows: &[Row]) -> Vec<[f32; 4]> {
    let body = format!(
        "for (var k = 0u; k < 6u; k++) {{ sides[k] = v(3u * k); }}
         lights.ambient_color = vec4(v(22u), 1.0);
         lights.ambient_light_affects_lightmapped_meshes = u(25u);
         var s: Surface;
         s.normal = v(18u);
         var light: ToonLight;
         light.environment = i(21u);
         var ranges: ClusterableObjectIndexRanges;
         let around = light_around(s, light, &ranges);
         return vec4({part}, 0.0);"
    );
    gpu().evaluate_alone(definitions, READ, &body, rows)
}

fn assert_near(row: &Row, found: [f32; 4], reference: DVec3, scale: f64) {
    for (found, reference) in found.into_iter().zip(reference.to_array()) {
        let off = (f64::from(found) - reference).abs();
        assert!(off <= 1e-5 * scale, "{row:?}: {found}, not {reference}");
    }
}

/// The shade and the bright side of environments, mixed with their light at the normal. The stand-in of
/// the environment map has twice the light of that of the volume.
#[test]
fn light_from_all_around_matches_the_reference() {
    let rows = rows();
    let cases: [(&[Definition], f64); 4] = [
        (&[("IRRADIANCE_VOLUME", None)], 1.0),
        (&[("ENVIRONMENT_MAP", None)], 2.0),
        // Of both, the first one counts, as in the engine.
        (
            &[("ENVIRONMENT_MAP", None), ("IRRADIANCE_VOLUME", None)],
            1.0,
        ),
        (&[], 0.0),
    ];
    for (definitions, factor) in cases {
        let shades = found(definitions, "around.shade", &rows);
        let bright = found(definitions, "around.shade + around.more", &rows);
        for ((row, shade), bright) in rows.iter().zip(shades).zip(bright) {
            let sides = sides(row).map(|side| side.map(|c| factor * c));
            let normal = DVec3::new(row[18].into(), row[19].into(), row[20].into());
            let flat = f64::from(row[21]);
            let (most, least) = two_tones(sides);
            let smooth = (1.0 - flat) * towards(&sides, normal);
            let scale = sides.as_flattened().iter().copied().fold(1e-30, f64::max);
            assert_near(row, shade, flat * DVec3::from(least) + smooth, scale);
            assert_near(row, bright, flat * DVec3::from(most) + smooth, scale);
        }
    }
}

/// Ambient light is that of the view, but not on a mesh with a lightmap that has it baked in.
#[test]
fn ambient_light_matches_the_reference() {
    let rows = rows();
    for (definitions, lightmapped) in [(&[][..], false), (&[("LIGHTMAP", None)][..], true)] {
        let results = found(definitions, "ambient()", &rows);
        for (row, found) in rows.iter().zip(results) {
            let arrives = !lightmapped || row[25] > 0.5;
            let light = if arrives { &row[22..25] } else { &[0.0; 3] };
            assert_eq!(found[..3], *light, "{row:?}");
        }
    }
}

/// Three quarters of the thickness of a surface are dark; all is lit behind that.
#[test]
fn contact_shadows_end_behind_thin_things() {
    let import = "#import bevy_comics::toon::contact::contact_left";
    let body = "return vec4(contact_left(true, i(0u)), contact_left(false, i(0u)), 0.0, 0.0);";
    let rows = [[-1.0f32], [0.0], [0.5], [0.6], [0.75], [1.0], [3.0]];
    let results = gpu().evaluate_alone(&[], import, body, &rows);
    for ([behind], found) in rows.iter().zip(results) {
        let left = if *behind < 0.75 { 0.0 } else { 1.0 };
        assert_eq!(found[0], left, "{behind}");
        assert_eq!(found[1], 1.0);
    }
}
