//! Pictures with OpenGL, beside those with Vulkan, and within the limits of WebGL 2.
//!
//! Each test runs in a process of its own, since materials know one adapter in a process.

use std::process::Command;

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    light::cluster::GlobalClusterSettings,
    math::UVec2,
    prelude::*,
    render::view::Msaa,
};
use bevy_comics::{ComicStyle, ComicsDiagnostics, ComicsStage, LeftOut, StageOutcome, presets};
use bevy_comics_testkit::{
    headless::{HeadlessOptions, adapter_of},
    scenes::BuiltIn,
    studio::{Studio, golden_styles},
};
use image::RgbaImage;

use crate::{
    pairwise::{checks::assert_drawn, compare::changed, effects::GROUPS},
    small::{self, Small},
};

/// Set in the process of a test.
const ALONE: &str = "OPEN_GL_ALONE";

/// The APIs that are compared.
const APIS: [wgpu::Backends; 2] = [wgpu::Backends::VULKAN, wgpu::Backends::GL];

/// Runs a test of this file in a process of its own.
fn alone(name: &str, test: fn()) {
    if cfg!(not(target_os = "linux")) {
        // OpenGL without a window needs EGL.
        return;
    }
    if std::env::var_os(ALONE).is_some() {
        adapter_of(wgpu::Backends::GL)
            .expect("OpenGL; on Debian: apt-get install libegl1 libgl1-mesa-dri");
        return test();
    }
    let output = Command::new(std::env::current_exe().expect("the test"))
        .args(["--exact", "--nocapture", &format!("open_gl::{name}")])
        .env(ALONE, "yes")
        .output()
        .expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}\n{errors}");
    assert!(text.contains("1 passed"), "no test has run: {text}");
}

/// The fraction of pixels that differ by more than two codes.
fn apart(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let far = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 2)
    };
    let off = a.pixels().zip(b.pixels()).filter(far).count();
    off as f64 / f64::from(a.width() * a.height())
}

/// Draws a scene with both APIs. `most`: the fraction of pixels that may be apart.
fn check(scene: BuiltIn, styles: &[(&str, ComicStyle)], most: f64) {
    let mut studios = APIS.map(|backends| {
        let options = HeadlessOptions {
            size: UVec2::new(160, 90),
            backends,
            ..default()
        };
        Studio::with_options(scene, options, Msaa::Off)
    });
    let original = studios.each_mut().map(|studio| studio.shoot(None));
    let off = apart(&original[0], &original[1]);
    assert!(off <= 0.001, "{scene:?}, the engine's picture: {off}");
    for (name, style) in styles {
        let [vulkan, gl] = studios.each_mut().map(|studio| studio.shoot(Some(style)));
        let off = apart(&vulkan, &gl);
        assert!(off <= most, "{scene:?}, {name}: {off}");
        // The comparison can fail.
        let styled = apart(&original[1], &gl);
        assert!(styled > 2.0 * most, "{name} changes {styled} only");
    }
}

