//! Shadows and highlights of one light, and of several.

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        light::highlight_fraction,
        toon::{
            reflect,
            specular::{self, Lit},
            surface::{self, Arriving, Surface, biased_over_pixel, cosine_over_pixel, half_way},
        },
    },
};

use super::{READ, Row, assert_color, lamps, light, rows, surface};
use crate::prelude::*;

/// How far rounding moves a smooth step over a cosine: by 1.5 over its width. The cosine of two unit
/// vectors and a bias is right to 1e-6, and so is its change over a pixel.
pub fn doubt_of_an_edge(s: &Surface, direction: DVec3) -> f64 {
    let width = biased_over_pixel(s, direction).max(2e-5);
    (1.5 * 1e-6 / width).min(1.0) + 1e-6
}

/// How far rounding moves a highlight. Its distribution is right to eight roundings over the square of
/// the roughness (see `the_toons_light_matches_the_reference`), and so are both ends of its edge.
pub fn doubt_of_a_highlight(row: &Row, s: &Surface, lamp: &Arriving) -> f64 {
    let half = half_way(lamp.to_highlight, s.to_eye);
    let roughness = (s.roughness * s.roughness).max(0.002);
    let width = 0.5 * cosine_over_pixel(&s.foot, half);
    let at = |by: f64| highlight_fraction(roughness, (s.normal.dot(half) + by).clamp(0.0, 1.0));
    let change = (at(width) - at(-width)).max(2e-5);
    let slack = 8.0 * 2f64.powi(-23) / (roughness * roughness);
    let strength = f64::from(row[super::SETTINGS + 3]) * (1.0 - 1.4 * s.roughness).powi(2);
    strength * ((1.5 * 3.0 * slack / change).min(1.0) + 1e-5)
}

/// Turns the normal of a row to where the highlight of its first light is, or nearly.
fn shiny(mut row: Row) -> Row {
    let s = surface(&row);
    let lamp = DVec3::new(row[9].into(), row[10].into(), row[11].into());
    let mirror = half_way(lamp, s.to_eye) + 0.3 * s.normal;
    let normal = mirror.normalize().as_vec3().to_array();
    row[super::SURFACE..super::SURFACE + 3].copy_from_slice(&normal);
    row
}

#[test]
fn angles_and_sizes_of_surfaces_match_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::surface::{{biased_cosine, cosine_over_pixel, pixel_size, half_way}}
         {READ}"
    );
    let body = "let s = surface();
         let l = lamp(0u);
         return vec4(biased_cosine(s, l.to_light), cosine_over_pixel(s.foot, l.to_light),
             pixel_size(s.foot), dot(half_way(l.to_light, s.to_eye), s.normal));";
    let rows = rows(4096, 1);
    for (row, found) in rows
        .iter()
        .zip(gpu().evaluate_alone(&[], &import, body, &rows))
    {
        let s = surface(row);
        let to = super::vector(row, 6);
        let references = [
            surface::biased_cosine(&s, to),
            cosine_over_pixel(&s.foot, to),
            surface::pixel_size(&s.foot),
            half_way(to, s.to_eye).dot(s.normal),
        ];
        // Nearly opposite vectors cancel.
        let cancelled = (to + s.to_eye).length();
        for (k, (found, reference)) in found.into_iter().zip(references).enumerate() {
            let off = (f64::from(found) - reference).abs();
            let slack = if k == 3 { 1e-6 / cancelled } else { 1e-6 };
            assert!(off <= slack, "{k} of {row:?}: {found}, not {reference}");
        }
    }
}

#[test]
fn changes_of_thresholds_over_pixels_match_the_reference() {
    let import = format!(
        "#import bevy_comics::toon::surface::{{bias_of, biased_over_pixel}}
         {READ}"
    );
    let body =
        "return vec4(biased_over_pixel(surface(), lamp(0u).to_light), bias_of(i(139u)), 0.0, 0.0);";
    let rows = rows(4096, 7);
    let results = gpu().evaluate_alone(&[], &import, body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let over = biased_over_pixel(&surface(row), super::vector(row, 6));
        let bias = surface::bias_of(row[super::POWER].into());
        // Sums of products of numbers up to 1; a threshold up to 20.
        assert!(
            (f64::from(found[0]) - over).abs() < 1e-6,
            "{row:?}: {found:?}"
        );
        assert!(
            (f64::from(found[1]) - bias).abs() < 1e-5,
            "{row:?}: {found:?}"
        );
    }
}

/// Between opposite directions there is none, rather than what is not a number.
#[test]
fn opposite_directions_have_no_half_way() {
    let import = format!("#import bevy_comics::toon::surface::half_way\n{READ}");
    let body = "return vec4(half_way(v(6u), -v(6u)), 0.0);";
    for found in gpu().evaluate_alone(&[], &import, body, &rows(64, 2)) {
        assert!(found[0].is_finite(), "{found:?}");
    }
}

