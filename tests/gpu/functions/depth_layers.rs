//! The colours of near, middle and far.

use bevy::color::ColorToComponents;
use bevy_comics_testkit::reference::depth_layers;

use super::*;
use crate::prelude::*;

const PLANES: &str = "#import bevy_comics::depth::map::layer_weights
    #import bevy_comics::effects::depth_layers::{LayerColors, DepthLayers, layers_color}";

/// What the shader takes of a plane.
fn packed(s: &DepthLayer) -> [f32; 6] {
    let lab = Oklaba::from(s.tint).to_f32_array();
    [
        lab[1] * s.tint_amount,
        lab[2] * s.tint_amount,
        s.saturation * (1.0 - s.tint_amount),
        s.contrast,
        0.5 * (1.0 - s.contrast) + s.brightness,
        s.bands as f32,
    ]
}

const COLOR_BODY: &str = "let z = vec2(0.0);
    let s = DepthLayers(
        LayerColors(vec2(i(0u), i(1u)), i(2u), i(3u), i(4u), i(5u), z),
        LayerColors(vec2(i(6u), i(7u)), i(8u), i(9u), i(10u), i(11u), z),
        LayerColors(vec2(i(12u), i(13u)), i(14u), i(15u), i(16u), i(17u), z),
        vec2(i(18u), i(19u)), i(20u), i(21u),
    );
    let w = layer_weights(s.borders, s.softness, i(22u));
    return vec4(layers_color(s, vec3(i(23u), i(24u), i(25u)), w, i(26u)), 0.0);";

type Case = (DepthLayers, [f32; 3], f32, f32);

fn row((s, color, d, change): &Case) -> [f32; 27] {
    let mut row = [0.0; 27];
    let planes = [s.foreground, s.middle, s.background]
        .map(|s| packed(&s))
        .concat();
    row[..18].copy_from_slice(&planes);
    row[18..23].copy_from_slice(&[
        s.foreground_end,
        s.background_start,
        s.softness,
        s.amount,
        *d,
    ]);
    row[23..26].copy_from_slice(color);
    row[26] = *change;
    row
}

fn style() -> impl Strategy<Value = DepthLayer> {
    (
        0.0f32..=2.0,
        (0.0f32..=1.0, 0.0f32..=1.0, 0.0f32..=1.0),
        prop_oneof![Just(0.0f32), Just(1.0f32), 0.0f32..=1.0],
        0.0f32..=2.0,
        -0.5f32..=0.5,
        select(vec![0, 0, 1, 2, 5, 8]),
    )
        .prop_map(
            |(saturation, (r, g, b), tint_amount, contrast, brightness, bands)| DepthLayer {
                saturation,
                tint: Color::linear_rgb(r, g, b),
                tint_amount,
                contrast,
                brightness,
                bands,
                ..DepthLayer::PLAIN
            },
        )
}

fn settings() -> impl Strategy<Value = DepthLayers> {
    (
        (style(), style(), style()),
        (0.0f32..=1.0, 0.0f32..=1.0),
        0.01f32..=0.5,
        prop_oneof![Just(1.0f32), 0.0f32..=1.0],
    )
        .prop_map(
            |((near, middle, far), (a, b), softness, amount)| DepthLayers {
                foreground: near,
                middle,
                background: far,
                granularity: Granularity::Pixel,
                borders: LayerBorders::Fixed,
                foreground_end: a.min(b),
                background_start: a.max(b),
                softness,
                amount,
            },
        )
}

