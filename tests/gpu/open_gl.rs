//! The golden scenes under OpenGL, beside Vulkan.

use bevy::{math::UVec2, prelude::default, render::view::Msaa};
use bevy_comics_testkit::{
    headless::HeadlessOptions,
    scenes::BuiltIn,
    studio::{Studio, golden_styles},
};

const SIZE: UVec2 = UVec2::new(160, 90);

fn studio(scene: BuiltIn, backends: wgpu::Backends, msaa: Msaa) -> Studio {
    let options = HeadlessOptions {
        size: SIZE,
        backends,
        log: std::env::var_os("GL_LOG").is_some(),
        ..default()
    };
    Studio::with_options(scene, options, msaa)
}

/// The fraction of pixels that differ by more than two codes.
fn apart(a: &image::RgbaImage, b: &image::RgbaImage) -> f64 {
    let far = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
    };
    let off = a.pixels().zip(b.pixels()).filter(far).count();
    off as f64 / f64::from(a.width() * a.height())
}

fn check(scene: BuiltIn, msaa: Msaa) {
    let [mut vulkan, mut gl] = [wgpu::Backends::VULKAN, wgpu::Backends::GL]
        .map(|backends| studio(scene, backends, msaa));
    let styles = golden_styles(scene);
    let all = std::iter::once(("original", None)).chain(styles.iter().map(|(n, s)| (*n, Some(s))));
    for (name, style) in all {
        let pictures = [&mut vulkan, &mut gl].map(|studio| studio.shoot(style));
        let off = apart(&pictures[0], &pictures[1]);
        println!("{} {name} {off:.5}", scene.name());
        if off > 0.0 {
            for (picture, api) in pictures.iter().zip(["vulkan", "gl"]) {
                let file = format!("/tmp/gl/{}-{name}-{api}.png", scene.name());
                picture.save(file).expect("saved");
            }
        }
    }
}

#[test]
fn try_teapot() {
    check(BuiltIn::Teapot, Msaa::Off);
}

#[test]
fn try_all() {
    for scene in BuiltIn::ALL {
        check(scene, Msaa::Off);
    }
}

#[test]
fn try_multisampled() {
    for scene in BuiltIn::ALL {
        check(scene, Msaa::Sample4);
    }
}

#[test]
fn try_webgl2() {
    for backends in [wgpu::Backends::VULKAN, wgpu::Backends::GL] {
        let options = HeadlessOptions {
            size: SIZE,
            backends,
            log: std::env::var_os("GL_LOG").is_some(),
            limits: Some(wgpu::Limits::downlevel_webgl2_defaults()),
            ..default()
        };
        let mut studio = Studio::with_options(BuiltIn::Teapot, options, Msaa::Off);
        studio
            .shoot(None)
            .save(format!("/tmp/gl/webgl2-{backends:?}.png").replace(['(', ')', ' '], ""))
            .expect("saved");
    }
}
