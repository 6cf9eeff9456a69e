//! Two tones by lightness.

use bevy_comics_testkit::reference::two_tone::{inked_light_fraction, light_fraction};

use super::*;
use crate::prelude::*;

/// For every threshold, softness, lightness and change of it. The ends are whole: at a
/// threshold of 0 everything is light, at 1 everything is dark.
#[test]
fn the_fraction_of_the_light_tone_matches_the_reference() {
    let row = (component(), 0.0f32..=16.0, component(), 0.0f32..=0.5)
        .prop_map(|(threshold, softness, y, change)| [threshold, softness, y, change]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effects::two_tone::{TwoTone, light_fraction}",
            "var s: TwoTone; s.threshold = i(0u); s.softness = i(1u);
             return vec4(light_fraction(s, i(2u), i(3u)), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [threshold, softness, y, change] = *row;
            let s = TwoTone {
                threshold,
                softness,
                ..TwoTone::default()
            };
            let want = light_fraction(&s, f64::from(y), f64::from(change));
            // The narrowest edge is 2e-4 wide: a rounding of 1e-7 is 5e-4 of it, times the
            // slope of 1.5.
            assert!(
                (f64::from(found[0]) - want).abs() < 2e-3,
                "{row:?}: {found:?}, {want}"
            );
            if threshold == 0.0 {
                assert_eq!(want, 1.0, "{row:?}");
            }
            if threshold == 1.0 {
                // `1 + half - half` may round to less than 1.
                assert!(want < 1e-24, "{row:?}: {want}");
            }
        }
    });
}

/// Before and after ink, at changes of the lightness that make the edge soft: at hard ones
/// rounding decides.
#[test]
fn ink_on_tones_matches_the_reference() {
    let row = (component(), component(), 0.001f32..=0.5).prop_map(|(a, b, change)| [a, b, change]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::effects::two_tone::{TwoTone, inked_light_fraction}",
            "var s: TwoTone; s.threshold = 0.45; s.softness = 1.5;
             return vec4(inked_light_fraction(s, i(0u), i(1u), i(2u)), 0.0, 0.0, 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [before, after, change] = row.map(f64::from);
            let want = inked_light_fraction(&TwoTone::default(), before, after, change);
            assert!((0.0..=1.0).contains(&want), "{row:?}: {want}");
            // Ink on nearly black: differences of light are divided by it.
            assert!(
                (f64::from(found[0]) - want).abs() < 2e-3,
                "{row:?}: {found:?}, {want}"
            );
        }
    });
}
