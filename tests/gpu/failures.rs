//! How such plugins fail: every case that must hold from the first version, by
//! its number in the list.

use bevy::{
    anti_alias::{fxaa::Fxaa, smaa::Smaa},
    camera::{Hdr, RenderTarget, Viewport},
    core_pipeline::prepass::{DeferredPrepass, DepthPrepass},
    prelude::*,
    render::{RenderApp, render_resource::TextureFormat, view::Msaa},
};
use bevy_comics::{
    Colorization, ColorizationMode, ComicStyle, ComicsDiagnostics, ComicsPlugin, ComicsStage,
    ContourForm, Contours, DepthMap, DepthMapping, Desaturation, LeftOut, StageOutcome,
    VisibleDepthRange,
};

use crate::{
    common::headless::{HeadlessOptions, new_target},
    small::{Object, Small, camera, options, size},
};

fn full_style() -> ComicStyle {
    ComicStyle {
        desaturation: Some(Desaturation::default()),
        colorization: Some(Colorization::default()),
        contours: Some(Contours {
            threshold: 0.05,
            ..default()
        }),
        ..default()
    }
}

fn styled(msaa: Msaa) -> Small {
    let mut small = Small::new(size(), msaa);
    small.style(&full_style());
    small.settle();
    small
}

/// Share of pixels that differ by more than a code.
fn changed(a: &image::RgbaImage, b: &image::RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(p, q): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        p.0.iter().zip(q.0).any(|(a, b)| a.abs_diff(b) > 1)
    };
    a.pixels()
        .zip(b.pixels())
        .filter(|pair| differs(*pair))
        .count() as f64
        / f64::from(a.width() * a.height())
}

#[test]
fn failure_01_msaa_is_on() {
    let mut small = styled(Msaa::Sample4);
    assert!(small.ran(ComicsStage::Stylize) && small.ran(ComicsStage::DepthRange));
    let with = small.picture();
    small.style(&ComicStyle::default());
    small.settle();
    assert!(changed(&with, &small.picture()) > 0.3);
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_02_hdr_is_toggled_and_targets_differ() {
    let mut small = styled(Msaa::Off);
    let ldr = small.picture();
    small.insert(Hdr).settle();
    // Without tonemapping the two cameras show the same colours.
    assert!(changed(&ldr, &small.picture()) < 0.01);
    let camera = small.camera;
    small.world().entity_mut(camera).remove::<Hdr>();
    small.settle();
    assert_eq!(ldr, small.picture());
    assert_eq!(small.errors(), 0);

    let linear_target = HeadlessOptions {
        format: TextureFormat::Rgba8Unorm,
        ..options(size())
    };
    let mut small = Small::with(linear_target, Msaa::Off);
    small.style(&full_style());
    small.settle();
    assert!(small.ran(ComicsStage::Stylize));
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_04_cameras_on_one_target_have_ranges_of_their_own() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        two_cameras_on_one_target(msaa);
    }
}

fn two_cameras_on_one_target(msaa: Msaa) {
    let mut small = Small::new(UVec2::new(120, 48), msaa);
    let half = |x: u32, order: isize| Camera {
        order,
        viewport: Some(Viewport {
            physical_position: UVec2::new(x, 0),
            physical_size: UVec2::new(60, 48),
            ..default()
        }),
        ..default()
    };
    let near = Transform::from_xyz(1.5, 2.4, 6.0).looking_at(Vec3::ZERO, Vec3::Y);
    let far = Transform::from_xyz(15.0, 24.0, 60.0).looking_at(Vec3::ZERO, Vec3::Y);
    small.insert((
        half(0, 0),
        near,
        Contours::default(),
        VisibleDepthRange::default(),
    ));
    let target: RenderTarget = small.headless.render_target();
    let second = small
        .world()
        .spawn((
            camera(target, msaa),
            Contours::default(),
            Desaturation::default(),
            VisibleDepthRange::default(),
        ))
        .insert((half(60, 1), far))
        .id();
    small.settle();
    let first = small
        .range()
        .and_then(VisibleDepthRange::distances)
        .expect("a range");
    let world = small.headless.app.world();
    let second_range = world
        .get::<VisibleDepthRange>(second)
        .and_then(|r| r.distances())
        .expect("a range");
    assert!(first.1 < second_range.0, "{first:?} and {second_range:?}");
    let diagnostics = world.resource::<ComicsDiagnostics>();
    assert!(diagnostics.ran(small.camera, ComicsStage::Contours));
    assert!(diagnostics.ran(second, ComicsStage::Desaturation));
    assert!(!diagnostics.ran(small.camera, ComicsStage::Desaturation));
    assert_eq!(small.errors(), 0);
    // The first camera's half is what it is alone.
    let both = small.picture();
    small.world().despawn(second);
    small.settle();
    let alone = small.picture();
    for (x, y, pixel) in both.enumerate_pixels().filter(|(x, ..)| *x < 60) {
        assert_eq!(pixel, alone.get_pixel(x, y), "{msaa:?}: ({x}, {y})");
    }
}

