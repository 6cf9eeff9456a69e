//! The pictures of the pages about single tasks.

use std::path::Path;

use bevy::{
    camera::{Camera3dDepthLoadOp, Viewport, visibility::RenderLayers},
    core_pipeline::tonemapping::Tonemapping,
    light::NotShadowCaster,
    prelude::*,
};
use bevy_comics::{
    ComicStyle, ComicsPlugin, Contours, Desaturation, NoOutlines, OutlineStyle, Outlines,
    SelectionOutline, ToonScene, XRayOutline, presets,
};
use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    scenes::BuiltIn,
    studio::{Studio, set_style},
};
use image::RgbaImage;

use crate::{save, sheet::in_rows, toon::matt};

/// The first program of the README.
mod first {
    #![allow(dead_code, reason = "its `main` opens a window")]
    include!("../../examples/simple.rs");

    pub fn add_to(app: &mut App) {
        app.add_systems(Startup, setup);
    }
}

const SIZE: UVec2 = UVec2::new(480, 270);
const GAP: u32 = 6;
/// Frames until everything that was spawned is on the picture.
const SETTLE: usize = 6;

pub fn write(folder: &Path) -> Result<(), String> {
    save(&simple()?, &folder.join("simple.png"))?;
    save(&objects(), &folder.join("objects.png"))?;
    save(&marks(), &folder.join("marks.png"))?;
    save(&split_screen(), &folder.join("split-screen.png"))?;
    save(&transparency(), &folder.join("transparency.png"))?;
    save(&glass(), &folder.join("glass.png"))
}

fn pair(left: RgbaImage, right: RgbaImage) -> RgbaImage {
    in_rows(&[left, right], 2, SIZE, GAP)
}

fn simple() -> Result<RgbaImage, String> {
    let size = UVec2::new(800, 450);
    let mut headless = Headless::new(HeadlessOptions { size, ..default() }, ComicsPlugin);
    first::add_to(&mut headless.app);
    headless.step(1);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let mut cameras = world.query_filtered::<Entity, With<Camera3d>>();
    let camera = cameras.single(world).map_err(|error| error.to_string())?;
    // The engine looks at a camera's target again when its projection changes.
    world
        .entity_mut(camera)
        .insert((target, Projection::default()));
    headless.step(SETTLE);
    Ok(headless.picture())
}

/// A scene of three toys, each a cube and a ball, from left to right.
struct Toys {
    headless: Headless,
    ground: Entity,
    toys: [[Entity; 2]; 3],
}

/// Adds a mesh with flat light.
fn put(world: &mut World, mesh: Mesh, color: Color, at: Vec3) -> Entity {
    put_lit(world, mesh, color, at, ToonScene::default())
}

/// Adds a mesh with flat light of its own settings.
pub fn put_lit(world: &mut World, mesh: Mesh, color: Color, at: Vec3, scene: ToonScene) -> Entity {
    let mesh = Mesh3d(world.add_asset(mesh));
    let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(matt(color)));
    let place = Transform::from_translation(at);
    world.spawn((mesh, material, place, scene)).id()
}

fn toys() -> Toys {
    let size = UVec2::new(720, 300);
    let mut headless = Headless::new(HeadlessOptions { size, ..default() }, ComicsPlugin);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    world.insert_resource(ClearColor(Color::srgb(0.96, 0.9, 0.78)));
    let from = |x, y, z| Transform::from_xyz(x, y, z).looking_at(Vec3::new(0.0, 0.6, 0.0), Vec3::Y);
    let outlines = Outlines {
        width: 3.0,
        ..default()
    };
    world.spawn((Camera3d::default(), from(0.0, 2.6, 6.0), target, outlines));
    let sun = DirectionalLight {
        shadow_maps_enabled: true,
        ..default()
    };
    world.spawn((sun, from(4.0, 7.0, 5.0)));
    let ground = Plane3d::default().mesh().size(40.0, 40.0).build();
    let ground = put(world, ground, Color::srgb(0.93, 0.84, 0.66), Vec3::ZERO);
    let toys = [(-2.6, 20.0), (0.0, 150.0), (2.6, 250.0)].map(|(x, hue)| {
        let color = Color::oklch(0.72, 0.15, hue);
        let cube = Cuboid::from_length(1.5).into();
        let ball = Sphere::new(0.55).mesh().uv(48, 24);
        [
            put(world, cube, color, Vec3::new(x, 0.75, 0.0)),
            put(world, ball, color.lighter(0.12), Vec3::new(x, 2.0, 0.0)),
        ]
    });
    Toys {
        headless,
        ground,
        toys,
    }
}

