//! Focus: distances, radii, and what may be taken from where.

use bevy_comics_testkit::reference::{
    focus::{SKY, defocus, taken},
    smoothstep,
};

use super::{settings::expression, *};
use crate::prelude::*;

const FOCUS: &str = "#import bevy_comics::effects::focus::{
        Focus, defocus, nearness_of, reaching, taken,
    }";
const FIELDS: [&str; 10] = [
    "vec2", "f32", "f32", "f32", "f32", "f32", "u32", "vec2", "f32", "f32",
];

fn focus() -> Focus {
    Focus {
        at: FocusAt::Distance,
        clear: 0.2,
        ramp: 0.7,
        radius: 9.0,
        ..Focus::default()
    }
}

/// Perspective, and orthographic: raw depth 1 is 2 units away and 0 is 52.
fn views() -> [EffectContext; 2] {
    let perspective = EffectContext::default();
    let mut orthographic = perspective;
    orthographic.depth_axis = Vec2::new(52.0, -50.0);
    orthographic.depth_reference = Some(12.0);
    [perspective, orthographic]
}

#[test]
fn radii_match_the_reference() {
    let distance = || prop_oneof![3 => 0.1f32..100.0, 1 => select(vec![9.9, 10.0, 10.1, 1e30])];
    for view in views() {
        let s = expression("Focus", &FIELDS, &focus(), &view);
        let parallel = view.depth_reference.is_some();
        let near = if parallel { "-i(0u)" } else { "1.0 / i(0u)" };
        let body = format!("return vec4(defocus({s}, {near}, i(1u)));");
        for_batches((distance(), distance()).prop_map(|(a, b)| [a, b]), |rows| {
            for (row, found) in rows.iter().zip(gpu().evaluate(FOCUS, &body, rows)) {
                let [a, b] = row.map(f64::from);
                let want = defocus(&focus(), a, b, view.depth_reference.map(f64::from));
                // Negative in front of the focus.
                let want = if a < b { -want } else { want };
                // A logarithm of up to 70 with an error of 2^-21 of it near the ramp, whose
                // slope is up to 9 * 1.5 / 0.7.
                let apart = (f64::from(found[0]) - want).abs();
                assert!(apart < 1e-3, "{row:?}: {found:?}, {want}");
            }
        });
    }
}

#[test]
fn nearness_is_that_of_the_projection() {
    let [perspective, orthographic] = views();
    for (view, of, sky) in [
        (perspective, (|d| d / 0.1) as fn(f64) -> f64, 1.0 / SKY),
        (orthographic, |d| 50.0 * d - 52.0, -SKY),
    ] {
        let s = expression("Focus", &FIELDS, &focus(), &view);
        let body = format!("return vec4(nearness_of({s}, i(0u)));");
        for_batches((1e-6f32..=1.0).prop_map(|d| [d]), |rows| {
            for (row, found) in rows.iter().zip(gpu().evaluate(FOCUS, &body, rows)) {
                let want = of(f64::from(row[0]));
                assert!((f64::from(found[0]) / want - 1.0).abs() < 3e-6, "{row:?}");
            }
        });
        let none = [[0.0], [f32::NAN], [-1.0], [1e-40]];
        for found in gpu().evaluate(FOCUS, &body, &none) {
            assert!((f64::from(found[0]) / sky - 1.0).abs() < 1e-6, "{found:?}");
        }
    }
}

/// The reference compares distances; the shader has nothing but the radii, and on which side of the focus
/// they are. Truth, too: nothing is taken from what is nearer and sharp.
#[test]
fn what_is_taken_matches_the_reference() {
    let [view, _] = views();
    let s = expression("Focus", &FIELDS, &focus(), &view);
    let body = format!(
        "let own = defocus({s}, 1.0 / i(0u), 10.0);
        let other = defocus({s}, 1.0 / i(1u), 10.0);
        return vec4(taken(own, other), own, other, reaching(i(2u), i(3u)));"
    );
    let distance = || prop_oneof![3 => 1.0f32..100.0, 1 => select(vec![3.0, 10.0, 10.5, 1e30])];
    let number = || prop_oneof![3 => 0.0f32..12.0, 1 => select(vec![0.0, 1.0, 6.0])];
    let row = (distance(), distance(), number(), number()).prop_map(|(a, b, c, d)| [a, b, c, d]);
    for_batches(row, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(FOCUS, &body, rows)) {
            let [a, b, c, d] = row.map(f64::from);
            let [share, own, other, reaches] = found.map(f64::from);
            let want = taken([a, own.abs()], [b, other.abs()]);
            // Only what is out of focus takes; radii are exact to 1e-3 of 9, see above.
            if own.abs() > 0.1 {
                assert!((share - want).abs() < 0.02, "{row:?}: {found:?}, {want}");
            }
            assert!(
                !(b < a && other == 0.0 && own > 0.0) || share == 0.0,
                "{row:?}"
            );
            let want = smoothstep(d - 1.0, d + 1.0, c);
            assert!((reaches - want).abs() < 1e-5, "{row:?}");
        }
    });
}

/// The target's distance is used where there is one; else the own.
#[test]
fn a_target_is_in_focus() {
    let [mut view, _] = views();
    let s = Focus {
        distance: 7.0,
        ..Focus::default()
    };
    let text = |view: &EffectContext, at| {
        let fields = &FIELDS;
        expression("Focus", fields, &Focus { at, ..s }, view)
    };
    assert_eq!(text(&view, FocusAt::Target), text(&view, FocusAt::Distance));
    view.target_depth = Some(31.0);
    let own = Focus {
        distance: 31.0,
        ..s
    };
    assert_eq!(
        text(&view, FocusAt::Target),
        expression("Focus", &FIELDS, &own, &view)
    );
    assert_eq!(own.faded(0.0).strength(), 0.0);
}

/// What is left of a line is what the radius of a blur leaves.
#[test]
fn lines_are_as_sharp_as_by_the_reference() {
    const LINES: &str = "#import bevy_comics::lines::focus::{LineFocus, line_sharpness}";
    for (view, of) in [
        (views()[0], (|d| 0.1 / d) as fn(f64) -> f64),
        (views()[1], |d| 52.0 - 50.0 * d),
    ] {
        let (axis, reference) = (view.depth_axis, view.depth_reference.unwrap_or(0.0));
        for at_centre in [0, 1] {
            let body = format!(
                "let f = LineFocus(vec2({:?}, {:?}), i(2u), {at_centre}u, {reference:?}, 0.2, {:?}, 0.8);
                 return vec4(line_sharpness(f, i(0u), i(1u)));",
                axis.x,
                axis.y,
                1.0f32 / 0.7,
            );
            let row = (1e-3f32..=1.0, 1e-3f32..=1.0, 0.1f32..60.0);
            for_batches(row.prop_map(|(a, b, c)| [a, b, c]), |rows| {
                for (row, found) in rows.iter().zip(gpu().evaluate(LINES, &body, rows)) {
                    let [raw, middle, distance] = row.map(f64::from);
                    let focus_at = if at_centre == 1 { of(middle) } else { distance };
                    let reference = view.depth_reference.map(f64::from);
                    let radius = defocus(&focus(), of(raw), focus_at, reference);
                    let want = 1.0 - 0.8 * radius / 9.0;
                    // The same errors as of radii, of a ramp of height 0.8.
                    let apart = (f64::from(found[0]) - want).abs();
                    assert!(apart < 1e-4, "{row:?}: {found:?}, {want}");
                }
            });
        }
    }
}
