//! Normals of simpler forms against their references.

use bevy_comics_testkit::{
    device::gpu,
    reference::{detail, mix, proxy, stylized_highlight::unit},
};
use proptest::{collection::vec, prelude::Strategy};

use super::for_batches;
use crate::prelude::*;

const IMPORT: &str =
    "#import bevy_comics::toon::proxy::{Proxy, between, proxy_amount, proxy_normal}";

/// A place, half sizes, a normal, and how much of the ellipsoid's normal there is.
#[test]
fn normals_of_forms_match_the_reference() {
    let body = "let half = vec3(i(3u), i(4u), i(5u));
         let f = Proxy(vec3(0.5), 1.0, 1.0 / (half * half), 1.0, 1.0, 1.0);
         let place = vec3(i(0u), i(1u), i(2u));
         let other = normalize(proxy_normal(f, place + 0.5));
         return vec4(between(normalize(vec3(i(6u), i(7u), i(8u))), other, i(9u)), 0.0);";
    let rows =
        (vec(-1.0f32..1.0, 6), vec(0.2f32..3.0, 3), 0.0f32..=1.0).prop_map(|(v, half, amount)| {
            let mut row = [0.0; 10];
            row[..3].copy_from_slice(&v[..3]);
            row[3..6].copy_from_slice(&half);
            row[6..9].copy_from_slice(&v[3..]);
            row[9] = amount;
            row
        });
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, body, rows)) {
            let three = |k: usize| [0, 1, 2].map(|c| f64::from(row[k + c]));
            let normal = unit(three(6));
            let other = proxy::ellipsoid_normal(three(0), three(3));
            let amount = f64::from(row[9]);
            let reference = proxy::between(normal, other, amount);
            let long: f64 = (0..3)
                .map(|c| mix(normal[c], other[c], amount).powi(2))
                .sum();
            // Near the middle, and where both are opposite, the direction is not decided.
            if long < 1e-4 || three(0).iter().all(|x| x.abs() < 1e-3) {
                continue;
            }
            for (found, reference) in found.into_iter().zip(reference) {
                assert!(
                    (f64::from(found) - reference).abs() < 1e-4,
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    });
}

#[test]
fn forms_change_with_the_distance() {
    let body = "let f = Proxy(vec3(0.0), i(0u), vec3(1.0), i(1u), i(2u), 1.0 / log(i(3u)));
         return vec4(proxy_amount(f, i(4u)));";
    let rows = (
        0.0f32..=1.0,
        0.0f32..=1.0,
        0.1f32..10.0,
        1.2f32..20.0,
        0.01f32..100.0,
    )
        .prop_map(|(a, b, near, ratio, z)| [a, b, near, ratio, z]);
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(IMPORT, body, rows)) {
            let [near_amount, far_amount, near, ratio, z] = *row;
            let near = detail::detail(DetailAxis::Depth { from: near, ratio }, f64::from(z));
            let reference = mix(f64::from(far_amount), f64::from(near_amount), near);
            assert!(
                (f64::from(found[0]) - reference).abs() < 1e-4,
                "{row:?}: {}, not {reference}",
                found[0]
            );
        }
    });
}

/// Vectors of any length at unit length; 0 stays 0.
#[test]
fn vectors_of_any_length_have_directions() {
    let import = "#import bevy_comics::toon::proxy::unit_or_none";
    let body = "return vec4(unit_or_none(vec3(i(0u), i(1u), i(2u))), 0.0);";
    let rows = (vec(-1.0f32..1.0, 3), -18.0f32..18.0)
        .prop_map(|(v, size)| [0, 1, 2].map(|c| v[c] * 10f32.powf(size)));
    for_batches(rows, |rows| {
        for (row, found) in rows.iter().zip(gpu().evaluate(import, body, rows)) {
            let reference = unit(row.map(f64::from));
            for (found, reference) in found.into_iter().zip(reference) {
                assert!(
                    (f64::from(found) - reference).abs() < 1e-6,
                    "{row:?}: {found}, not {reference}"
                );
            }
        }
    });
    assert_eq!(gpu().evaluate(import, body, &[[0.0; 3]])[0], [0.0; 4]);
}
