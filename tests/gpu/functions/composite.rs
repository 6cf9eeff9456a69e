//! The finish of the fused pass (weight, split view, debug views) against its reference.

use super::*;
use bevy_comics_testkit::reference::composite;

const FINISH: &str =
    "#import bevy_comics::composite::{Finish, compare, range_fraction, object_color, difference}
#import bevy_comics::depth::map::{DepthFrame, EMPTY}";

#[test]
fn mixes_shares_and_differences_match_the_reference() {
    let row = (
        vec(component(), 6),
        0.0f32..=1.0,
        0u16..64,
        0u16..64,
        (0.0f32..=1.0, 0.0f32..=1.0, 0.0f32..=1.0, any::<bool>()),
    )
        .prop_map(|(colors, weight, split, x, (near, far, raw, empty))| {
            let mut row = [0.0f32; 13];
            row[..6].copy_from_slice(&colors);
            row[6..].copy_from_slice(&[
                weight,
                f32::from(split),
                f32::from(x),
                near.max(far),
                // One row in ten has a range of a single depth.
                if raw > 0.9 {
                    near.max(far)
                } else {
                    near.min(far)
                },
                if raw < 0.05 { 0.0 } else { raw },
                f32::from(u8::from(empty)),
            ]);
            row
        });
    for_batches(row, |rows| {
        let colors = "let a = vec3(i(0u), i(1u), i(2u)); let b = vec3(i(3u), i(4u), i(5u));";
        let mixed = gpu().evaluate(
            FINISH,
            &format!(
                "{colors} return compare(
                     Finish(i(6u), i(7u), vec2(0.0)), vec4(a, i(9u)), vec4(b, i(10u)), i(8u));"
            ),
            rows,
        );
        let apart = gpu().evaluate(
            FINISH,
            &format!(
                "{colors} var f: DepthFrame; f.near = i(9u); f.far = i(10u);
                 if i(12u) > 0.0 {{ f.flags = EMPTY; }}
                 return vec4(difference(a, b), range_fraction(f, i(11u)));"
            ),
            rows,
        );
        for (row, (mixed, apart)) in rows.iter().zip(mixed.into_iter().zip(apart)) {
            let wide = row.map(f64::from);
            let (a, b) = (rgb(&row[..3]), rgb(&row[3..6]));
            let with = |[r, g, b]: Rgb, alpha: f64| [r, g, b, alpha];
            let (original, styled) = (with(a, wide[9]), with(b, wide[10]));
            let want = composite::compare(wide[6], wide[7], original, styled, wide[8]);
            let ends = (wide[12] == 0.0).then_some([wide[9], wide[10]]);
            let difference = composite::difference(a, b);
            // Two products and a sum of numbers up to one: 2^-24 each, and a margin.
            let slack = 4.0 * 2f64.powi(-24);
            for i in 0..4 {
                assert!(
                    (f64::from(mixed[i]) - want[i]).abs() <= slack,
                    "{row:?}: {mixed:?} {want:?}"
                );
            }
            for i in 0..3 {
                assert!(
                    (f64::from(apart[i]) - difference[i]).abs() <= 4.0 * slack,
                    "{row:?}"
                );
            }
            let position = composite::range_fraction(ends, wide[11]);
            // Two differences, rounded to 2^-24 each, and their quotient.
            let slack = 4.0 * 2f64.powi(-24) / (wide[9] - wide[10]).max(1e-9) + 1e-6;
            assert!(
                (f64::from(apart[3]) - position).abs() <= slack,
                "{row:?}: {apart:?} {position}"
            );
        }
    });
}

#[test]
fn objects_have_the_colors_of_the_reference() {
    let row = (0u32..1 << 24).prop_map(|id| [id as f32]);
    for_batches(row, |rows| {
        let colors = gpu().evaluate(FINISH, "return vec4(object_color(u(0u)), 0.0);", rows);
        for (row, color) in rows.iter().zip(colors) {
            let want = composite::object_color(row[0] as u32);
            for i in 0..3 {
                assert!(
                    (f64::from(color[i]) - want[i]).abs() < 1e-6,
                    "{row:?}: {color:?}"
                );
            }
        }
    });
    let none = gpu().evaluate(FINISH, "return vec4(object_color(u(0u)), 0.0);", &[[0.0]]);
    assert_eq!(none[0], [0.0; 4], "no object is black");
}
