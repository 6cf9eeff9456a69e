//! Pictures with OpenGL, beside those with Vulkan, and within the limits of WebGL 2. Elsewhere,
//! OpenGL without a window is not to be had.
#![cfg(target_os = "linux")]

use bevy::light::cluster::GlobalClusterSettings;
use bevy_comics_testkit::studio::golden_styles;
use image::RgbaImage;

use crate::{
    pairwise::{
        checks::assert_drawn,
        compare::changed,
        effects::{GROUPS, Group, LINES},
    },
    prelude::*,
    toon,
};

/// The APIs that are compared.
const APIS: [wgpu::Backends; 2] = [wgpu::Backends::VULKAN, wgpu::Backends::GL];

/// The fraction of pixels that differ by more than two codes.
fn apart(a: &RgbaImage, b: &RgbaImage) -> f64 {
    crate::small::changed(a, b, 2)
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

#[ignore = "long: every preset, twice; quick test open_gl::lines_are_drawn_as_with_vulkan"]
#[test]
fn every_preset_is_drawn_as_with_vulkan() {
    let presets = presets::ALL.iter();
    let presets = presets.map(|preset| (preset.name(), preset.style()));
    let styles: Vec<_> = presets.chain(golden_styles(BuiltIn::Teapot)).collect();
    check(BuiltIn::Teapot, &styles, 0.0005);
}

/// OpenGL stores depth as 0.5 (2 z - 1) + 0.5, in steps of 6e-8, which are half a per cent of the
/// distance of the mountains: lines and borders of dots at their limit are others.
#[ignore = "long: four looks in two large scenes, twice"]
#[test]
fn far_scenes_are_nearly_those_with_vulkan() {
    let looks = [
        presets::CRIMSON_DUSK,
        presets::MANGA_PAGE,
        presets::LIGNE_CLAIRE,
        presets::WOODCUT,
    ]
    .map(|preset| (preset.name(), preset.style()));
    for scene in [BuiltIn::Mountains, BuiltIn::Village] {
        check(scene, &looks, 0.05);
    }
}

fn small(backends: wgpu::Backends, limits: Option<wgpu::Limits>, msaa: Msaa) -> Small {
    let options = HeadlessOptions {
        backends,
        limits,
        ..options(size())
    };
    Small::alone(options, msaa)
}

/// An app that draws with Vulkan: one of the pool, unless `WGPU_BACKEND` names OpenGL.
fn with_vulkan() -> Small {
    let usual = options(size());
    if usual.backends.contains(wgpu::Backends::GL) {
        return small(wgpu::Backends::VULKAN, None, Msaa::Off);
    }
    Small::with(usual, Msaa::Off)
}

/// Empties the scene. The material of a ball is made later.
fn without_objects(mut app: Small) -> Small {
    app.clear();
    app.insert(DepthPrepass).headless.step(1);
    app
}

/// The rim of a ball has the same width everywhere where the adapter loads depth. With OpenGL it is
/// where the ball turns away, since a pipeline of a material that loads depth is not valid.
fn draw_ball(mut app: Small) -> RgbaImage {
    let rim = Rim {
        width: RimWidth::Pixels(5.0),
        lit_side: 0.0,
        ..default()
    };
    let light = ToonLight {
        rim: Some(rim),
        ..default()
    };
    let material = toon::material(&mut app, light);
    let at = Transform::from_xyz(0.4, 1.0, 2.5);
    app.put_shared(Sphere::new(0.8), material, at);
    app.settle().picture()
}

fn assert_own_rims(vulkan: &RgbaImage, gl: &RgbaImage) {
    let rims = apart(vulkan, gl);
    assert!(rims > 0.01, "the rims are the same: {rims}");
}

#[test]
fn two_apps_in_one_process_draw_their_own_rims() {
    let vulkan = without_objects(with_vulkan());
    let mut gl = without_objects(small(wgpu::Backends::GL, None, Msaa::Off));
    let empty = gl.headless.picture();
    let (vulkan, gl) = (draw_ball(vulkan), draw_ball(gl));
    assert!(changed(&empty, &gl) > 0.05, "OpenGL draws no ball");
    assert_own_rims(&vulkan, &gl);
}

#[ignore = "long: five apps; quick test open_gl::two_apps_in_one_process_draw_their_own_rims"]
#[test]
fn two_apps_in_one_process_draw_what_each_draws_alone() {
    let [vulkan, gl] = APIS;
    let start = |api| without_objects(small(api, None, Msaa::Off));
    let alone = APIS.map(|api| draw_ball(start(api)));
    assert_own_rims(&alone[0], &alone[1]);
    // Each makes the pipeline of its material when one with the other API has started after it.
    let (first, second) = (start(vulkan), start(gl));
    assert!(draw_ball(first) == alone[0], "Vulkan, before OpenGL");
    let third = start(vulkan);
    assert!(draw_ball(second) == alone[1], "OpenGL, before Vulkan");
    assert!(draw_ball(third) == alone[0], "Vulkan, after OpenGL");
}

/// wgpu cannot read multisampled textures with OpenGL: what needs depth is left out, whether this
/// crate or the game asked for the prepass.
#[test]
fn multisampled_views_are_drawn_without_depth() {
    // The prepasses of the game concern what reads depth.
    let reads_depth = |name: &str| matches!(name, LINES | "all");
    check_multisampled(|by_game, name| !by_game || reads_depth(name));
}

#[ignore = "long: every effect, with the prepasses of the game as well"]
#[test]
fn multisampled_views_of_a_game_with_prepasses_are_drawn_without_depth() {
    check_multisampled(|by_game, _| by_game);
}

fn check_multisampled(is_tried: impl Fn(bool, &str) -> bool) {
    let mut app = small(wgpu::Backends::GL, None, Msaa::Sample4);
    for by_game in [false, true] {
        if by_game {
            app.restart(Msaa::Sample4);
            app.insert((DepthPrepass, NormalPrepass));
        }
        let plain = app.settle().picture();
        let tried = GROUPS
            .into_iter()
            .filter(|(name, _)| is_tried(by_game, name));
        for (name, style) in tried {
            app.style(&style()).settle();
            assert!(!app.ran(ComicsStage::DepthRange), "{name}");
            assert!(!app.ran(ComicsStage::FindLines), "{name}");
        }
        let styled = changed(&plain, &app.shot(&presets::POP_POSTER.style()));
        assert!(styled > 0.1, "{styled}");
    }
}

fn check_groups(groups: impl Iterator<Item = Group>) {
    let mut apps = [with_vulkan(), small(wgpu::Backends::GL, None, Msaa::Off)];
    let plain = apps.each_mut().map(|app| app.settle().picture());
    let off = changed(&plain[0], &plain[1]);
    assert!(off <= 0.002, "the engine's picture: {off}");
    for (name, style) in groups {
        let [vulkan, gl] = apps.each_mut().map(|app| {
            let style = style();
            let picture = app.shot(&style);
            assert_drawn(app, &style, name);
            picture
        });
        assert!(changed(&plain[1], &gl) > 0.02, "{name} is not drawn");
        let off = apart(&vulkan, &gl);
        assert!(off <= 0.02, "{name}: {off}");
    }
}

#[test]
fn lines_are_drawn_as_with_vulkan() {
    check_groups(GROUPS.into_iter().filter(|(name, _)| *name == LINES));
}

#[ignore = "long: every effect, twice"]
#[test]
fn every_effect_is_drawn_as_with_vulkan() {
    check_groups(GROUPS.into_iter());
}

/// Set in the process of a test that has one of its own.
const ALONE: &str = "WEBGL2_ALONE";

/// Runs a test of this file in a process of its own, in which no device has storage buffers. The
/// engine looks at one device in a process (`bevy_render::storage_buffers_are_unsupported`, Bevy
/// 0.19.1), so that apps with and without them cannot be in the same one.
fn alone(name: &str, api: wgpu::Backends) {
    if std::env::var_os(ALONE).is_some() {
        return check_webgl2(api);
    }
    let output = Command::new(std::env::current_exe().expect("the test"))
        .args(["--exact", "--nocapture", "--include-ignored"])
        .arg(format!("open_gl::{name}"))
        .env(ALONE, "yes")
        .output()
        .expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}\n{errors}");
    assert!(text.contains("1 passed"), "no test has run: {text}");
}

