//! Where lights read their pictures. Adapters of tests may have no arrays of textures, so no
//! picture shows it.

use bevy_comics_testkit::device::gpu;

/// A spot light whose outer angle has the tangent 0.5 shines along -z: its axis is the middle of
/// its picture, the border of its cone the border. The picture of a directional light is two units
/// wide.
#[test]
fn pictures_of_lights_fill_their_cones_and_squares() {
    let import = "#import bevy_comics::toon::light_textures::{directional_uv, is_beside, spot_uv}";
    let body = "let at = vec3(i(0u), i(1u), i(2u));
         let uv = directional_uv(at);
         return vec4(spot_uv(at, 0.5), uv.x, select(uv.y, 9.0, is_beside(uv)));";
    let beside = 9.0;
    let cases = [
        ([0.0, 0.0, -3.0], [0.5, 0.5, 0.5, 0.5]),
        ([1.0, 0.0, -2.0], [1.0, 0.5, 0.0, 0.5]),
        ([0.0, 1.0, -2.0], [0.5, 0.0, 0.5, 1.0]),
        ([-0.5, -0.5, -2.0], [0.25, 0.75, 0.75, 0.25]),
        ([-1.5, 0.0, -6.0], [0.25, 0.5, 1.25, beside]),
        ([0.0, 1.5, -6.0], [0.5, 0.25, 0.5, beside]),
    ];
    let found = gpu().evaluate_alone(&[], import, body, &cases.map(|(row, _)| row));
    for ((at, wanted), found) in cases.iter().zip(found) {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(
                (found - wanted).abs() < 1e-6,
                "{at:?}: {found}, not {wanted}"
            );
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
