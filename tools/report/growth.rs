//! How the cost grows with pixels, vertices and cameras.

use bevy::{core_pipeline::tonemapping::Tonemapping, prelude::*};

use bevy_comics::{Colorization, ComicStyle, DepthMap};
use bevy_comics_testkit::{headless::new_target, scenes::BuiltIn, work::default_comic};

use crate::{
    Run,
    costs::GROWING,
    ladder::ball,
    rig::{self, Rig},
};

pub fn measure(run: &Run) -> Result<(), String> {
    // Large pictures take long, and their times vary little.
    let few = run.with_rounds(run.rounds.min(3));
    let comic = rig::styles([(GROWING, default_comic())]);
    // The same with a pass fewer, and a style of one pass.
    let fewer = [
        (
            "default comic; range of every frame",
            ComicStyle {
                depth_map: Some(DepthMap {
                    smoothing: None,
                    ..default()
                }),
                ..default_comic()
            },
        ),
        (
            "one tint (sepia)",
            ComicStyle::new().with(Colorization::SEPIA),
        ),
    ];
    let by_pixels = [comic.clone(), rig::styles(fewer)].concat();
    let mut times = rig::times();
    let sizes = [
        (256, 256),
        (512, 512),
        (1024, 1024),
        (1920, 1080),
        (2048, 2048),
        (3840, 2160),
    ];
    let sizes = run.pick(vec![(96, 96), (192, 192)], sizes.to_vec());
    for (width, height) in sizes {
        let mut rig = Rig::new(Some(BuiltIn::Teapot), UVec2::new(width, height));
        rig.unlight();
        let what = format!("{width}x{height}");
        let run = if width * height > 3_000_000 {
            &few
        } else {
            run
        };
        let styles = run.some(1, by_pixels.iter().cloned());
        rig::record(run, &mut times, "pixels", &what, &mut rig, &styles);
    }
    let counts = run.some(2, [1_000, 10_000, 100_000, 1_000_000, 4_000_000]);
    let side = run.size([128; 2], [512; 2]);
    for vertices in counts {
        let mut rig = Rig::new(None, side);
        ball(&mut rig, vertices);
        rig.headless.step(2);
        let what = vertices.to_string();
        let run = if vertices > 500_000 { &few } else { run };
        rig::record(run, &mut times, "vertices", &what, &mut rig, &comic);
    }
    for cameras in run.some(2, 1..=4u32) {
        let mut rig = Rig::new(Some(BuiltIn::Teapot), UVec2::splat(256));
        for _ in 1..cameras {
            let world = rig.headless.app.world_mut();
            let target = new_target(
                world,
                UVec2::splat(256),
                wgpu::TextureFormat::Rgba8UnormSrgb,
            );
            let vantage = rig.vantage.clone().expect("a built-in scene");
            let camera = world
                .spawn((
                    vantage.camera(),
                    bevy::camera::RenderTarget::from(target),
                    Msaa::Off,
                ))
                .insert(Tonemapping::None)
                .id();
            rig.others.push(camera);
        }
        let what = cameras.to_string();
        rig::record(run, &mut times, "cameras", &what, &mut rig, &comic);
    }
    run.save("growth_times", &times)
}
