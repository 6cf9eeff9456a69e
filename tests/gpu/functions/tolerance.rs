//! Whether the depth prepass shows a fragment, up to a tolerance.

use super::*;

/// Depths that are exact in single precision: the tolerance itself is near, and the next depth is
/// not. Nothing is near where the prepass has nothing. Infinite depths and NaN are left out: WGSL
/// lets devices assume that there are none.
#[test]
fn the_tolerance_itself_is_near() {
    let flat = 2f32.powi(-13) + 2f32.powi(-22);
    let steep = 2f32.powi(-8);
    let next = 2f32.powi(-25);
    let views: [(f32, &[Definition]); 2] =
        [(0.0625, &[]), (0.75, &[("TOLERANT_MULTISAMPLED", None)])];
    for (pixels, definitions) in views {
        let sloped = flat + pixels * steep;
        // Drawn depth, depth of the prepass, slope.
        let cases = [
            ([0.5, 0.5, 0.0], true),
            ([0.5 - flat, 0.5, 0.0], true),
            ([0.5 - flat - next, 0.5, 0.0], false),
            ([0.5, 0.5 - flat, 0.0], true),
            ([0.5, 0.5 - flat - next, 0.0], false),
            ([0.5 - sloped, 0.5, steep], true),
            ([0.5 - sloped - next, 0.5, steep], false),
            ([0.5, 0.5 - sloped, steep], true),
            ([0.5, 0.5 - sloped - next, steep], false),
            // Infinitely far away, in an orthographic view just in front of the far plane.
            ([0.0, 2f32.powi(-22), 0.0], true),
            ([0.0, 2f32.powi(-21), 0.0], false),
            ([0.0, 0.0, 0.0], false),
            ([1e-9, 0.0, 0.0], false),
            ([0.0, -0.0, 0.0], false),
            ([0.0, -1e-8, 0.0], false),
            ([0.5, 0.0, 1e30], false),
            ([0.5, -0.5, 1e30], false),
            ([0.0, 0.5, 1e30], true),
        ];
        let import = "#import bevy_comics::objects::tolerance::is_near";
        let body = "return vec4(f32(is_near(i(0u), i(1u), i(2u))));";
        let rows = cases.map(|(row, _)| row);
        let found = gpu().evaluate_alone(definitions, import, body, &rows);
        for ((row, near), found) in cases.into_iter().zip(found) {
            assert_eq!(found[0] == 1.0, near, "{row:?}, {definitions:?}");
        }
    }
}