/// The camera's lines, lines of its own, no lines.
fn objects() -> RgbaImage {
    let mut scene = toys();
    let world = scene.headless.app.world_mut();
    let own = OutlineStyle {
        color: Some(Color::srgb(0.85, 0.1, 0.15)),
        width: Some(8.0),
        ..default()
    };
    let [_, middle, right] = scene.toys;
    for part in middle {
        world.entity_mut(part).insert(own);
    }
    for part in right {
        world.entity_mut(part).insert(NoOutlines::default());
    }
    // Where a toy stands, the line is the toy's.
    world.entity_mut(scene.ground).insert(NoOutlines::default());
    scene.headless.step(SETTLE);
    scene.headless.picture()
}

/// Behind a wall: a toy without marks, one with `XRayOutline`, one with `SelectionOutline`.
fn marks() -> RgbaImage {
    let mut scene = toys();
    let world = scene.headless.app.world_mut();
    let wall = Cuboid::new(7.6, 1.1, 0.3).into();
    put(
        world,
        wall,
        Color::srgb(0.75, 0.5, 0.38),
        Vec3::new(0.0, 0.55, 1.6),
    );
    let [_, middle, right] = scene.toys;
    for part in middle {
        world.entity_mut(part).insert(XRayOutline::default());
    }
    for part in right {
        world.entity_mut(part).insert(SelectionOutline::default());
    }
    scene.headless.step(SETTLE);
    scene.headless.picture()
}

/// Two players with two styles on one target.
fn split_screen() -> RgbaImage {
    let size = UVec2::new(960, 300);
    let options = HeadlessOptions { size, ..default() };
    let mut studio = Studio::with_options(BuiltIn::Village, options, Msaa::Sample4);
    let target = studio.headless.render_target();
    let half = size / UVec2::new(2, 1);
    let viewport = |player: u32| Camera {
        order: player as isize,
        viewport: Some(Viewport {
            physical_position: UVec2::new(player * half.x, 0),
            physical_size: half,
            ..default()
        }),
        ..default()
    };
    let world = studio.headless.app.world_mut();
    world.entity_mut(studio.camera).insert(viewport(0));
    let second = world
        .spawn((studio.vantage.camera(), target, Msaa::Sample4, viewport(1)))
        .id();
    let mut eye = studio.vantage.transform();
    eye.rotate_around(studio.vantage.target, Quat::from_rotation_y(0.5));
    world.entity_mut(second).insert(eye);
    set_style(
        &mut world.commands().entity(studio.camera),
        &presets::GRAPHIC_NOVEL.style(),
    );
    set_style(
        &mut world.commands().entity(second),
        &presets::TWILIGHT_TOON.style(),
    );
    world.flush();
    studio.headless.step(SETTLE);
    studio.headless.picture()
}

/// A pane of red glass: its distance from the camera, how far it is to the right of the camera's
/// axis, and its height, world units.
fn pane(studio: &mut Studio, [distance, right, height]: [f32; 3]) -> Entity {
    let eye = studio.vantage.transform();
    let at = eye.translation + eye.forward() * distance + eye.right() * right;
    let world = studio.headless.app.world_mut();
    let mesh = Mesh3d(world.add_asset(Rectangle::new(1.2 * height, height)));
    let red = StandardMaterial {
        base_color: Color::srgba(0.85, 0.1, 0.1, 0.55),
        alpha_mode: AlphaMode::Blend,
        unlit: true,
        ..default()
    };
    let material = MeshMaterial3d(world.add_asset::<StandardMaterial>(red));
    let place = eye.with_translation(at);
    world.spawn((mesh, material, place, NotShadowCaster)).id()
}

/// Glass before half of the view takes the depth, and so the gray, of what is behind it.
fn transparency() -> RgbaImage {
    let mut studio = Studio::new(BuiltIn::Teapot, SIZE, Msaa::Sample4);
    pane(&mut studio, [6.0, 2.0, 3.4]);
    let style = ComicStyle::new()
        .with(Desaturation::default())
        .with(Contours::default());
    pair(studio.shoot(None), studio.shoot(Some(&style)))
}

/// Glass through the middle of the scene: on the styled camera, and on a camera after it.
fn glass() -> RgbaImage {
    const AFTER: RenderLayers = RenderLayers::layer(1);
    let mut studio = Studio::new(BuiltIn::Teapot, SIZE, Msaa::Sample4);
    let distance = studio.vantage.eye.distance(studio.vantage.target);
    let pane = pane(&mut studio, [distance, 3.4, 6.0]);
    let style = ComicStyle::new().with(Outlines::default());
    let under = studio.shoot(Some(&style));
    let target = studio.headless.render_target();
    let world = studio.headless.app.world_mut();
    world.entity_mut(pane).insert(AFTER);
    world.spawn((
        Camera3d {
            depth_load_op: Camera3dDepthLoadOp::Load,
            ..default()
        },
        Camera {
            order: 1,
            clear_color: ClearColorConfig::None,
            ..default()
        },
        studio.vantage.transform(),
        studio.vantage.perspective(),
        Tonemapping::AcesFitted,
        Msaa::Sample4,
        target,
        AFTER,
    ));
    studio.headless.step(SETTLE);
    pair(under, studio.headless.picture())
}
