//! The shipped functions on the GPU against their twins, on random and
//! adversarial inputs.

mod cartoon_styles;
mod color_styles;
mod contour_response;
mod depth_map;
mod finish;
mod normal;

use bevy::color::{Color, Hsva};
use bevy_comics::{
    BlackFlats, Colorization, ColorizationMode, ContourOperator, Contours, Desaturation, Form,
};
use proptest::{
    collection::vec,
    prelude::{Just, ProptestConfig, Strategy, any, prop_oneof},
    sample::select,
    test_runner::TestRunner,
};

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        Rgb, black_flats, color, colorization, contours, desaturation,
        map::{Frame, Projection},
        window,
    },
};

const COLOR: &str = "#import bevy_comics::effect::color::{srgb_encode, srgb_decode, linear_to_oklab, oklab_to_linear, finite, hue_of, hue_color}";

/// One code of an 8-bit display.
const ONE_CODE: f64 = 1.0 / 255.0;

/// Runs `check` on batches of rows, so that a dispatch pays off.
fn for_batches<const N: usize>(row: impl Strategy<Value = [f32; N]>, check: impl Fn(&[[f32; N]])) {
    let config = ProptestConfig {
        cases: 12,
        max_shrink_iters: 64,
        ..ProptestConfig::default()
    };
    TestRunner::new(config)
        .run(&vec(row, 2048), |rows| {
            check(&rows);
            Ok(())
        })
        .unwrap_or_else(|error| panic!("{error}"));
}

/// A displayed component: random, or one where formulas change their mind.
fn component() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => 0.0f32..=1.0,
        2 => select(vec![0.0, 1.0, 0.5, 0.003_130_8, 0.003_130_9, 1.0 / 255.0, 0.25, 1e-7]),
    ]
}

/// The same, beyond what a display shows.
fn wide_component() -> impl Strategy<Value = f32> {
    prop_oneof![4 => component(), 1 => -2.0f32..8.0, 1 => select(vec![65504.0, -65504.0, -0.0, 1e-30])]
}

fn depth_pair() -> impl Strategy<Value = (f32, f32)> {
    // D and its exact complement, to both ends.
    prop_oneof![
        3 => (0.0f32..=1.0).prop_map(|d| (d, 1.0 - d)),
        1 => (-30i32..0).prop_map(|e| (2f32.powi(e), 1.0)),
        1 => (-30i32..0).prop_map(|e| (1.0, 2f32.powi(e))),
        1 => select(vec![(0.0, 1.0), (1.0, 0.0)]),
    ]
}

fn rgb(row: &[f32]) -> Rgb {
    [row[0], row[1], row[2]].map(f64::from)
}

/// How many codes apart two linear colours are once encoded.
fn codes_apart(gpu: [f32; 4], twin: Rgb) -> f64 {
    let gpu = color::srgb_encode([gpu[0], gpu[1], gpu[2]].map(f64::from));
    let twin = color::srgb_encode(twin);
    (0..3)
        .map(|i| (gpu[i] - twin[i]).abs() / twin[i].abs().max(1.0) / ONE_CODE)
        .fold(0.0, f64::max)
}

fn assert_same_color<const N: usize>(row: &[f32; N], gpu: [f32; 4], twin: Rgb) {
    let apart = codes_apart(gpu, twin);
    assert!(
        apart <= 1.0,
        "{row:?}: {gpu:?} on the GPU, {twin:?} in the twin, {apart} codes apart"
    );
}

/// Distance in units in the last place of the expected single.
fn ulps(gpu: f32, twin: f64) -> f64 {
    let unit = f64::from((twin as f32).abs().max(f32::MIN_POSITIVE));
    let ulp = 2f64.powi(unit.log2().floor() as i32 - 23);
    (f64::from(gpu) - twin).abs() / ulp
}
