//! Where the two sides of a crease meet.

use bevy_comics_testkit::reference::fold::fold_bend;

use super::*;

const FOLD: &str = "#import bevy_comics::lines::fold::{Fold, fold_bend}";

/// Two planes that meet along a line: the line is found, wherever and however it runs.
#[test]
fn planes_meet_where_they_meet() {
    let row = (
        -0.5f32..=0.5,
        -1.0f32..=1.0,
        1e-4f32..=0.01,
        -0.01f32..=0.01,
        -0.01f32..=0.01,
    )
        .prop_map(|(offset, slope, bend, tilt, along)| [offset, slope, bend, tilt, along]);
    for_batches(row, |rows| {
        // The depth of two planes, of which the nearer one counts: a ridge.
        let depths = |row: &[f32]| {
            let [offset, slope, bend, tilt, along] = [0, 1, 2, 3, 4].map(|i| f64::from(row[i]));
            let depth = move |x: f64, y: f64| {
                let beyond = x - (offset + slope * y);
                (0.5 + tilt * x + along * y - bend * beyond.max(0.0)) as f32
            };
            let across = [-1.5, -0.5, 0.5, 1.5].map(|x| depth(x, 0.0));
            let beside = [-1.5, 1.5].map(|x| [depth(x, -1.0), depth(x, 1.0)]);
            (across, beside)
        };
        // The run of cracks says nearly the same.
        let run = |row: &[f32]| [0.7 * row[0], 0.75 * row[1]];
        let inputs: Vec<[f32; 10]> = rows
            .iter()
            .map(|row| {
                let ([a, b, c, d], [[e, f], [g, h]]) = depths(row);
                let [offset, slope] = run(row);
                [a, b, c, d, e, f, g, h, offset, slope]
            })
            .collect();
        let results = gpu().evaluate(
            FOLD,
            "let f = Fold(vec4(i(0u), i(1u), i(2u), i(3u)), i(4u), i(5u), i(6u), i(7u));
             return vec4(fold_bend(f, 0.1, vec2(i(8u), i(9u))), 0.0, 0.0);",
            &inputs,
        );
        for (row, found) in rows.iter().zip(results) {
            let (across, beside) = depths(row);
            let across = across.map(f64::from);
            let beside = beside.map(|b| b.map(f64::from));
            let reference = fold_bend(across, beside, 0.1, run(row).map(f64::from));
            let [offset, slope] = [0, 1].map(|i| f64::from(row[i]));
            // Depths near 1/2 are stored in steps of 6e-8, eight of them in each result.
            let rounding = 8.0 * 6e-8 / f64::from(row[2]);
            let is = |got: [f64; 2], want: [f64; 2], by: f64| {
                (0..2).all(|i| (got[i] - want[i]).abs() <= by)
            };
            let got = [found[0], found[1]].map(f64::from);
            let reference = reference.expect("they bend");
            assert!(is(got, reference, 1e-3), "{row:?}: {got:?}, {reference:?}");
            let truth = [offset.clamp(-0.49, 0.49), slope];
            assert!(
                is(got, truth, 0.011 + rounding),
                "{row:?}: {got:?}, {truth:?}"
            );
        }
    });
}

/// A plane does not bend, and far from the crack nothing meets: the other rule counts.
#[test]
fn planes_that_do_not_meet_say_nothing() {
    let flat = [0.5f32, 0.51, 0.52, 0.53, 0.5, 0.5, 0.53, 0.53];
    let far = [0.5f32, 0.51, 0.54, 0.54, 0.5, 0.5, 0.54, 0.54];
    let steep = [0.5f32, 0.51, 0.51, 0.5, 0.4, 0.6, 0.6, 0.4];
    // They meet in the middle, which is not where the run of cracks is.
    let unlike = [0.5f32, 0.51, 0.51, 0.5, 0.49, 0.51, 0.51, 0.49];
    let sky = [0.0f32; 8];
    let jump = [0.3f32, 0.5, 0.51, 0.51, 0.3, 0.3, 0.51, 0.51];
    let results = gpu().evaluate(
        FOLD,
        "let f = Fold(vec4(i(0u), i(1u), i(2u), i(3u)), i(4u), i(5u), i(6u), i(7u));
         return vec4(fold_bend(f, 0.1, vec2(0.3, 0.1)), 0.0, 0.0);",
        &[flat, far, steep, unlike, sky, jump],
    );
    for (found, row) in results.iter().zip([flat, far, steep, unlike, sky, jump]) {
        let d = row.map(f64::from);
        let reference = fold_bend(
            [d[0], d[1], d[2], d[3]],
            [[d[4], d[5]], [d[6], d[7]]],
            0.1,
            [0.3, 0.1],
        );
        assert_eq!(reference, None, "{row:?}");
        assert_eq!([found[0], found[1]], [0.3, 0.1], "{row:?}");
    }
}
