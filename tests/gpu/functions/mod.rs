//! Compares the crate's WGSL functions with their references, on random inputs and on
//! edge cases.

mod art_map;
mod bend;
mod blocks;
mod bound;
mod color_harmony;
mod color_styles;
mod depth_map;
mod fog;
mod footprint;
pub mod halftone;
mod hatch;
mod hatching;
mod hidden;
mod jumps;
mod listed;
mod middles;
mod nested;
mod normal;
mod overshoot;
mod paint;
mod proxy;
mod ramp;
mod ramp_map;
mod rect;
mod ribbon;
mod shadow_texels;
mod sheet;
mod similarity;
mod stroke_level;
mod stylized_highlight;
mod surface;
mod tolerance;
mod toon;
mod toon_styles;
mod walk;

use std::fmt::Debug;

use bevy_comics_testkit::{
    device::gpu,
    reference::{
        Rgb, color,
        map::{Frame, Projection},
    },
};
use proptest::{
    collection::vec,
    prelude::{Just, ProptestConfig, Strategy, any, prop_oneof},
    sample::select,
    test_runner::TestRunner,
};

use crate::prelude::*;

const COLOR: &str = "#import bevy_comics::effect::color::{srgb_encode, srgb_decode, linear_to_oklab, oklab_to_linear, finite, hue_of, hue_color}";

/// One code of an 8-bit display, where white is 1.
const ONE_CODE: f64 = 1.0 / 255.0;

/// Runs `check` on 12 batches of 2048 rows. One dispatch per batch: a dispatch per
/// row would be slow.
fn for_batches<T: Debug>(row: impl Strategy<Value = T>, check: impl Fn(&[T])) {
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

/// A color component in [0, 1]: random, or at a border between two branches of a
/// formula.
fn component() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => 0.0f32..=1.0,
        2 => select(vec![0.0, 1.0, 0.5, 0.003_130_8, 0.003_130_9, 1.0 / 255.0, 0.25, 1e-7]),
    ]
}

/// A color component that may lie outside [0, 1].
fn wide_component() -> impl Strategy<Value = f32> {
    prop_oneof![4 => component(), 1 => -2.0f32..8.0, 1 => select(vec![65504.0, -65504.0, -0.0, 1e-30])]
}

/// D and its complement L, down to 2^-30 at both ends.
fn depth_pair() -> impl Strategy<Value = (f32, f32)> {
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

/// Largest difference of two linear colors in display codes; above 1 it is relative
/// to the largest component of the reference's: components are mixed, and so are their rounding
/// errors.
fn codes_apart(gpu: [f32; 4], reference: Rgb) -> f64 {
    let gpu = color::srgb_encode([gpu[0], gpu[1], gpu[2]].map(f64::from));
    let reference = color::srgb_encode(reference);
    let largest = reference
        .iter()
        .fold(1.0, |largest, x| f64::max(largest, x.abs()));
    (0..3)
        .map(|i| (gpu[i] - reference[i]).abs() / largest / ONE_CODE)
        .fold(0.0, f64::max)
}

fn assert_same_color<const N: usize>(row: &[f32; N], gpu: [f32; 4], reference: Rgb) {
    let apart = codes_apart(gpu, reference);
    assert!(
        apart <= 1.0,
        "{row:?}: {gpu:?} on the GPU, {reference:?} in the reference, {apart} codes apart"
    );
}

/// Error in units in the last place of the expected value as `f32`.
fn ulps(gpu: f32, reference: f64) -> f64 {
    let unit = f64::from((reference as f32).abs().max(f32::MIN_POSITIVE));
    let ulp = 2f64.powi(unit.log2().floor() as i32 - 23);
    (f64::from(gpu) - reference).abs() / ulp
}