/// 5 and 18: until the pipeline is there the picture passes through unchanged.
#[test]
fn failure_05_18_a_picture_is_never_lost_while_a_pipeline_is_missing() {
    let mut small = Small::new(size(), Msaa::Off);
    small.settle();
    let original = small.picture();
    small.style(&full_style());
    for _ in 0..6 {
        small.headless.step(1);
        let picture = small.picture();
        let background = picture.get_pixel(1, 1).0;
        assert_ne!(background, [0, 0, 0, 0], "the picture was lost");
    }
    assert_ne!(small.picture(), original);

    // A broken shader: the picture passes through, and comes back when mended.
    let styled = small.picture();
    let (id, source) = shader(&mut small, "stylize.wgsl");
    replace(
        &mut small,
        id,
        "@fragment fn stylize() -> nonsense {".into(),
    );
    small.settle();
    assert_eq!(
        small.picture(),
        original,
        "a broken shader must pass the picture through"
    );
    let camera = small.camera;
    assert_eq!(
        outcome(&small, camera, ComicsStage::Stylize),
        Some(StageOutcome::LeftOut(LeftOut::PipelineNotReady))
    );
    replace(&mut small, id, source);
    small.settle();
    assert_eq!(small.picture(), styled);
}

fn shader(small: &mut Small, name: &str) -> (AssetId<Shader>, String) {
    let shaders = small.world().resource::<Assets<Shader>>();
    let (id, shader) = shaders
        .iter()
        .find(|(_, shader)| shader.path.ends_with(name) && shader.path.contains("bevy_comics"))
        .expect("the shader is an asset");
    let bevy::shader::Source::Wgsl(text) = &shader.source else {
        panic!("not WGSL")
    };
    (id, text.to_string())
}

fn replace(small: &mut Small, id: AssetId<Shader>, text: String) {
    let mut shaders = small.world().resource_mut::<Assets<Shader>>();
    let path = shaders.get(id).expect("there").path.clone();
    shaders
        .insert(id, Shader::from_wgsl(text, path))
        .expect("replaced");
}

fn outcome(small: &Small, camera: Entity, stage: ComicsStage) -> Option<StageOutcome> {
    small
        .headless
        .app
        .world()
        .resource::<ComicsDiagnostics>()
        .cameras
        .get(&camera)?
        .outcome(stage)
}

/// Takes the depth prepass away as soon as anyone asks for it.
fn forbid_prepass(mut commands: Commands, cameras: Query<Entity, With<DepthPrepass>>) {
    for camera in &cameras {
        commands.entity(camera).remove::<DepthPrepass>();
    }
}

