//! The dial of abstraction: what effects and lines make of it.

use bevy_comics_testkit::reference::abstraction;

use super::*;

#[test]
fn colors_and_lines_match_the_reference() {
    let ends = (0.0f32..=1.0, 0.0f32..=1.0, 0.25f32..=4.0, depth_pair());
    let dials = (0.0f32..=1.0, 1.0f32..=8.0, 0.0f32..=1.0, any::<bool>());
    let of_object = (any::<bool>(), -1.0f32..=2.0);
    let row = (
        ends,
        dials,
        (component(), component(), component()),
        of_object,
    )
        .prop_map(
            |(ends, (saturation, threshold, crease, flip), (r, g, b), (fixed, added))| {
                let (near, far, exponent, (d, _)) = ends;
                let [flip, factor] = [flip, !fixed].map(|on| f32::from(u8::from(on)));
                [
                    near, far, exponent, d, saturation, threshold, crease, flip, r, g, b, factor,
                    added,
                ]
            },
        );
    for_batches(row, |rows| {
        let found = gpu().evaluate(
            "#import bevy_comics::effects::abstraction::{Abstraction, abstract_color, dialled}
             #import bevy_comics::lines::abstraction::{LineAbstraction, abstract_crease, abstract_response}",
            "let s = Abstraction(i(0u), i(1u), i(2u), 0.0, 0.0, i(4u));
             let l = LineAbstraction(i(0u), i(1u), i(2u), i(5u), i(6u), 0.0, i(7u), 0.0);
             let dial = vec2(i(11u), i(12u));
             let a = dialled(s, i(3u), dial);
             let c = abstract_color(s, vec3(i(8u), i(9u), i(10u)), a);
             return vec4(a, abstract_response(l, i(3u), dial), abstract_crease(l, i(3u), dial), c.x);",
            rows,
        );
        for (row, found) in rows.iter().zip(found) {
            let [
                near,
                far,
                exponent,
                d,
                saturation,
                threshold,
                crease,
                flip,
                r,
                g,
                b,
                factor,
                added,
            ] = row.map(f64::from);
            let dial = [factor, added];
            let at = |d| abstraction::dialled(abstraction::graded([near, far], exponent, d), dial);
            let a = at(d);
            let seen = if flip == 1.0 { 1.0 - d } else { d };
            let of_lines = at(seen);
            let [response, opacity] = abstraction::lines([threshold, crease], of_lines);
            let red = abstraction::color([r, g, b], saturation, a)[0];
            // A power of a number below 1: the built-in logarithm has an error of 2e-5.
            let wanted = [a, response, opacity, red];
            for i in 0..4 {
                let apart = (f64::from(found[i]) - wanted[i]).abs();
                // The response's slope is below the threshold less 1.
                assert!(apart < 2e-4, "{row:?}: {found:?} for {wanted:?}");
            }
        }
    });
}

/// The bands, and how far they move as the dial turns by a hundredth.
#[test]
fn bands_split_and_never_jump() {
    let row = (2u8..=8, 0.0f32..=2.99, component(), 0.02f32..=0.3)
        .prop_map(|(levels, splits, y, step)| [f32::from(levels), splits, y, step]);
    for_batches(row, |rows| {
        let import = "#import bevy_comics::effect::color::split_bands";
        let body = "return vec4(
                split_bands(i(0u), i(1u), i(2u), i(3u)), split_bands(i(0u), i(1u) + 0.01, i(2u), i(3u)),
                split_bands(i(0u), floor(i(1u)), i(2u), 0.0), split_bands(i(0u), floor(i(1u)) + 1.0, i(2u), 0.0),
            );";
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let [levels, splits, y, step] = row.map(f64::from);
            let reference = abstraction::split_bands(levels, splits, y, step);
            // A step is at least levels / 128 of a band wide; the slope of smoothstep is 1.5.
            let slope = 1.5 * 2f64.powi(-22) * 128.0 * levels * splits.exp2();
            assert!(
                (f64::from(found[0]) - reference).abs() < slope + 1e-6,
                "{row:?}: {found:?}, {reference}"
            );
            // The middles of a band and of its halves differ by a quarter of the band, and the part
            // of the finer ones changes by at most 1.5 times as much as the dial.
            let band = 1.0 / (levels * splits.floor().exp2());
            let moved = f64::from(found[1] - found[0]).abs();
            // Steps of different width may add the other half of a band, if the step is soft.
            assert!(moved <= 1.5 * 0.01 * band + 1e-6, "{row:?}: {found:?}");
            // Nested: hard bands of the next number lie inside of the one before.
            let inside = f64::from(found[2] - found[3]).abs();
            let at_a_step = ((y * levels * splits.floor().exp2() * 2.0).fract() - 0.5).abs() > 0.48;
            assert!(
                at_a_step || inside <= 0.26 * band,
                "{row:?}: {found:?} of bands {band} wide"
            );
        }
    });
}
