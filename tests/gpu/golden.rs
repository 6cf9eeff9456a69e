//! Reference pictures of every preset, on the scenes it is for, 320x180. To make them
//! anew: `cargo run --example pictures -- golden`, then look at them.

use std::path::PathBuf;

use bevy::{math::UVec2, render::view::Msaa};
use bevy_comics::presets;
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

fn far_off(reference: &image::RgbaImage, picture: &image::RgbaImage) -> f64 {
    let off = reference
        .pixels()
        .zip(picture.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 5))
        .count();
    off as f64 / f64::from(reference.width() * reference.height())
}

fn check(scene: BuiltIn) {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden"));
    let mut studio = Studio::new(scene, UVec2::new(320, 180), Msaa::Off);
    let mut first: Option<(image::RgbaImage, image::RgbaImage)> = None;
    for name in golden_presets(scene) {
        let style = presets::preset(name).expect("listed").expect("readable");
        let picture = studio.shoot(Some(&style));
        let path = folder.join(format!("{}-{name}.png", scene.name()));
        let reference = image::open(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
            .to_rgba8();
        let (flip, off) = (
            flip_mean(&reference, &picture),
            far_off(&reference, &picture),
        );
        assert!(
            flip <= 0.01 && off <= 0.001,
            "{}: FLIP {flip:.4}, {:.2} % of the pixels far off",
            path.display(),
            100.0 * off
        );
        first.get_or_insert((reference, picture));
    }
    // The comparison can fail: another preset is not this one.
    let (reference, _) = first.expect("there are presets");
    let other = studio.shoot(None);
    assert!(
        flip_mean(&reference, &other) > 0.01,
        "the measure sees no difference"
    );
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