#[test]
fn failure_06_without_a_prepass_the_colour_styles_remain() {
    let mut small = Small::new(size(), Msaa::Off);
    small.settle();
    let original = small.picture();
    small.headless.app.add_systems(Last, forbid_prepass);
    small
        .insert((Contours::default(), Desaturation::default()))
        .settle();
    assert_eq!(
        small.picture(),
        original,
        "nothing can be drawn without depth"
    );
    let camera = small.camera;
    let missing = Some(StageOutcome::LeftOut(LeftOut::NoDepthPrepass));
    assert_eq!(outcome(&small, camera, ComicsStage::Contours), missing);
    assert_eq!(outcome(&small, camera, ComicsStage::DepthRange), missing);
    small.insert(Colorization::SEPIA).settle();
    assert!(small.ran(ComicsStage::Colorization));
    assert_ne!(small.picture(), original);
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_08_absurd_settings_equal_their_sanitized_selves() {
    let wild = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        -1e30,
        1e30,
        -0.0,
        f32::MIN_POSITIVE,
    ];
    let mut small = Small::new(UVec2::new(48, 32), Msaa::Off);
    for (i, value) in wild.into_iter().enumerate() {
        let other = wild[(i + 3) % wild.len()];
        let style = ComicStyle {
            depth_map: Some(DepthMap {
                mapping: DepthMapping::Fixed {
                    near: value,
                    far: other,
                },
                sky_gap: other,
                floor: value,
                orthographic_floor: other,
                ..default()
            }),
            desaturation: Some(Desaturation {
                amount: value,
                exponent: other,
                ..default()
            }),
            colorization: Some(Colorization {
                mode: ColorizationMode::Linear,
                color: Color::srgb(value, other, 0.5),
                amount: other,
                ..default()
            }),
            black_flats: Some(bevy_comics::BlackFlats {
                slope: Some(value),
                value: Some(other),
                depth_weight: value,
                feather: other,
                color: Color::hsl(other, value, 0.2),
                opacity: value,
            }),
            contours: Some(Contours {
                threshold: value,
                width: other,
                softness: value,
                color: Color::srgb(other, value, value),
                opacity: other,
                fade: value,
                ..default()
            }),
            ..default()
        };
        small.style(&style);
        small.settle();
        let (_, output) = small.pass();
        assert!(
            output.pixels.iter().flatten().all(|c| c.is_finite()),
            "{value}, {other}"
        );
        let picture = small.picture();
        small.style(&style.sanitized());
        small.settle();
        assert_eq!(picture, small.picture(), "{value}, {other}");
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_09_wild_colours_stay_finite_and_where_they_are() {
    let mut small = Small::new(size(), Msaa::Off);
    small.insert(Hdr);
    small.style(&full_style());
    small.settle();
    let calm = small.pass().1;
    for (name, emissive) in [
        ("NaN", LinearRgba::rgb(f32::NAN, 0.5, 0.5)),
        ("infinity", LinearRgba::rgb(f32::INFINITY, 1.0, 0.0)),
        ("negative", LinearRgba::rgb(-4.0, 0.2, 0.1)),
        ("bright", LinearRgba::rgb(60_000.0, 900.0, 3.0)),
    ] {
        let material = {
            let world = small.world();
            let mut query =
                world.query_filtered::<&MeshMaterial3d<StandardMaterial>, With<Object>>();
            query.iter(world).next().expect("an object").0.clone()
        };
        {
            let mut assets = small.world().resource_mut::<Assets<StandardMaterial>>();
            let mut material = assets.get_mut(&material).expect("its material");
            material.base_color = Color::LinearRgba(emissive);
        }
        small.settle();
        let (input, output) = small.pass();
        assert!(
            output.pixels.iter().flatten().all(|c| c.is_finite()),
            "{name} reached the screen"
        );
        for ((read, wrote), was) in input.pixels.iter().zip(&output.pixels).zip(&calm.pixels) {
            // Pixels that do not show the object do not change.
            let ordinary = read.iter().all(|c| (0.0..=1.0).contains(c));
            if ordinary && !(name == "NaN" && read[0] == 0.0) {
                let moved = (0..3)
                    .map(|i| (wrote[i] - was[i]).abs())
                    .fold(0.0, f32::max);
                assert!(moved < 0.02, "{name} spread: {was:?} became {wrote:?}");
            }
        }
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_12_every_size_every_frame() {
    let mut small = styled(Msaa::Off);
    for size in [
        UVec2::new(1, 1),
        UVec2::new(2, 1),
        UVec2::new(3, 7),
        UVec2::new(1, 4096),
        UVec2::new(4096, 1),
        UVec2::new(97, 31),
        UVec2::new(33, 64),
        UVec2::new(96, 64),
    ] {
        let target = new_target(small.world(), size, TextureFormat::Rgba8UnormSrgb);
        small.insert(RenderTarget::Image(target.clone().into()));
        small.headless.step(4);
        assert!(small.ran(ComicsStage::Stylize), "{size}");
        assert_eq!(
            small.headless.picture_of(&target).dimensions(),
            (size.x, size.y)
        );
    }
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_13_a_zero_viewport_adds_no_error_of_ours() {
    let run = |style: bool| {
        let mut small = Small::new(size(), Msaa::Off);
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
fn failure_14_without_a_renderer_the_plugin_does_nothing() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, ComicsPlugin));
    let mut with_assets = App::new();
    with_assets.add_plugins((MinimalPlugins, AssetPlugin::default(), ComicsPlugin));
    with_assets.update();
    let camera = app
        .world_mut()
        .spawn((Contours::default(), Desaturation::default()))
        .id();
    for _ in 0..3 {
        app.update();
    }
    assert!(app.world().get::<Contours>(camera).is_some());
    assert!(
        app.world()
            .resource::<ComicsDiagnostics>()
            .cameras
            .is_empty()
    );
}

#[test]
fn failure_15_nothing_stale_runs() {
    let mut small = Small::new(size(), Msaa::Off);
    small.settle();
    let original = small.picture();
    small.style(&full_style());
    small.settle();
    assert_ne!(small.picture(), original);
    small.style(&ComicStyle::default());
    small.settle();
    assert_eq!(small.picture(), original, "a removed style leaves no trace");
    let camera = small.camera;
    assert!(
        small
            .headless
            .app
            .world()
            .get::<DepthPrepass>(camera)
            .is_none(),
        "our prepass stays"
    );
    assert!(
        !small
            .headless
            .app
            .world()
            .resource::<ComicsDiagnostics>()
            .cameras
            .contains_key(&camera)
    );

    small.style(&full_style());
    small.settle();
    let activate = |small: &mut Small, is_active| {
        small
            .world()
            .get_mut::<Camera>(camera)
            .expect("a camera")
            .is_active = is_active;
        small.settle();
    };
    activate(&mut small, false);
    assert!(
        !small
            .headless
            .app
            .world()
            .resource::<ComicsDiagnostics>()
            .cameras
            .contains_key(&camera)
    );
    activate(&mut small, true);
    let stages = small
        .headless
        .app
        .world()
        .resource::<ComicsDiagnostics>()
        .cameras
        .get(&camera)
        .cloned();
    assert!(small.ran(ComicsStage::Stylize), "{stages:?}");
    small.world().despawn(camera);
    small.headless.step(3);
    assert!(
        small
            .headless
            .app
            .world()
            .resource::<ComicsDiagnostics>()
            .cameras
            .is_empty()
    );
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_15_views_that_come_and_go_leave_no_buffers() {
    let mut small = styled(Msaa::Off);
    let buffers = |small: &Small| {
        let device = small
            .headless
            .app
            .sub_app(RenderApp)
            .world()
            .resource::<bevy::render::renderer::RenderDevice>()
            .clone();
        device
            .wgpu_device()
            .get_internal_counters()
            .hal
            .buffers
            .read()
    };
    small.headless.step(6);
    let before = buffers(&small);
    for _ in 0..6 {
        let target: RenderTarget = small.headless.render_target();
        let extra = small
            .world()
            .spawn((
                camera(target, Msaa::Off),
                Contours::default(),
                VisibleDepthRange::default(),
            ))
            .insert(Camera {
                order: 1,
                ..default()
            })
            .id();
        small.headless.step(3);
        small.world().despawn(extra);
        small.headless.step(3);
    }
    small.headless.step(6);
    assert!(
        buffers(&small) <= before + 8,
        "{before} buffers grew to {}",
        buffers(&small)
    );
}

#[test]
fn failure_20_deferred_rendering_is_styled() {
    let mut small = Small::new(size(), Msaa::Off);
    small.style(&full_style());
    small.settle();
    let forward = small.picture();
    let mut small = Small::new(size(), Msaa::Off);
    small
        .world()
        .insert_resource(bevy::pbr::DefaultOpaqueRendererMethod::deferred());
    small.insert((DeferredPrepass, DepthPrepass));
    small.style(&full_style());
    small.settle();
    assert!(small.ran(ComicsStage::Stylize));
    assert!(
        changed(&forward, &small.picture()) < 0.05,
        "deferred looks different"
    );
    assert_eq!(small.errors(), 0);
}

#[test]
fn failure_22_it_works_beside_every_post_process() {
    for msaa in [Msaa::Off, Msaa::Sample4] {
        for hdr in [false, true] {
            let mut small = Small::new(size(), msaa);
            small.style(&full_style());
            if hdr {
                small.insert((Hdr, bevy::post_process::bloom::Bloom::NATURAL));
            }
            small.insert(bevy::core_pipeline::tonemapping::Tonemapping::TonyMcMapface);
            small.settle();
            let plain = small.picture();
            small.insert(Fxaa::default()).settle();
            let fxaa = small.picture();
            assert!(changed(&plain, &fxaa) < 0.5, "FXAA lost the picture");
            let camera = small.camera;
            small.world().entity_mut(camera).remove::<Fxaa>();
            small.insert((
                Smaa::default(),
                bevy::anti_alias::contrast_adaptive_sharpening::ContrastAdaptiveSharpening {
                    enabled: true,
                    ..default()
                },
            ));
            if hdr && msaa == Msaa::Off {
                small.insert(bevy::post_process::dof::DepthOfField::default());
            }
            small.settle();
            assert!(small.ran(ComicsStage::Stylize), "{msaa:?}, hdr {hdr}");
            assert_ne!(
                small.picture().get_pixel(1, 1).0,
                [0, 0, 0, 0],
                "the picture was lost"
            );
            assert_eq!(small.errors(), 0, "{msaa:?}, hdr {hdr}");
        }
    }
}

#[test]
fn failure_22_the_passes_have_an_order() {
    // Every ambiguity of the render schedule that names a system of ours.
    let mut small = Small::new(size(), Msaa::Off);
    small.style(&full_style());
    small.settle();
    let render_app = small.headless.app.sub_app_mut(RenderApp);
    let world = render_app.world_mut();
    let mut ours = Vec::new();
    let mut checked = 0;
    world.resource_scope(|world, schedules: Mut<Schedules>| {
        let Some(schedule) = schedules.get(bevy::core_pipeline::Core3d) else {
            return;
        };
        checked += 1;
        for (a, b, _) in schedule.graph().conflicting_systems().iter() {
            let name = |id| {
                schedule
                    .systems()
                    .ok()
                    .and_then(|mut systems| {
                        systems
                            .find(|(key, _)| *key == id)
                            .map(|(_, system)| system.name().to_string())
                    })
                    .unwrap_or_default()
            };
            let (a, b) = (name(*a), name(*b));
            let post = |n: &str| n.contains("bevy_comics");
            if post(&a) || post(&b) {
                ours.push((a, b));
            }
        }
        let _ = world;
    });
    assert_eq!(checked, 1, "the Core3d schedule was not found");
    assert!(ours.is_empty(), "unordered: {ours:?}");
}

#[test]
fn failure_23_cameras_that_cannot_be_styled_are_left_alone() {
    let mut small = Small::new(size(), Msaa::Off);
    let target: RenderTarget = small.headless.render_target();
    let flat = small
        .world()
        .spawn((
            Camera2d,
            target,
            Camera {
                order: 3,
                clear_color: ClearColorConfig::None,
                ..default()
            },
            Contours::default(),
        ))
        .id();
    let blind = small
        .world()
        .spawn((
            Camera3d::default(),
            RenderTarget::None {
                size: UVec2::new(32, 32),
            },
            Camera {
                order: 4,
                ..default()
            },
            Contours::default(),
        ))
        .id();
    small.settle();
    let diagnostics = small.headless.app.world().resource::<ComicsDiagnostics>();
    assert!(!diagnostics.ran(flat, ComicsStage::Stylize));
    assert!(!diagnostics.ran(blind, ComicsStage::Stylize));
    assert_eq!(small.errors(), 0);
}

/// The faithful mode is there for comparison: it draws slopes, the default not.
#[test]
fn the_default_draws_no_slopes_and_the_faithful_form_does() {
    let mut small = Small::new(size(), Msaa::Off);
    let ink = |small: &mut Small, form| {
        small
            .insert(Contours {
                form,
                threshold: 0.03,
                softness: 0.0,
                ..default()
            })
            .settle();
        small
            .picture()
            .pixels()
            .filter(|p| p.0[..3] == [0, 0, 0])
            .count()
    };
    let faithful = ink(&mut small, ContourForm::Faithful);
    let plane_aware = ink(&mut small, ContourForm::PlaneAware);
    assert!(
        plane_aware > 100 && faithful > 2 * plane_aware,
        "{plane_aware} and {faithful}"
    );
}
