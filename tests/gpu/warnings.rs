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
};

use crate::prelude::*;

/// Set in the process that writes to the log.
const ALONE: &str = "WARNINGS_ALONE";

/// Part of each warning: in the log once, however many frames are drawn.
const WARNINGS: [&str; 9] = [
    "is a Camera2d",
    "has no colour target",
    "`LensDistortion` on",
    "an effect of Bevy on the whole picture makes the overlay",
    "do not fade in its fog",
    "`StyleMask::Picture`",
    "`RangeOf`",
    "`LineEdge::Hard`",
    "`Backdrop`",
];

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
}
