//! Compares the outlines of this crate and of bevy_edge_detection_outline 0.4.1, both with
//! default settings, with the true lines of the same frames.
//!
//! ```text
//! cargo run --manifest-path tools/peers/Cargo.toml
//! cargo run --manifest-path tools/peers/Cargo.toml -- times FILE ROUNDS FRAMES
//! cargo run --manifest-path tools/peers/Cargo.toml -- many FILE ROUNDS FRAMES
//! cargo run --manifest-path tools/peers/Cargo.toml -- sheet FILE.png
//! ```
//!
//! The second form times passes for the report, the third one frames with many objects: see
//! `times.rs` and `many.rs`. The last one draws a figure with three materials under four kinds of
//! light: see `sheet.rs`.
//!
//! The true lines come from raw depth, normals and object ids of the same scene at four times
//! the resolution: see `truth.rs` of the examples' shared code.

mod many;
mod sheet;
mod times;

use bevy::{
    core_pipeline::prepass::{DepthPrepass, NormalPrepass},
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    prelude::*,
    render::{RenderApp, sync_world::RenderEntity, view::Msaa},
};
use bevy_comics::{ComicStyle, ComicsPlugin, Outlines};
use bevy_edge_detection_outline::{EdgeDetection, EdgeDetectionPlugin};
use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    scenes::{BuiltIn, Stage},
    truth::{FINE, Truth, ids_alone, mask},
};

const SIZE: UVec2 = UVec2::new(480, 270);

type Build = fn(&mut Headless) -> Transform;

/// An app that has drawn a picture, and its camera in the render world.
struct Shot {
    picture: image::RgbaImage,
    headless: Headless,
    view: Entity,
}

enum Lines {
    None,
    Ours,
    Peer,
}

fn shoot(build: Build, size: UVec2, lines: &Lines) -> Shot {
    let options = HeadlessOptions { size, ..default() };
    let mut headless = Headless::new(options, (ComicsPlugin, EdgeDetectionPlugin));
    let view = build(&mut headless);
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let camera = world
        .spawn((
            Camera3d::default(),
            Projection::Perspective(PerspectiveProjection {
                fov: 32f32.to_radians(),
                ..default()
            }),
            view,
            target,
            Msaa::Off,
            Tonemapping::None,
            DebandDither::Disabled,
            DepthPrepass,
            NormalPrepass,
        ))
        .id();
    match lines {
        Lines::None => {
            world.entity_mut(camera).insert(ids_alone());
        }
        Lines::Ours => {
            let style = ComicStyle::new().with(Outlines::default());
            style.apply(&mut world.commands().entity(camera));
            world.flush();
        }
        Lines::Peer => {
            world.entity_mut(camera).insert(EdgeDetection::default());
        }
    }
    headless.step(8);
    let picture = headless.picture();
    let view = headless.app.world().get::<RenderEntity>(camera).expect("drawn").id();
    Shot { picture, headless, view }
}

fn truth(build: Build) -> Truth {
    let shot = shoot(build, SIZE * FINE, &Lines::None);
    let render_world = shot.headless.app.sub_app(RenderApp).world();
    Truth::read(render_world, shot.view, SIZE, FINE)
}

/// A fraction in percent; "-" of nothing.
fn percent((yes, total): (usize, usize)) -> String {
    if total == 0 {
        return "-".into();
    }
    format!("{:.1} %", 100.0 * yes as f64 / total as f64)
}

fn report(name: &str, build: Build) {
    let truth = truth(build);
    let plain = shoot(build, SIZE, &Lines::None).picture;
    let any = truth.any(&[0, 1, 2]);
    for (who, lines) in [("bevy_comics", Lines::Ours), ("bevy_edge_detection_outline", Lines::Peer)] {
        let lined = shoot(build, SIZE, &lines).picture;
        let mask = mask(&plain, &lined);
        let folder = std::path::Path::new("target/peers");
        let _ = std::fs::create_dir_all(folder);
        let _ = lined.save(folder.join(format!("{name}-{who}.png")));
        let recall = |kind: usize| percent(truth.recall(&truth.kinds[kind], &mask));
        let (right, drawn) = truth.precision(&any, &mask);
        let precision = percent((right, drawn));
        let wrong = drawn - right;
        println!(
            "| {name} | {who} | {} | {} | {} | {precision} | {:.3} % |",
            recall(0),
            recall(1),
            recall(2),
            100.0 * wrong as f64 / (truth.width * truth.height) as f64
        );
    }
}

