//! Tones of ramps against their reference.

use bevy_comics_testkit::reference::toon::tones::Tones;

use super::*;
use crate::prelude::*;

const STOPS: usize = Ramp::MOST_STOPS;
/// Three numbers for each stop; then how much light arrives, its change over a pixel, and what
/// of it shadows leave.
const ROW: usize = 3 * STOPS + 3;

/// Rows of sorted stops, some of them at the same place.
fn rows() -> impl Strategy<Value = [f32; ROW]> {
    let at = prop_oneof![4 => 0.0f32..=1.0, 1 => Just(0.5f32)];
    let softness = prop_oneof![2 => Just(0.0f32), 1 => 0.0f32..=1.0];
    let stops = vec((at, 0.0f32..=1.0, softness), STOPS);
    let place = (-1.0f32..=1.0, 0.002f32..0.2, 0.0f32..=1.0);
    (stops, place).prop_map(|(mut stops, (arriving, width, lit))| {
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut row = [0.0; ROW];
        for (slots, (at, gray, softness)) in row.chunks_exact_mut(3).zip(stops) {
            slots.copy_from_slice(&[at, gray, softness]);
        }
        row[ROW - 3..].copy_from_slice(&[arriving, width, lit]);
        row
    })
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
            let stop = |k: usize| {
                let [at, gray, softness] = [0, 1, 2].map(|n| row[3 * k + n]);
                RampStop::new(at, Color::linear_rgb(gray, 1.0 - gray, gray)).soft(softness)
            };
            let tones = Tones::new(&Ramp::new((0..STOPS).map(stop)), 1.0);
            let [arriving, width, lit] = [24, 25, 26].map(|k| f64::from(row[k]));
            let tone = tones.at(arriving, width);
            let shadowed = tones.shadowed(arriving, width, lit);
            let reference = [tone.x, tone.y, shadowed.x, shadowed.y];
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
