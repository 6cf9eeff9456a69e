//! Cameras: multisampling, formats, sizes, several on one target, other passes.

use bevy::{
    anti_alias::contrast_adaptive_sharpening::ContrastAdaptiveSharpening,
    core_pipeline::Core3d,
    pbr::DefaultOpaqueRendererMethod,
    post_process::{bloom::Bloom, dof::DepthOfField},
};

use super::*;

#[test]
fn a_multisampled_camera_is_styled() {
    let mut small = styled(Msaa::Sample4);
    assert!(small.ran(ComicsStage::Stylize) && small.ran(ComicsStage::DepthRange));
    let with = small.picture();
    assert!(changed(&with, &small.shot(&ComicStyle::default()), 1) > 0.3);
}

#[test]
fn hdr_can_be_toggled_and_a_target_may_store_linear_color() {
    let mut small = styled(Msaa::Off);
    let ldr = small.picture();
    small.insert(Hdr).settle();
    // Without tonemapping the two cameras show the same colors.
    assert!(changed(&ldr, &small.picture(), 1) < 0.01);
    let camera = small.camera;
    small.world().entity_mut(camera).remove::<Hdr>();
    assert_eq!(ldr, small.settle().picture());

    let linear_target = HeadlessOptions {
        format: TextureFormat::Rgba8Unorm,
        ..options(size())
    };
    let mut small = Small::with(linear_target, Msaa::Off);
    small.style(&full_style()).settle();
    assert!(small.ran(ComicsStage::Stylize));
}

#[test]
fn each_camera_on_a_shared_target_has_its_own_range() {
    let mut small = Small::new(UVec2::new(120, 48), Msaa::Off);
    for msaa in [Msaa::Off, Msaa::Sample4] {
        small.restart(msaa);
        two_cameras_on_one_target(&mut small, msaa);
    }
}

fn two_cameras_on_one_target(small: &mut Small, msaa: Msaa) {
    let half = |x: u32, order: isize| Camera {
        order,
        viewport: Some(Viewport {
            physical_position: UVec2::new(x, 0),
            physical_size: UVec2::new(60, 48),
            ..default()
        }),
        ..default()
    };
    let from = |at| Transform::from_translation(at).looking_at(Vec3::ZERO, Vec3::Y);
    let near = from(Vec3::new(1.5, 2.4, 6.0));
    let lines = (Contours::default(), VisibleDepthRange::default());
    small.insert((half(0, 0), near, lines, Colorization::default()));
    let target = small.headless.render_target();
    let lines = (Contours::default(), VisibleDepthRange::default());
    let second = (camera(target, msaa), lines, Desaturation::default());
    let far = from(Vec3::new(15.0, 24.0, 60.0));
    let second = small.world().spawn(second).insert((half(60, 1), far)).id();
    small.settle();
    let world = small.headless.app.world();
    let [first, other] = [small.camera, second].map(|camera| {
        let range = world.get::<VisibleDepthRange>(camera);
        range.and_then(|r| r.distances()).expect("a range")
    });
    assert!(first.1 < other.0, "{first:?} and {other:?}");
    let diagnostics = world.resource::<ComicsDiagnostics>();
    assert!(diagnostics.ran(small.camera, ComicsStage::of::<Contours>()));
    assert!(diagnostics.ran(second, ComicsStage::of::<Desaturation>()));
    assert!(!diagnostics.ran(small.camera, ComicsStage::of::<Desaturation>()));
    // The first camera draws its half as it does alone.
    let both = small.picture();
    small.world().despawn(second);
    let alone = small.settle().picture();
    for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| *x < 60) {
        assert_eq!(pixel, alone.get_pixel(x, y), "{msaa:?}: ({x}, {y})");
    }
}

#[test]
fn a_target_may_have_another_size_in_every_frame() {
    let mut small = styled(Msaa::Off);
    small.insert((ToneBands::default(), Outlines::default()));
    let sizes = [
        [1, 1],
        [2, 1],
        [3, 7],
        [1, 4096],
        [4096, 1],
        [97, 31],
        [33, 64],
        [96, 64],
    ];
    for size in sizes.map(UVec2::from) {
        let target = new_target(small.world(), size, TextureFormat::Rgba8UnormSrgb);
        small.insert(RenderTarget::Image(target.clone().into()));
        small.headless.step(4);
        for stage in [ComicsStage::Stylize, ComicsStage::DepthRange] {
            assert!(small.ran(stage), "{size}");
        }
        assert_eq!(
            small.headless.picture_of(&target).dimensions(),
            (size.x, size.y)
        );
    }
}

