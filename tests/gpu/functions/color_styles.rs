//! Color conversions.

use super::*;

#[test]
fn the_transfer_function_and_oklab_are_their_definitions() {
    let row = (wide_component(), wide_component(), wide_component());
    for_batches(row.prop_map(|(r, g, b)| [r, g, b]), |rows| {
        let evaluate = |color: &str| {
            let body = format!("let c = vec3(i(0u), i(1u), i(2u)); return vec4({color}, 0.0);");
            gpu().evaluate(COLOR, &body, rows)
        };
        let encoded = evaluate("srgb_encode(c)");
        let decoded = evaluate("srgb_decode(c)");
        let there_and_back = evaluate("oklab_to_linear(linear_to_oklab(c))");
        for (k, row) in rows.iter().enumerate() {
            let c = rgb(row);
            // pow(x, y) is exp2(y * log2(x)): its relative error is ln 2 times the error of the
            // exponent, about 2^-16. A quarter of a code is 2^-10.
            let assert_close = |got: [f32; 4], want: Rgb| {
                for i in 0..3 {
                    let apart = (f64::from(got[i]) - want[i]).abs();
                    let most = 2e-5 * want[i].abs().max(0.05);
                    assert!(apart <= most, "{row:?}: {got:?}, {want:?}");
                }
            };
            assert_close(encoded[k], color::srgb_encode(c));
            assert_close(decoded[k], color::srgb_decode(c));
            if row.iter().all(|x| (0.0..=1.0).contains(x)) {
                assert_same_color(row, there_and_back[k], c);
            }
        }
    });
}

#[test]
fn what_is_no_number_is_replaced() {
    let payload = [0x7f80_0001, 0xffff_ffff].map(f32::from_bits);
    let infinite = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, -f32::NAN];
    let numbers = [0.0, -0.0, 1.0, -3.5, f32::MAX, f32::MIN, 1e-40];
    let rows: Vec<[f32; 1]> = [&payload[..], &infinite, &numbers]
        .concat()
        .into_iter()
        .map(|x| [x])
        .collect();
    let results = gpu().evaluate(COLOR, "return vec4(finite(i(0u)));", &rows);
    for ([x], result) in rows.iter().zip(results) {
        let want = color::finite(*x);
        assert_eq!(f64::from(result[0]), want, "bits {:#x}", x.to_bits());
    }
}

#[test]
fn hue_and_its_color_are_inverse() {
    let row = (component(), component(), component()).prop_map(|(r, g, b)| [r, g, b]);
    for_batches(row, |rows| {
        let body = "return vec4(hue_color(hue_of(vec3(i(0u), i(1u), i(2u)))), 0.0);";
        for (row, result) in rows.iter().zip(gpu().evaluate(COLOR, body, rows)) {
            let reference = color::hue_color(color::hue_of(rgb(row)));
            for i in 0..3 {
                // The error of the hue is that of a quotient, and the color changes six times as
                // fast as the hue. 1e-5 is 1/400 of a code.
                let apart = (f64::from(result[i]) - reference[i]).abs();
                assert!(apart < 1e-5, "{row:?}: {result:?}, {reference:?}");
            }
        }
    });
}