fn looks() -> [(&'static str, ComicStyle); 4] {
    [
        presets::CRIMSON_DUSK,
        presets::MANGA_PAGE,
        presets::LIGNE_CLAIRE,
        presets::WOODCUT,
    ]
    .map(|preset| (preset.name(), preset.style()))
}

#[test]
fn golden_pictures_of_the_teapot_are_those_with_vulkan() {
    alone(
        "golden_pictures_of_the_teapot_are_those_with_vulkan",
        || {
            let styles = golden_styles(BuiltIn::Teapot);
            check(BuiltIn::Teapot, &styles, 0.0005);
        },
    );
}

/// wgpu cannot read multisampled textures with OpenGL: what needs depth is left out, whether this crate or
/// the game asked for the prepass.
#[test]
fn multisampled_views_are_drawn_without_depth() {
    alone("multisampled_views_are_drawn_without_depth", || {
        for by_game in [false, true] {
            let mut app = small(wgpu::Backends::GL, None, Msaa::Sample4);
            if by_game {
                app.insert((DepthPrepass, NormalPrepass));
            }
            let plain = app.settle().picture();
            for (name, style) in GROUPS {
                app.style(&style());
                app.settle();
                assert_eq!(app.errors(), 0, "{name}");
                assert!(!app.ran(ComicsStage::DepthRange), "{name}");
                assert!(!app.ran(ComicsStage::FindLines), "{name}");
            }
            app.style(&presets::POP_POSTER.style());
            let styled = changed(&plain, &app.settle().picture());
            assert!(styled > 0.1, "{styled}");
        }
    });
}

/// OpenGL stores depth as 0.5 (2 z - 1) + 0.5, in steps of 6e-8, which are half a per cent of the distance
/// of the mountains: lines and borders of dots at their limit are others.
#[test]
fn far_scenes_are_nearly_those_with_vulkan() {
    alone("far_scenes_are_nearly_those_with_vulkan", || {
        for scene in [BuiltIn::Mountains, BuiltIn::Village] {
            check(scene, &looks(), 0.05);
        }
    });
}

fn small(backends: wgpu::Backends, limits: Option<wgpu::Limits>, msaa: Msaa) -> Small {
    let options = HeadlessOptions {
        backends,
        limits,
        ..small::options(small::size())
    };
    Small::with(options, msaa)
}

#[test]
fn every_effect_is_drawn_as_with_vulkan() {
    alone("every_effect_is_drawn_as_with_vulkan", || {
        let mut apps = APIS.map(|api| small(api, None, Msaa::Off));
        let plain = apps.each_mut().map(|app| app.settle().picture());
        let off = changed(&plain[0], &plain[1]);
        assert!(off <= 0.002, "the engine's picture: {off}");
        for (name, style) in GROUPS {
            let [vulkan, gl] = apps.each_mut().map(|app| {
                let style = style();
                app.style(&style);
                let picture = app.settle().picture();
                assert_drawn(app, &style, name);
                picture
            });
            assert!(changed(&plain[1], &gl) > 0.02, "{name} is not drawn");
            let off = apart(&vulkan, &gl);
            assert!(off <= 0.02, "{name}: {off}");
        }
        assert!(apps.iter().all(|app| app.errors() == 0));
    });
}

/// Limits of WebGL 2: no compute shaders, no storage. Larger pictures, and more colours at once, than it
/// promises.
#[test]
fn every_effect_is_drawn_within_the_limits_of_webgl2() {
    alone("every_effect_is_drawn_within_the_limits_of_webgl2", || {
        for api in APIS {
            let limits = wgpu::Limits::downlevel_webgl2_defaults();
            let mut app = small(api, Some(limits), Msaa::Off);
            // The engine looks at the adapter, not at its limits.
            app.world()
                .resource_mut::<GlobalClusterSettings>()
                .gpu_clustering = None;
            let plain = app.settle().picture();
            assert_eq!(app.errors(), 0, "{api:?}: of the engine");
            for (name, style) in GROUPS {
                let style = style();
                app.style(&style);
                let picture = app.settle().picture();
                assert_drawn(&app, &style, name);
                assert_eq!(app.errors(), 0, "{api:?}: {name}");
                let styled = changed(&plain, &picture);
                assert!(styled > 0.02, "{api:?}: {name} changes {styled}");
            }
            let world = app.headless.app.world();
            let diagnostics = world.resource::<ComicsDiagnostics>();
            let stages = &diagnostics.cameras[&app.camera];
            for (stage, outcome) in [
                (ComicsStage::DepthRange, StageOutcome::RanAs("PingPong")),
                (
                    ComicsStage::RangeSmoothing,
                    StageOutcome::LeftOut(LeftOut::NoComputeShaders),
                ),
                (
                    ComicsStage::ObjectIds,
                    StageOutcome::LeftOut(LeftOut::NoStorageBuffers),
                ),
            ] {
                assert_eq!(stages.outcome(stage), Some(outcome), "{api:?}");
            }
        }
    });
}
