//! The search for tiles with contours by a bound: no contour may be below it.

use super::*;

const IMPORTS: &str = "#import bevy_comics::depth::map::DepthFrame
    #import bevy_comics::depth::window::Window
    #import bevy_comics::effects::contours::{Contours, contour_response}
    #import bevy_comics::lines::jumps::{Jumps, Row, may_jump}";

/// [flags, near, far, operator, size of `least`, nine depths]: windows of a plane, of a
/// bend, of a step, and of noise.
fn row() -> impl Strategy<Value = [f32; 14]> {
    let ends = (0.01f32..0.9, 0.001f32..0.99);
    let shape = (-0.2f32..0.2, -0.2f32..0.2, -0.2f32..0.2, 0u8..5, 0usize..9);
    let noise = vec(0.0f32..1.0, 9);
    let ratio = prop_oneof![1 => 0.1f32..=1.0, 1 => 1.0f32..20.0];
    (ends, 0u8..4, 0u8..4, shape, noise, ratio).prop_map(
        |((near, part), flags, operator, (sx, sy, size, kind, tap), noise, ratio)| {
            let far = near * part;
            let mut row = [0.0; 14];
            row[..5].copy_from_slice(&[f32::from(flags), near, far, f32::from(operator), ratio]);
            let size = size * size * size * (near - far);
            for k in 0..9 {
                let (x, y) = ((k % 3) as f32 - 1.0, (k / 3) as f32 - 1.0);
                let plane = far + (near - far) * (0.5 + sx * x + sy * y);
                let over = match kind {
                    0 => 0.0,
                    1 => size * x.abs(),
                    2 => size * f32::from(u8::from(x + y > 0.0)),
                    3 => size * noise[k],
                    _ => size * f32::from(u8::from(k == tap)),
                };
                row[5 + k] = (plane + over).clamp(far, near);
            }
            if kind == 4 && noise[0] < 0.3 {
                row[5 + tap] = 0.0;
            }
            row
        },
    )
}

/// A contour is drawn only where the bound is reached, whatever the operator and the projection;
/// and the bound leaves out many windows.
#[test]
fn the_search_leaves_out_no_contour() {
    for_batches(row(), |rows| {
        let results = gpu().evaluate(
            IMPORTS,
            "let f = DepthFrame(i(1u), i(2u), 0.0, 0.00006103515625, 10.0, 10.0, 0.05, u(0u));
             var s: Contours; s.operator_kind = u(3u);
             let w = Window(i(5u), i(6u), i(7u), i(8u), i(9u), i(10u), i(11u), i(12u), i(13u), 0u);
             let response = contour_response(s, f, w);
             let least = 0.70710678 * response * i(4u);
             let one = vec4(1.0);
             let north = Row(w.nw * one, w.n * one, w.ne * one);
             let here = Row(w.w * one, w.center * one, w.e * one);
             let south = Row(w.sw * one, w.s * one, w.se * one);
             let found = may_jump(Jumps(f, least, 1.0), north, here, south, one, 1.0);
             return vec4(response, f32(found), 0.0, 0.0);",
            rows,
        );
        let mut left_out = 0;
        for (row, [response, found, ..]) in rows.iter().zip(results) {
            // A unit in the last place of a depth near 1, in D: what planes answer.
            let [near, far] = [row[1], row[2]].map(f64::from);
            let rounding = 12.0 * 2f64.powi(-22) * near / (near - far) * near / far;
            if f64::from(response) < rounding {
                continue;
            }
            assert!(
                row[4] > 1.0 || found == 1.0,
                "a response of {response} is left out: {row:?}"
            );
            left_out += u32::from(found == 0.0);
        }
        assert!(left_out > 50, "the bound leaves out {left_out} windows");
    });
}
