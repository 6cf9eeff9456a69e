//! Tones of the picture against their reference.

use bevy_comics_testkit::{device::gpu, reference::tone_ramp};
use proptest::{collection::vec, prelude::Strategy};

use super::{codes_apart, for_batches, rgb};
use crate::prelude::*;

const IMPORT: &str = "#import bevy_comics::effects::tone_ramp::{ToneRamp, tone_detail, toned}
    #import bevy_comics::effect::color::linear_to_oklab";

/// 18 components of six colours, six places and widths, then the focus, its reach and two amounts;
/// then a colour, its change over a pixel, and a place in the depth map.
const ROW: usize = 18 + 6 + 4 + 5;

fn ramp(row: &[f32; ROW]) -> ToneRamp {
    let color = |k: usize| Color::linear_rgb(row[3 * k], row[3 * k + 1], row[3 * k + 2]);
    ToneRamp {
        dark: color(0),
        middle: color(1),
        light: color(2),
        far_dark: color(3),
        far_middle: color(4),
        far_light: color(5),
        middle_at: row[18],
        light_at: row[19],
        softness: row[20],
        far_middle_at: row[21],
        far_light_at: row[22],
        far_softness: row[23],
        focus: row[24],
        reach: 0.01 + 0.99 * row[25],
        keep_color: row[26],
        amount: row[27],
    }
}

#[test]
fn tones_by_depth_match_the_reference() {
    let body = "var lab: array<vec3<f32>, 6>;
         for (var k = 0u; k < 6u; k++) {
             lab[k] = linear_to_oklab(vec3(i(3u * k), i(3u * k + 1u), i(3u * k + 2u)));
         }
         let s = ToneRamp(lab[0], i(18u), lab[1], i(19u), lab[2], i(20u), lab[3], i(21u), lab[4],
             i(22u), lab[5], i(23u), i(24u), 0.01 + 0.99 * i(25u), i(26u), i(27u));
         let detail = tone_detail(s, vec2(i(32u), 1.0 - i(32u)));
         return vec4(toned(s, vec3(i(28u), i(29u), i(30u)), 0.1 * i(31u), detail), detail);";
    let rows = vec(0.0f32..=1.0, ROW).prop_map(|row| {
        let mut all = [0.0; ROW];
        all.copy_from_slice(&row);
        all
    });
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, body, rows)) {
            let s = ramp(row);
            let detail = tone_ramp::tone_detail(&s, f64::from(row[32]));
            // A reach of a hundredth multiplies the rounding of the place by a hundred.
            let far = (f64::from(found[3]) - detail).abs();
            assert!(far < 3e-5, "{row:?}: {}, not {detail}", found[3]);
            let change = 0.1 * f64::from(row[31]);
            let reference = tone_ramp::toned(&s, rgb(&row[28..31]), change, f64::from(found[3]));
            let apart = codes_apart(found, reference);
            assert!(apart < 0.5, "{row:?}: {found:?}, not {reference:?}");
        }
    });
}

/// The ends are exact: only near tones at the focus, only far ones beyond its reach.
#[test]
fn tones_by_depth_have_two_ends() {
    let s = ToneRamp {
        focus: 0.25,
        reach: 0.5,
        ..ToneRamp::default()
    };
    for (depth, wanted) in [(0.25, 1.0), (0.0, 0.5), (0.5, 0.5), (0.75, 0.0), (1.0, 0.0)] {
        assert_eq!(tone_ramp::tone_detail(&s, depth), wanted);
    }
}