#[test]
fn shadows_and_highlights_of_a_light_match_the_reference() {
    let import =
        format!("#import bevy_comics::toon::reflect::{{highlight_of, unshadowed}}\n{READ}");
    let body = "read_settings();
         let s = surface();
         let l = lamp(0u);
         let left = unshadowed(s, l);
         return vec4(left, highlight_of(s, l, l.lit), 0.0, 0.0);";
    let rows: Vec<Row> = rows(8192, 3).into_iter().map(shiny).collect();
    let mut telling = 0;
    let results = gpu().evaluate_alone(&[("RAMP_STOPS", Some(3))], &import, body, &rows);
    for (row, found) in rows.iter().zip(results) {
        let mut row = *row;
        row[super::COUNT] = 1.0;
        let (s, lamp) = (surface(&row), lamps(&row)[0]);
        let light = light(&row, RampBlend::Multiply, None);
        let left = reflect::unshadowed(&light, &s, &lamp);
        let off = (f64::from(found[0]) - left).abs();
        let doubt = doubt_of_an_edge(&s, lamp.to_light);
        assert!(off <= doubt, "{row:?}: {}, not {left}", found[0]);
        let highlight = reflect::highlight_of(&light, &s, &lamp, lamp.lit);
        let off = (f64::from(found[1]) - highlight).abs();
        let doubt = doubt_of_a_highlight(&row, &s, &lamp);
        assert!(off <= doubt, "{row:?}: {}, not {highlight}", found[1]);
        telling += usize::from(highlight > 0.1 && doubt < 0.02);
    }
    assert!(telling > 500, "{telling} highlights");
}

/// A light right behind the surface, seen from the eye: there is no direction half way, and the
/// highlight is that of one across the normal.
#[test]
fn the_highlight_of_a_light_behind_a_surface_matches_the_reference() {
    let import = format!("#import bevy_comics::toon::reflect::highlight_of\n{READ}");
    let body = "read_settings();
         var s = surface();
         let l = lamp(0u);
         s.to_eye = -l.to_highlight;
         return vec4(highlight_of(s, l, 1.0));";
    let rows = rows(256, 4);
    let results = gpu().evaluate_alone(&[("RAMP_STOPS", Some(3))], &import, body, &rows);
    for (row, [found, ..]) in rows.iter().zip(results) {
        let mut row = *row;
        row[super::COUNT] = 1.0;
        let lamp = lamps(&row)[0];
        let s = Surface {
            to_eye: -lamp.to_highlight,
            ..surface(&row)
        };
        let light = light(&row, RampBlend::Multiply, None);
        let reference = reflect::highlight_of(&light, &s, &lamp, 1.0);
        let off = (f64::from(found) - reference).abs();
        let doubt = doubt_of_a_highlight(&row, &s, &lamp);
        assert!(off <= doubt, "{row:?}: {found}, not {reference}");
    }
}

/// The highlights of several lights, with and without a search for the brightest of them.
#[test]
fn highlights_of_several_lights_match_the_reference() {
    let import =
        format!("#import bevy_comics::toon::specular::{{Shine, shine_of, with_light}}\n{READ}");
    let body = "read_settings();
         let s = surface();
         var shine: Shine;
         for (var k = 0u; k < u(138u); k++) {
             let l = lamp(k);
             shine = with_light(shine, s, l, l.color, l.lit);
         }
         return vec4(shine_of(shine, s), 0.0);";
    let rows: Vec<Row> = rows(4096, 6).into_iter().map(shiny).collect();
    for definitions in [
        &[("RAMP_STOPS", Some(3))][..],
        &[("RAMP_STOPS", Some(3)), ("KEY_LIGHT", None)],
    ] {
        let results = gpu().evaluate_alone(definitions, &import, body, &rows);
        for (row, found) in rows.iter().zip(results) {
            assert!(found.iter().all(|x| x.is_finite()), "{row:?}: {found:?}");
            let s = surface(row);
            let light = light(row, RampBlend::Multiply, None);
            let lit = |lamp: Arriving| Lit {
                lamp,
                color: lamp.color,
                left: lamp.lit,
            };
            let lit: Vec<Lit> = lamps(row).into_iter().map(lit).collect();
            let reference = specular::shine(&light, &s, &lit, None);
            let doubt: DVec3 = (lit.iter())
                .map(|lit| lit.color * doubt_of_a_highlight(row, &s, &lit.lamp))
                .sum();
            assert_color(
                row,
                found,
                reference,
                doubt.max_element() + 1e-6 * reference.max_element(),
            );
        }
    }
}
