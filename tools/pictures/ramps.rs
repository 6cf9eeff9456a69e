//! The picture of the ramps of the toon material.

use bevy::prelude::*;
use bevy_comics::{
    ComicsPlugin, Outlines, ToonLight, ToonScene,
    toon::{Ramp, RampBlend, RampMode, RampStop},
};
use bevy_comics_testkit::headless::{Headless, HeadlessOptions};
use image::RgbaImage;

use crate::pages::put_lit;

/// Frames until shaders are compiled and the picture stands still.
const SETTLE: usize = 12;

/// From left to right: no ramp, the default ramp, four tones with a soft edge, and the colors of
/// a poster in place of that of the surface.
fn ramps() -> [Option<Ramp>; 4] {
    let skin = [
        RampStop::new(0.0, Color::srgb(0.44, 0.32, 0.66)),
        RampStop::new(0.08, Color::srgb(0.82, 0.50, 0.58)),
        RampStop::new(0.22, Color::srgb(0.91, 0.87, 0.86)).soft(0.12),
        RampStop::new(0.72, Color::WHITE),
    ];
    let poster = [
        RampStop::new(0.0, Color::srgb(0.13, 0.11, 0.30)),
        RampStop::new(0.15, Color::srgb(0.70, 0.20, 0.32)),
        RampStop::new(0.50, Color::srgb(0.96, 0.58, 0.22)),
        RampStop::new(0.85, Color::srgb(1.00, 0.93, 0.70)),
    ];
    let per_light = |stops| Ramp {
        mode: RampMode::PerLight,
        ..Ramp::new(stops)
    };
    [
        None,
        Some(Ramp {
            mode: RampMode::PerLight,
            ..Ramp::default()
        }),
        Some(per_light(skin)),
        Some(Ramp {
            blend: RampBlend::Absolute,
            ..per_light(poster)
        }),
    ]
}

fn put(world: &mut World, mesh: Mesh, color: Color, light: &ToonLight, at: Vec3) {
    let light = light.clone();
    put_lit(world, mesh, color, at, ToonScene::new(light));
}

/// A pawn of a game of chess.
fn pawn(world: &mut World, light: &ToonLight, x: f32) {
    let color = Color::srgb(0.95, 0.66, 0.45);
    let body = ConicalFrustum {
        radius_top: 0.26,
        radius_bottom: 0.52,
        height: 0.9,
    };
    let parts: [(Mesh, f32); 5] = [
        (Cylinder::new(0.70, 0.26).mesh().resolution(64).into(), 0.13),
        (
            Torus::new(0.36, 0.62).mesh().minor_resolution(24).into(),
            0.3,
        ),
        (body.mesh().resolution(64).into(), 0.75),
        (
            Torus::new(0.18, 0.44).mesh().minor_resolution(24).into(),
            1.22,
        ),
        (Sphere::new(0.46).mesh().uv(64, 32), 1.66),
    ];
    for (mesh, height) in parts {
        put(world, mesh, color, light, Vec3::new(x, height, 0.0));
    }
}

/// Four pawns in the light of a sun, each with a ramp.
pub fn picture() -> RgbaImage {
    let size = UVec2::new(800, 300);
    let mut headless = Headless::new(HeadlessOptions { size, ..default() }, ComicsPlugin);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    world.insert_resource(ClearColor(Color::srgb(0.96, 0.9, 0.78)));
    world.insert_resource(GlobalAmbientLight {
        brightness: 220.0,
        ..default()
    });
    let from = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::new(0.0, 1.0, 0.0), Vec3::Y);
    let outlines = Outlines {
        width: 2.5,
        ..default()
    };
    let lens = Projection::Perspective(PerspectiveProjection {
        fov: 0.36,
        ..default()
    });
    let camera = Camera3d::default();
    world.spawn((camera, lens, from(0.0, 2.3, 7.4), target, outlines));
    let sun = DirectionalLight {
        illuminance: 5600.0,
        shadow_maps_enabled: true,
        ..default()
    };
    world.spawn((sun, from(-4.4, 4.4, 2.8)));
    let ground = Plane3d::default().mesh().size(40.0, 40.0).build();
    let plain = ToonLight {
        ramp: Some(Ramp::default()),
        ..default()
    };
    put(
        world,
        ground,
        Color::srgb(0.93, 0.84, 0.66),
        &plain,
        Vec3::ZERO,
    );
    for (k, ramp) in ramps().into_iter().enumerate() {
        let light = ToonLight { ramp, ..default() };
        pawn(world, &light, -2.55 + 1.7 * k as f32);
    }
    headless.step(SETTLE);
    headless.picture()
}
