//! The contour operators on planes.

use super::*;

/// Truth: planes have no contour by any operator, from face-on to grazing, in a range of 1 : 1000:
/// the response of the corrected equations is rounding alone.
#[test]
fn no_plane_has_a_contour_at_any_angle() {
    // The operator, and the raw depth, which is affine in the pixel.
    let rows: Vec<[f32; 10]> = (0..2000u16)
        .map(|k| {
            let across = (f32::from(k % 40) - 20.0) * 1e-5;
            let down = (f32::from(k / 40) - 25.0) * 1e-5;
            std::array::from_fn(|at| match at {
                0 => f32::from(k % 4),
                _ => {
                    let [x, y] = [(at - 1) % 3, (at - 1) / 3].map(|v| v as f32 - 1.0);
                    0.002 + across * x + down * y
                }
            })
        })
        .collect();
    let results = gpu().evaluate(
        "#import bevy_comics::depth::map::{DepthFrame}
         #import bevy_comics::depth::window::{Window}
         #import bevy_comics::effects::contours::{Contours, contour_response}",
        "let f = DepthFrame(1.0, 0.001, 0.0, 0.00006103515625, 0.0, 0.0, 0.05, 0u);
         var s: Contours; s.operator_kind = u(0u);
         let w = Window(i(1u), i(2u), i(3u), i(4u), i(5u), i(6u), i(7u), i(8u), i(9u), 0u);
         return vec4(contour_response(s, f, w));",
        &rows,
    );
    let worst = results.iter().map(|r| r[0]).fold(0.0, f32::max);
    assert!(worst < 1e-4, "a plane answers {worst}");
}