/// Limits of WebGL 2: no compute shaders, no storage. Larger pictures, and more colors at once,
/// than it promises.
fn check_webgl2(api: wgpu::Backends) {
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let mut app = small(api, Some(limits), Msaa::Off);
    // The engine looks at the adapter, not at its limits.
    app.world()
        .resource_mut::<GlobalClusterSettings>()
        .gpu_clustering = None;
    let plain = app.settle().picture();
    for (name, style) in GROUPS {
        let style = style();
        let picture = app.shot(&style);
        assert_drawn(&app, &style, name);
        let styled = changed(&plain, &picture);
        assert!(styled > 0.02, "{api:?}: {name} changes {styled}");
    }
    let world = app.headless.app.world();
    let diagnostics = world.resource::<ComicsDiagnostics>();
    let stages = &diagnostics.cameras[&app.camera];
    let skipped = StageOutcome::Skipped;
    for (stage, outcome) in [
        (ComicsStage::DepthRange, StageOutcome::RanWith("PingPong")),
        (
            ComicsStage::RangeSmoothing,
            skipped(SkipReason::NoComputeShaders),
        ),
        (
            ComicsStage::ObjectIds,
            skipped(SkipReason::NoStorageBuffers),
        ),
    ] {
        assert_eq!(stages.outcome(stage), Some(outcome), "{api:?}");
    }
}

#[test]
fn every_effect_is_drawn_within_the_limits_of_webgl2() {
    let name = "every_effect_is_drawn_within_the_limits_of_webgl2";
    alone(name, wgpu::Backends::GL);
}

#[ignore = "long: quick test open_gl::every_effect_is_drawn_within_the_limits_of_webgl2"]
#[test]
fn every_effect_is_drawn_with_vulkan_within_the_limits_of_webgl2() {
    let name = "every_effect_is_drawn_with_vulkan_within_the_limits_of_webgl2";
    alone(name, wgpu::Backends::VULKAN);
}