#[test]
fn an_empty_viewport_adds_no_render_error() {
    let run = |style: bool| {
        let mut small = Small::alone(options(size()), Msaa::Off);
        small.count_errors();
        // The engine's own errors would be counted: one for every frame, and a new app draws some
        // twice.
        cluster_on_cpu(&mut small);
        if style {
            small.style(&full_style());
        }
        small.insert(Camera {
            viewport: Some(Viewport {
                physical_size: UVec2::ZERO,
                ..default()
            }),
            ..default()
        });
        small.headless.step(6);
        small.errors()
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn a_deferred_camera_looks_like_a_forward_one() {
    let forward = styled(Msaa::Off).picture();
    let mut small = Small::new(size(), Msaa::Off);
    small
        .world()
        .insert_resource(DefaultOpaqueRendererMethod::deferred());
    small.insert((DeferredPrepass, DepthPrepass));
    small.style(&full_style()).settle();
    assert!(small.ran(ComicsStage::Stylize));
    assert!(
        changed(&forward, &small.picture(), 1) < 0.05,
        "deferred looks different"
    );
}

/// Checks these numbers of samples, with and without HDR.
fn check_post_processes(cases: &[(Msaa, bool)]) {
    let mut small = Small::new(size(), Msaa::Off);
    for (msaa, hdr) in cases.iter().copied() {
        small.restart(msaa);
        small.style(&full_style());
        if hdr {
            small.insert((Hdr, Bloom::NATURAL));
        }
        small.insert(Tonemapping::TonyMcMapface);
        let plain = small.settle().picture();
        small.insert(Fxaa::default()).settle();
        let fxaa = small.picture();
        assert!(changed(&plain, &fxaa, 1) < 0.5, "FXAA lost the picture");
        small.camera_mut().remove::<Fxaa>();
        let sharpening = ContrastAdaptiveSharpening {
            enabled: true,
            ..default()
        };
        small.insert((Smaa::default(), sharpening));
        if hdr && msaa == Msaa::Off {
            small.insert(DepthOfField::default());
        }
        small.settle();
        assert!(small.ran(ComicsStage::Stylize), "{msaa:?}, hdr {hdr}");
        assert_ne!(
            small.picture().get_pixel(1, 1).0,
            [0, 0, 0, 0],
            "the picture was lost"
        );
    }
}

#[test]
fn styles_work_beside_the_engines_post_processes() {
    check_post_processes(&[(Msaa::Off, true)]);
}

#[test]
fn multisampled_styles_work_beside_the_engines_post_processes() {
    check_post_processes(&[(Msaa::Sample4, false)]);
}

/// No ambiguity of the schedule names a system of this crate.
#[test]
fn no_pass_of_this_crate_has_an_ambiguous_order() {
    let small = styled(Msaa::Off);
    let schedules = small.render_world().resource::<Schedules>();
    let schedule = schedules.get(Core3d).expect("the engine's schedule");
    let systems = schedule.systems().expect("it has run");
    let names: HashMap<_, _> = systems
        .map(|(key, system)| (key, system.name().to_string()))
        .collect();
    let is_ours = |id| names[id].contains("bevy_comics");
    assert!(names.keys().any(is_ours), "{names:#?}");
    for (a, b, _) in schedule.graph().conflicting_systems().iter() {
        assert!(!is_ours(a) && !is_ours(b), "{} and {}", names[a], names[b]);
    }
}

#[test]
fn cameras_that_cannot_be_styled_are_left_alone() {
    let mut small = Small::new(size(), Msaa::Off);
    let target: RenderTarget = small.headless.render_target();
    let order = |order, clear_color| Camera {
        order,
        clear_color,
        ..default()
    };
    let flat = (Camera2d, target, order(3, ClearColorConfig::None));
    let nowhere = RenderTarget::None {
        size: UVec2::new(32, 32),
    };
    let blind = order(4, ClearColorConfig::Default);
    let blind = (Camera3d::default(), nowhere, blind);
    let world = small.world();
    let flat = world.spawn((flat, Contours::default())).id();
    let blind = world.spawn((blind, Contours::default())).id();
    small.settle();
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    for (name, camera) in [("flat", flat), ("blind", blind)] {
        assert!(!diagnostics.ran(camera, ComicsStage::Stylize), "{name}");
    }
}