fn theatre(headless: &mut Headless) -> Transform {
    use bevy::ecs::system::RunSystemOnce;
    let world = headless.app.world_mut();
    let vantage = world.run_system_once(|mut stage: Stage| stage.spawn(BuiltIn::Theatre));
    unlit(world);
    vantage.expect("the stage is there").transform()
}

fn village(headless: &mut Headless) -> Transform {
    use bevy::ecs::system::RunSystemOnce;
    let world = headless.app.world_mut();
    let vantage = world.run_system_once(|mut stage: Stage| stage.spawn(BuiltIn::Village));
    unlit(world);
    vantage.expect("the stage is there").transform()
}

/// Gives all meshes texture coordinates, which bevy_shader_mtoon needs even without textures.
fn give_uvs(world: &mut World) {
    for (_, mesh) in world.resource_mut::<Assets<Mesh>>().iter_mut() {
        if !mesh.contains_attribute(Mesh::ATTRIBUTE_UV_0) {
            let none = vec![[0.0f32; 2]; mesh.count_vertices()];
            mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, none);
        }
    }
}

/// Makes every material unlit, so that only lines change the picture.
fn unlit(world: &mut World) {
    for (_, material) in world.resource_mut::<Assets<StandardMaterial>>().iter_mut() {
        material.unlit = true;
    }
}

fn put(headless: &mut Headless, mesh: impl Into<Mesh>, at: Transform, tone: f32) {
    let world = headless.app.world_mut();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
    let material = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::srgb(tone, tone, tone),
        unlit: true,
        ..default()
    });
    world.spawn((Mesh3d(mesh), MeshMaterial3d(material), at));
}

fn plane(headless: &mut Headless) -> Transform {
    put(headless, Plane3d::default().mesh().size(4e4, 4e4), Transform::IDENTITY, 0.7);
    let eye = Vec3::new(0.0, 1.7, 0.0);
    Transform::from_translation(eye).looking_at(eye - Vec3::new(0.3, 0.02, 1.0), Vec3::Y)
}

fn corridor(headless: &mut Headless) -> Transform {
    for k in 0..4u8 {
        let turn = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2 * f32::from(k));
        put(
            headless,
            Plane3d::default().mesh().size(3.0, 200.0),
            Transform::from_rotation(turn) * Transform::from_xyz(0.0, -1.5, -100.0),
            0.4 + 0.1 * f32::from(k),
        );
    }
    Transform::from_xyz(0.4, 0.2, -0.5).looking_at(Vec3::new(0.0, 0.0, -50.0), Vec3::Y)
}

fn sphere(headless: &mut Headless) -> Transform {
    let ball = Sphere::new(1.0).mesh().ico(40).expect("not too fine");
    put(headless, ball, Transform::IDENTITY, 0.7);
    Transform::from_xyz(0.0, 0.5, 4.5).looking_at(Vec3::ZERO, Vec3::Y)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [mode, file, rounds, frames] = &arguments[..] {
        let number = |text: &String| text.parse().expect("a number of rounds and of frames");
        let (rounds, frames) = (number(rounds), number(frames));
        let rows = match mode.as_str() {
            "times" => times::measure(rounds, frames),
            "many" => many::measure(&[1_000, 20_000, 60_000], rounds, frames),
            _ => panic!("{mode} is neither times nor many"),
        };
        std::fs::write(file, rows).unwrap_or_else(|error| panic!("{file}: {error}"));
        return;
    }
    if let [mode, file] = &arguments[..]
        && mode == "sheet"
    {
        sheet::write(std::path::Path::new(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        return;
    }
    println!("| scene | | silhouettes found | creases found | object edges found | precision | false pixels |");
    println!("|---|---|---|---|---|---|---|");
    let scenes: [(&str, Build); 5] = [
        ("theatre", theatre),
        ("village", village),
        ("plane", plane),
        ("corridor", corridor),
        ("sphere", sphere),
    ];
    for (name, build) in scenes {
        report(name, build);
    }
}
