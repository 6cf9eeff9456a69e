//! Lines of near, middle and far.

use bevy::color::LinearRgba;
use bevy_comics::lines::LineLayers;
use bevy_comics_testkit::reference::layer_lines;

use super::*;

const BODY: &str = "let s = LineLayers(
        vec4(i(0u), i(1u), i(2u), i(3u)),
        vec4(i(4u), i(5u), i(6u), i(7u)),
        vec4(i(8u), i(9u), i(10u), i(11u)),
        vec3(i(12u), i(13u), i(14u)), 0.0, vec3(i(15u), i(16u), i(17u)), 0.0, vec2(0.0), vec2(0.0),
    );
    let w = vec3(i(18u), i(19u), i(20u));";

/// Fractions that sum to 1.
fn weights() -> impl Strategy<Value = [f32; 3]> {
    (0.0f32..=1.0, 0.0f32..=1.0).prop_map(|(near, rest)| {
        let middle = (1.0 - near) * rest;
        [near, middle, 1.0 - near - middle]
    })
}

#[test]
fn factors_and_inks_match_the_reference() {
    let row = (vec(0.0f32..=1.0, 18), weights()).prop_map(|(settings, weights)| {
        let mut row = [0.0f32; 21];
        row[..18].copy_from_slice(&settings);
        row[18..].copy_from_slice(&weights);
        row
    });
    for_batches(row, |rows| {
        // The uniform has colours times their amounts.
        let packed: Vec<[f32; 21]> = rows
            .iter()
            .map(|row| {
                let mut row = *row;
                for plane in row[..12].chunks_mut(4) {
                    let amount = plane[3];
                    plane[..3].iter_mut().for_each(|channel| *channel *= amount);
                }
                row
            })
            .collect();
        let imports =
            "#import bevy_comics::lines::layer_lines::{LineLayers, layer_factors, layer_ink}";
        let evaluate = |result: &str| gpu().evaluate(imports, &format!("{BODY} {result}"), &packed);
        let factors = evaluate("return vec4(layer_factors(s, w), 0.0, 0.0);");
        let inks = evaluate("return layer_ink(s, w);");
        for ((row, factors), ink) in rows.iter().zip(factors).zip(inks) {
            let color = |at: usize| LinearRgba::rgb(row[at], row[at + 1], row[at + 2]);
            let three = |at: usize| [row[at], row[at + 1], row[at + 2]];
            let s = LineLayers {
                widths: three(12),
                opacities: three(15),
                colors: [color(0), color(4), color(8)],
                color_amounts: [row[3], row[7], row[11]],
                borders: [0.0; 2],
                finds_borders: false,
                by_objects: false,
                softness: 0.0,
            };
            let w = three(18).map(f64::from);
            let reference = layer_lines::factors(&s, w)
                .into_iter()
                .chain(layer_lines::ink(&s, w));
            // Sums of three products of numbers up to 1: at most six roundings of half an ulp of 1.
            for (found, reference) in factors[..2].iter().chain(&ink).zip(reference) {
                let apart = (f64::from(*found) - reference).abs();
                assert!(
                    apart < 6.0 * 2f64.powi(-24),
                    "{row:?}: {found}, {reference}"
                );
            }
        }
    });
}
