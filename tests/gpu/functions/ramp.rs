//! Tones of ramps against their references.

use bevy_comics_testkit::{device::gpu, reference::ramp};
use proptest::prelude::{Just, Strategy, prop_oneof};

use super::{ONE_CODE, for_batches};
use crate::prelude::*;

const STOPS: usize = Ramp::MOST_STOPS;
/// Three numbers for each stop; then how much light arrives, its change over a pixel, and what
/// of it shadows leave.
const ROW: usize = 3 * STOPS + 3;

/// Rows of sorted stops, some of them at the same place.
fn rows() -> impl Strategy<Value = [f32; ROW]> {
    let stop = || {
        (
            prop_oneof![4 => 0.0f32..=1.0, 1 => Just(0.5f32)],
            0.0f32..=1.0,
            prop_oneof![2 => Just(0.0f32), 1 => 0.0f32..=1.0],
        )
    };
    (
        proptest::collection::vec(stop(), STOPS),
        (-1.0f32..=1.0, 0.002f32..0.2, 0.0f32..=1.0),
    )
        .prop_map(|(mut stops, (arriving, width, lit))| {
            stops.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut row = [0.0; ROW];
            for (k, (at, gray, softness)) in stops.into_iter().enumerate() {
                row[3 * k..3 * k + 3].copy_from_slice(&[at, gray, softness]);
            }
            row[ROW - 3..].copy_from_slice(&[arriving, width, lit]);
            row
        })
}

fn ramp_of(row: &[f32; ROW]) -> Ramp {
    Ramp::new((0..STOPS).map(|k| {
        let gray = row[3 * k + 1];
        RampStop::new(row[3 * k], Color::linear_rgb(gray, 1.0 - gray, gray)).soft(row[3 * k + 2])
    }))
}

#[test]
fn tones_of_ramps_match_the_reference() {
    let body = "var ramp: Ramp;
         for (var k = 0u; k < 8u; k++) {
             let gray = i(3u * k + 1u);
             ramp.stops[k] = Stop(vec3(gray, 1.0 - gray, gray), i(3u * k), vec3(0.0), 0.0,
                 i(3u * k + 2u), 0.0);
         }
         return vec4(tone(ramp, i(24u), i(25u)).xy,
             shadowed_tone(ramp, i(24u), i(25u), i(26u)).xy);";
    let import = "#import bevy_comics::toon::ramp::{Ramp, Stop, shadowed_tone, tone}";
    for_batches(rows(), |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let ramp = ramp_of(row);
            let [arriving, width, lit] = [24, 25, 26].map(|k| f64::from(row[k]));
            let tone = ramp::tone(&ramp, arriving, width);
            let shadowed = ramp::shadowed_tone(&ramp, arriving, width, lit);
            let reference = [tone[0], tone[1], shadowed[0], shadowed[1]];
            for (found, reference) in found.into_iter().zip(reference) {
                // An edge rises by 750 per unit at most, times eight edges, times the rounding
                // of its place: below 6e-4.
                assert!(
                    (f64::from(found) - reference).abs() < 0.2 * ONE_CODE,
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    });
}
