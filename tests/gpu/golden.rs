//! Reference pictures of every preset, on the scenes it is for, 320x180. To make them
//! anew: `cargo run --example pictures -- golden`, then look at them.

use std::path::PathBuf;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::{ComicStyle, Contours, presets};
use nv_flip::{FlipImageRgb8, FlipPool};

use crate::common::{
    scenes::BuiltIn,
    studio::{Studio, golden_presets},
};

fn flip_mean(reference: &image::RgbaImage, picture: &image::RgbaImage) -> f32 {
    let rgb = |p: &image::RgbaImage| -> FlipImageRgb8 {
        let bytes: Vec<u8> = p.pixels().flat_map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
        FlipImageRgb8::with_data(p.width(), p.height(), &bytes)
    };
    let map = nv_flip::flip(
        rgb(reference),
        rgb(picture),
        nv_flip::DEFAULT_PIXELS_PER_DEGREE,
    );
    FlipPool::from_image(&map).mean()
}

/// The picture, with the reference's pixel where no channel is more than one
/// code away. Adapters round apart: CPU drivers take the processor's own
/// approximate reciprocals, which are not the same on every make, and a gradient
/// of the scene then has its steps elsewhere.
fn as_rounded(reference: &image::RgbaImage, picture: &image::RgbaImage) -> image::RgbaImage {
    let mut rounded = picture.clone();
    for (pixel, reference) in rounded.pixels_mut().zip(reference.pixels()) {
        if (0..3).all(|i| pixel[i].abs_diff(reference[i]) <= 1) {
            *pixel = *reference;
        }
    }
    rounded
}

/// The share of the pixels that are unlike every pixel of the reference within
/// one pixel of them: the step between two bands may lie a pixel further where
/// the gradient below it is rounded otherwise.
fn far_off(reference: &image::RgbaImage, picture: &image::RgbaImage) -> f64 {
    let (width, height) = reference.dimensions();
    let around = |at: u32, size: u32| at.saturating_sub(1)..=(at + 1).min(size - 1);
    let off = picture
        .enumerate_pixels()
        .filter(|(x, y, pixel)| {
            !around(*y, height).any(|y| {
                around(*x, width).any(|x| {
                    let reference = reference.get_pixel(x, y);
                    (0..4).all(|i| reference[i].abs_diff(pixel[i]) <= 5)
                })
            })
        })
        .count();
    off as f64 / f64::from(width * height)
}

/// FLIP and the share of the pixels that are far off.
fn apart(scene: BuiltIn, name: &str, picture: &image::RgbaImage) -> (f32, f64) {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden"))
        .join(format!("{}-{name}.png", scene.name()));
    let reference = image::open(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        .to_rgba8();
    (
        flip_mean(&reference, &as_rounded(&reference, picture)),
        far_off(&reference, picture),
    )
}

/// Whether nobody sees a difference.
fn is_alike((flip, off): (f32, f64)) -> bool {
    flip <= 0.005 && off <= 0.001
}

fn preset(name: &str) -> ComicStyle {
    presets::preset(name).expect("listed").expect("readable")
}

fn check(scene: BuiltIn) {
    let mut studio = Studio::new(scene, UVec2::new(320, 180), Msaa::Off);
    for name in golden_presets(scene) {
        let picture = studio.shoot(Some(&preset(name)));
        let (flip, off) = apart(scene, name, &picture);
        assert!(
            is_alike((flip, off)),
            "{}, {name}: FLIP {flip:.4}, {:.2} % of the pixels far off",
            scene.name(),
            100.0 * off
        );
    }
    // The comparison can fail: no style is none of the presets.
    let original = studio.shoot(None);
    for name in golden_presets(scene) {
        assert!(
            !is_alike(apart(scene, name, &original)),
            "the measure sees no {name}"
        );
    }
}

#[test]
fn small_changes_are_seen() {
    let mut studio = Studio::new(BuiltIn::Teapot, UVec2::new(320, 180), Msaa::Off);
    let name = "ligne-claire";
    let style = preset(name);
    let contours = style.contours.expect("it has contours");
    for changed in [
        Contours {
            width: contours.width + 0.5,
            ..contours
        },
        Contours {
            opacity: 0.9,
            ..contours
        },
    ] {
        let picture = studio.shoot(Some(&ComicStyle {
            contours: Some(changed),
            ..style.clone()
        }));
        let (flip, off) = apart(BuiltIn::Teapot, name, &picture);
        assert!(
            flip > 0.005 && off > 0.001,
            "FLIP {flip}, {off} far off: {changed:?}"
        );
    }
}

#[test]
fn mountains_look_as_they_did() {
    check(BuiltIn::Mountains);
}

#[test]
fn the_teapot_looks_as_it_did() {
    check(BuiltIn::Teapot);
}

#[test]
fn the_village_looks_as_it_did() {
    check(BuiltIn::Village);
}

#[test]
fn the_theatre_looks_as_it_did() {
    check(BuiltIn::Theatre);
}
