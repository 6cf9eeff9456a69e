//! Normals of simpler forms.

use super::*;

/// Vectors of any length have unit length; 0 stays 0.
#[test]
fn vectors_of_any_length_have_directions() {
    let import = "#import bevy_comics::toon::proxy::unit_or_none";
    let body = "return vec4(unit_or_none(vec3(i(0u), i(1u), i(2u))), 0.0);";
    let lengths = [1e-18f32, 1e-9, 1.0, 1e9, 1e18];
    let rows = lengths.map(|length| [0.48, -0.6, 0.64].map(|c| c * length));
    for (row, found) in rows.iter().zip(gpu().evaluate(import, body, &rows)) {
        for (found, wanted) in found.into_iter().zip([0.48, -0.6, 0.64]) {
            assert!((found - wanted).abs() < 1e-6, "{row:?}: {found}");
        }
    }
    assert_eq!(gpu().evaluate(import, body, &[[0.0; 3]])[0], [0.0; 4]);
}
