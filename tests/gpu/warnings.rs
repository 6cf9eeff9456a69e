//! What the log says of cameras.

use std::process::Command;

use bevy::{
    camera::{ClearColorConfig, visibility::RenderLayers},
    core_pipeline::prepass::{DeferredPrepass, DepthPrepass},
    light::VolumetricFog,
    material::OpaqueRendererMethod,
    post_process::effect_stack::{ChromaticAberration, LensDistortion},
};
use bevy_comics::{
    cameras::{RangeOf, StyleMask, overlay_camera},
    objects::Backdrop,
    toon::StyleScene,
};

use crate::{
    prelude::*,
    ramp::{bright, put, sun},
    ramp_detail::two_tones,
};

/// Set in the process that writes to the log.
const ALONE: &str = "WARNINGS_ALONE";

/// Part of each warning: in the log once, however many frames are drawn.
const WARNINGS: [&str; 12] = [
    "is a Camera2d",
    "has no color target",
    "`LensDistortion` on",
    "a full-screen effect of Bevy makes the picture of the overlay",
    "do not fade in its fog",
    "`StyleMask::Picture`",
    "`RangeOf`",
    "`LineEdge::Hard`",
    "`Backdrop`",
    "light the same meshes",
    "draws shadows, but no light has `shadow_maps_enabled`",
    "in more than 64 views, materials do not find the visible range",
];

/// Views of two pixels: one more than materials find the visible range of.
const VIEWS: u32 = 65;

/// Warnings are logged once in a process, so the cameras are in a process of their own.
#[test]
fn what_does_not_go_together_is_warned_of_once() {
    if std::env::var_os(ALONE).is_some() {
        return draw_all();
    }
    let output = Command::new(std::env::current_exe().expect("the test"))
        .args(["--exact", "--nocapture"])
        .arg("warnings::what_does_not_go_together_is_warned_of_once")
        .env(ALONE, "yes")
        .output()
        .expect("it starts");
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{log}");
    for warning in WARNINGS {
        assert_eq!(log.matches(warning).count(), 1, "{warning} in\n{log}");
    }
}

fn draw_all() {
    let options = HeadlessOptions {
        log: true,
        ..options(size())
    };
    let mut small = Small::alone(options, Msaa::Off);
    small.count_errors();
    let target = small.headless.render_target();
    let first = small.camera;
    small.insert((Outlines::default(), LensDistortion::default()));
    let deferred = StandardMaterial {
        opaque_render_method: OpaqueRendererMethod::Deferred,
        ..default()
    };
    let sky = small.put(Sphere::new(50.0), deferred, Transform::IDENTITY);
    let layer = RenderLayers::layer(5);
    let backdrop = (Backdrop::default(), layer.clone());
    small.world().entity_mut(sky).insert(backdrop);
    let world = small.world();
    world.spawn((Camera2d, Outlines::default()));
    let nowhere = RenderTarget::None { size: size() };
    let nowhere = (Camera3d::default(), nowhere, Outlines::default());
    let plain = world
        .spawn((Camera3d::default(), target.clone(), Msaa::Off))
        .id();
    world.spawn(nowhere);
    // The engine panics where a camera with another prepass sees a deferred material.
    let deferred = (Camera3d::default(), target.clone(), Msaa::Off, layer);
    let deferred = world.spawn((deferred, DepthPrepass, DeferredPrepass)).id();
    let shared = Camera {
        order: 2,
        clear_color: ClearColorConfig::None,
        ..default()
    };
    let over = (
        overlay_camera(1),
        Outlines::PIXELS,
        ChromaticAberration::default(),
    );
    world.spawn((Camera3d::default(), target.clone(), Msaa::Off, over));
    let mask = (StyleMask::Picture, Desaturation::default(), RangeOf(plain));
    world.spawn((Camera3d::default(), target, Msaa::Off, shared, mask));
    world.entity_mut(first).insert(VolumetricFog::default());
    small.headless.step(3);
    small.world().despawn(deferred);
    small.insert((Outlines::PIXELS, Msaa::Sample4));
    small.headless.step(3);
    light_twice(&mut small);
    draw_many_views(&mut small);
}

/// Two cameras have different lights for the same meshes. Nothing casts their shadows.
fn light_twice(small: &mut Small) {
    let world = small.world();
    let mut cameras = world.query_filtered::<Entity, With<Camera3d>>();
    let cameras: Vec<Entity> = cameras.iter(world).collect();
    let (lit, others) = cameras.split_at(2);
    for camera in others {
        world.despawn(*camera);
    }
    let sun = world.spawn(DirectionalLight::default()).id();
    for (camera, highlight) in lit.iter().zip([0.5, 1.0]) {
        let light = ToonLight {
            highlight,
            ..default()
        };
        let style = ComicStyle::new().with_scene(StyleScene::new(light));
        let mut commands = world.commands();
        let mut camera = commands.entity(*camera);
        camera.insert(Comic::default());
        style.apply(&mut camera);
    }
    world.flush();
    small.wait(5.5);
    small.world().despawn(sun);
}

/// Where a view begins.
fn corner(view: u32) -> UVec2 {
    UVec2::new(2 * (view % 48), view / 48)
}

/// The left pixel of each view shows a wall at the near end of its range, the right one a wall at the far end. A view
/// that does not find its range draws both as at the near end.
fn draw_many_views(small: &mut Small) {
    small.clear();
    let world = small.world();
    let mut cameras = world.query_filtered::<Entity, With<Camera>>();
    for camera in cameras.iter(world).collect::<Vec<_>>() {
        world.despawn(camera);
    }
    world.insert_resource(GlobalAmbientLight {
        brightness: 0.0,
        ..default()
    });
    sun(small, Vec3::Z, bright(1.0));
    let light = two_tones(DetailAxis::VisibleRange, RampMode::LightFraction);
    for (side, z) in [(-0.5, 2.0), (0.5, 50.0)] {
        let height = 2.0 * std::f32::consts::FRAC_PI_8.tan() * z;
        let at = Transform::from_xyz(side * height, 0.0, -z).with_scale(Vec3::splat(height));
        put(small, Rectangle::new(0.9, 0.9), &light, at);
    }
    let target = small.headless.render_target();
    for view in 0..VIEWS {
        let viewport = Viewport {
            physical_position: corner(view),
            physical_size: UVec2::new(2, 1),
            ..default()
        };
        let settings = Camera {
            viewport: Some(viewport),
            order: view as isize,
            clear_color: if view == 0 {
                Color::BLACK.into()
            } else {
                ClearColorConfig::None
            },
            ..default()
        };
        let camera = crate::small::camera(target.clone(), Msaa::Off);
        let camera = small.world().spawn((camera, Exposure::default())).id();
        small.world().entity_mut(camera).insert((
            settings,
            Transform::IDENTITY,
            VisibleDepthRange::default(),
        ));
    }
    small.headless.step(4);
    let picture = small.picture();
    // Red at the near end, blue at the far one.
    let count = |right: u32, is_near: bool| {
        let views = (0..VIEWS).filter(|view| {
            let at = corner(*view);
            let [red, _, blue, _] = picture.get_pixel(at.x + right, at.y).0;
            (is_near && red > blue) || (!is_near && blue > red)
        });
        views.count()
    };
    assert_eq!(count(0, true), 65);
    assert_eq!([count(1, true), count(1, false)], [1, 64]);
}
