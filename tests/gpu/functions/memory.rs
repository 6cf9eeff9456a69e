//! What lines remember of the frames before, and lines in the colour of surfaces.

use bevy_comics_testkit::reference::{
    edge::is_in_front,
    memory::{
        cubic_weights, frames_at, is_limited, is_steady, missing_at, remembered, share_at,
        unsteady_at,
    },
    surface::surface_ink,
};

use super::*;

#[test]
fn the_memory_of_lines_matches_the_reference() {
    let ink = || 0.0f32..=1.0;
    let row = (
        (ink(), ink(), ink(), ink()),
        (0.03125f32..=1.0, 0.0f32..=12.0, 0u32..300),
    )
        .prop_map(|((past, now, a, b), (share, speed, frames))| {
            let [least, most] = [a.min(b).min(now), a.max(b).max(now)];
            // Half of the lines stand still.
            let speed = (speed - 6.0).max(0.0);
            [past, now, least, most, share, speed, frames as f32]
        });
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::edge::is_in_front
             #import bevy_comics::lines::memory::{frames_at, remembered, share_at}",
            "let frames = frames_at(i(6u), i(4u), i(5u));
             let share = share_at(frames, i(5u));
             let ink = remembered(vec3(i(0u)), vec3(i(1u)), vec3(i(2u)), vec3(i(3u)), share);
             return vec4(share, ink.y, frames, f32(is_in_front(i(0u), i(1u), i(2u))));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [past, now, least, most, share, speed, before] = row.map(f64::from);
            let frames = frames_at(before, share, speed);
            let part = share_at(frames, speed);
            let ink = remembered(past, now, [least, most], part);
            for (found, want) in found.into_iter().zip([part, ink, frames]) {
                let away = (f64::from(found) - want).abs();
                assert!(away < 1e-5 * want.max(1.0), "{row:?}: {found}, {want}");
            }
            if (past - now - least).abs() > 1e-6 {
                let uncovered = is_in_front(past, now, least);
                assert_eq!(found[3] == 1.0, uncovered, "{row:?}");
            }
        }
    });
}

#[test]
fn missing_lines_are_counted_like_the_reference() {
    let row = (1u32..=128, 0u32..=17, any::<bool>(), 0.0f32..=0.1).prop_map(
        |(frames, missing, is_missing, speed)| {
            [frames as f32, missing as f32, f32::from(is_missing), speed]
        },
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::memory::{
                is_limited, missing_at, pack_counts, unpack_counts,
            }",
            "let counts = unpack_counts(pack_counts(i(0u), i(1u), 48.0));
             let missing = missing_at(counts.y, i(2u) == 1.0);
             return vec4(counts.xy, missing, f32(is_limited(missing, i(3u))));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [frames, before, is_missing, speed] = row.map(f64::from);
            let missing = missing_at(before, is_missing == 1.0);
            let limited = f64::from(is_limited(missing, speed));
            let want = [frames, before, missing, limited];
            assert_eq!(found.map(f64::from), want, "{row:?}");
        }
    });
}

#[test]
fn unsteady_surfaces_match_the_reference() {
    let row = (1u32..=128, 0u32..=48, any::<bool>(), 0.0f32..=0.1).prop_map(
        |(frames, before, has_changed, speed)| {
            [frames as f32, before as f32, f32::from(has_changed), speed]
        },
    );
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::memory::{
                is_steady, pack_counts, unpack_counts, unsteady_at,
            }",
            "let counts = unpack_counts(pack_counts(i(0u), 17.0, i(1u)));
             let unsteady = unsteady_at(counts.z, i(2u) == 1.0, i(3u));
             return vec4(counts.xz, unsteady, f32(is_steady(unsteady)));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [frames, before, has_changed, speed] = row.map(f64::from);
            let unsteady = unsteady_at(before, has_changed == 1.0, speed);
            let steady = f64::from(is_steady(unsteady));
            let want = [frames, before, unsteady, steady];
            assert_eq!(found.map(f64::from), want, "{row:?}");
        }
    });
}

#[test]
fn cubic_weights_match_the_reference() {
    for_batches((0.0f32..=1.0).prop_map(|f| [f]), |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::memory::cubic_weights",
            "return cubic_weights(i(0u));",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let want = cubic_weights(f64::from(row[0]));
            for (found, want) in found.into_iter().zip(want) {
                assert!(
                    (f64::from(found) - want).abs() < 1e-6,
                    "{row:?}: {found}, {want}"
                );
            }
        }
    });
}

#[test]
fn surface_ink_matches_the_reference() {
    let part = || 0.0f32..=1.0;
    let row = (part(), part(), part(), part(), 0.0f32..=2.0)
        .prop_map(|(r, g, b, darken, saturate)| [r, g, b, darken, saturate]);
    for_batches(row, |rows| {
        let results = gpu().evaluate(
            "#import bevy_comics::lines::surface::surface_ink",
            "return vec4(surface_ink(vec3(i(0u), i(1u), i(2u)), i(3u), i(4u)), 0.0);",
            rows,
        );
        for (row, found) in rows.iter().zip(results) {
            let [r, g, b, darken, saturate] = row.map(f64::from);
            let want = surface_ink([r, g, b], darken, saturate);
            for (found, want) in found.into_iter().zip(want) {
                assert!(
                    (f64::from(found) - want).abs() < 1e-5,
                    "{row:?}: {found}, {want}"
                );
            }
        }
    });
}
