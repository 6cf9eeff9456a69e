//! Renders a scene or a glTF model with a style, without a window. See
//! `docs/render.md`.
//!
//! ```text
//! cargo run --example render -- model.glb --style graphic-novel --out picture.png
//! cargo run --example render -- --help
//! ```

mod arguments;
mod dump;
mod model;
mod output;
mod sheet;
mod turntable;

use std::process::ExitCode;

use arguments::{Arguments, Ortho, Output, SceneChoice};
use bevy::{camera::Hdr, ecs::system::RunSystemOnce, prelude::*};
use bevy_comics::{ComicsPlugin, objects::MeshSections};
use bevy_comics_testkit::{
    before::BeforeStylize,
    headless::{self, Headless, HeadlessOptions},
    scenes::{BuiltIn, Stage, Vantage, figure::motion::MotionPlugin},
    studio::{set_sections, set_style, set_toon},
};
use model::Model;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("render: {message}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    let Some(arguments) = Arguments::parse()? else {
        return Ok(());
    };
    let adapter = headless::adapter()?;
    arguments.check_against(&adapter)?;
    println!(
        "adapter: {} ({:?})",
        adapter.info.name, adapter.info.device_type
    );
    let scale_factor = match arguments.output {
        Output::Sheet(..) => sheet::scale_factor(arguments.size),
        Output::Picture(_) | Output::Turntable(..) => 1.0,
    };
    let options = HeadlessOptions {
        size: arguments.size,
        scale_factor,
        log: true,
        ..default()
    };
    let mut headless = Headless::new(options, (ComicsPlugin, BeforeStylize::Copy, MotionPlugin));
    let (vantage, model) = open_scene(&mut headless, &arguments)?;
    if arguments.toon {
        set_toon(headless.app.world_mut(), true);
    }
    if let Some(angle) = arguments.sections {
        set_sections(headless.app.world_mut(), MeshSections { angle });
    }
    let camera = spawn_camera(&mut headless, &arguments, &vantage);
    if let Some(model) = &model {
        let world = headless.app.world_mut();
        model.light(world, camera, &vantage, arguments.toon);
    }
    turntable::set_place(headless.app.world_mut(), camera, vantage.transform());
    for frame in 0..arguments.frames {
        headless.step(1);
        println!("frame {} of {}", frame + 1, arguments.frames);
    }

    match &arguments.output {
        Output::Picture(path) => {
            output::save(headless.picture(), path)?;
            println!("wrote {}", path.display());
        }
        Output::Sheet(path, presets) => {
            output::save(sheet::shoot(&mut headless, camera, presets), path)?;
            println!("wrote {}", path.display());
        }
        Output::Turntable(count, frames) => {
            let pivot = model.as_ref().map_or(vantage.target, |m| m.extent.center);
            turntable::write(&mut headless, camera, pivot, *count, frames)?;
        }
    }
    if let Some(folder) = &arguments.dump {
        dump::write(&mut headless, camera, &arguments, &adapter, folder)?;
        println!("wrote {}", folder.display());
    }
    Ok(())
}

fn open_scene(
    headless: &mut Headless,
    arguments: &Arguments,
) -> Result<(Vantage, Option<Model>), String> {
    match &arguments.scene {
        SceneChoice::BuiltIn(scene) => {
            let mut vantage = build(headless, *scene)?;
            arguments.adjust(&mut vantage, None);
            Ok((vantage, None))
        }
        SceneChoice::Model(path) => {
            let turned = matches!(arguments.output, Output::Turntable(..));
            let model = model::load(headless, path, turned)?;
            let mut vantage = model.vantage(headless.app.world_mut(), arguments.size);
            arguments.adjust(&mut vantage, Some(&model));
            Ok((vantage, Some(model)))
        }
    }
}

fn build(headless: &mut Headless, scene: BuiltIn) -> Result<Vantage, String> {
    println!("building {}", scene.name());
    headless
        .app
        .world_mut()
        .run_system_once(move |mut stage: Stage| stage.spawn(scene))
        .map_err(|error| format!("cannot build {}: {error}", scene.name()))
}

fn spawn_camera(headless: &mut Headless, arguments: &Arguments, vantage: &Vantage) -> Entity {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let projection = match arguments.ortho {
        Some(Ortho::Height(height)) => vantage.orthographic(height),
        Some(Ortho::Fit) => vantage.orthographic(vantage.ortho_height),
        None => vantage.perspective(),
    };
    let mut camera = world.spawn((
        vantage.camera(),
        target,
        Msaa::from_samples(arguments.msaa),
        bevy_comics::depth::VisibleDepthRange::default(),
    ));
    camera.insert(projection);
    if arguments.hdr {
        camera.insert(Hdr);
    }
    let camera = camera.id();
    if let Some(style) = &arguments.style {
        set_style(&mut world.commands().entity(camera), style);
        world.flush();
    }
    camera
}