fn for_cases(cases: impl Strategy<Value = Case>, check: impl Fn(&Case, [f32; 4])) {
    let config = ProptestConfig {
        cases: 8,
        max_shrink_iters: 64,
        ..ProptestConfig::default()
    };
    TestRunner::new(config)
        .run(&vec(cases, 2048), |cases| {
            let rows: Vec<[f32; 27]> = cases.iter().map(row).collect();
            for (case, result) in cases.iter().zip(gpu().evaluate(PLANES, COLOR_BODY, &rows)) {
                check(case, result);
            }
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn the_colors_of_planes_match_the_reference_and_stay_in_gamut() {
    let color = (component(), component(), component()).prop_map(|(r, g, b)| [r, g, b]);
    // A step between bands that is wide enough for the rounding of the lightness.
    let cases = (settings(), color, 0.0f32..=1.0, 0.05f32..=0.3);
    for_cases(cases, |(s, c, d, change), result| {
        let borders = [s.foreground_end, s.background_start].map(f64::from);
        let weights = depth_layers::weights(borders, f64::from(s.softness), f64::from(*d));
        let reference = depth_layers::color(s, rgb(c), weights, f64::from(*change));
        let apart = codes_apart(result, reference);
        assert!(
            apart <= 1.0,
            "{s:?}, {c:?} at {d}: {result:?} on the GPU, {reference:?} in the reference, {apart} codes apart"
        );
        assert!(
            result[..3].iter().all(|x| (0.0..=1.0).contains(x)),
            "{s:?}, {c:?} at {d} became {result:?}"
        );
    });
}

#[test]
fn the_weights_of_planes_sum_to_one() {
    let row = (0.0f32..=1.0, 0.0f32..=1.0, 0.0f32..=0.5, 0.0f32..=1.0)
        .prop_map(|(a, b, softness, d)| [a.min(b), a.max(b), softness, d]);
    for_batches(row, |rows| {
        let body = "return vec4(layer_weights(vec2(i(0u), i(1u)), i(2u), i(3u)), 0.0);";
        for (row, w) in rows.iter().zip(gpu().evaluate(PLANES, body, rows)) {
            let sum = f64::from(w[0]) + f64::from(w[1]) + f64::from(w[2]);
            assert!((sum - 1.0).abs() <= 2f64.powi(-23), "{row:?}: {w:?}");
            assert!(
                w[..3].iter().all(|w| (0.0..=1.0).contains(w)),
                "{row:?}: {w:?}"
            );
            let [a, b, softness, d] = row.map(f64::from);
            let reference = depth_layers::weights([a, b], softness, d);
            // The slope of a border is 1.5 / softness, and D has an error of an ulp.
            let slope = 1.5 * 2f64.powi(-22) / softness.max(1e-6);
            if slope > 0.01 {
                continue;
            }
            for i in 0..3 {
                let apart = (f64::from(w[i]) - reference[i]).abs();
                assert!(apart <= slope + 1e-6, "{row:?}: {w:?}, {reference:?}");
            }
        }
    });
}

/// Near and far are what they would be alone, and a plain look changes nothing.
#[test]
fn a_plane_has_its_own_look_alone() {
    let color = (0.02f32..=0.98, 0.02f32..=0.98, 0.02f32..=0.98).prop_map(|(r, g, b)| [r, g, b]);
    let cases = (color, 0.0f32..=1.0).prop_map(|(c, d)| {
        let far = DepthLayer {
            saturation: 0.0,
            ..DepthLayer::PLAIN
        };
        (
            DepthLayers {
                background: far,
                ..DepthLayers::PLAIN
            },
            c,
            d,
            0.1,
        )
    });
    for_cases(cases, |(s, c, d, _), result| {
        let same = (0..3).all(|i| (result[i] - c[i]).abs() < 1e-5);
        let spread =
            result[0].max(result[1]).max(result[2]) - result[0].min(result[1]).min(result[2]);
        if *d < s.background_start - 0.5 * s.softness {
            assert!(same, "{c:?} at {d} became {result:?}");
        } else if *d > s.background_start + 0.5 * s.softness {
            // Grey of the same lightness.
            assert!(spread < 1e-5, "{c:?} at {d} became {result:?}");
            let [before, after] =
                [*c, [result[0], result[1], result[2]]].map(|c| color::linear_to_oklab(rgb(&c))[0]);
            assert!((before - after).abs() < 1e-5, "{c:?}: {before}, {after}");
        }
    });
}
