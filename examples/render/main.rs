//! Renders a scene with a style into a PNG, without a window.
//!
//! ```text
//! cargo run --example render -- [SCENE] [--style NAME|FILE.comic.ron] [--size WxH]
//!     [--camera EX,EY,EZ,TX,TY,TZ] [--near N] [--far F] [--ortho HEIGHT] [--msaa 1|2|4|8]
//!     [--hdr] [--frames N] [--out FILE.png] [--dump DIR]
//! ```

mod arguments;
mod dump;
mod model;

use std::process::ExitCode;

use arguments::{Arguments, SceneChoice};
use bevy::{camera::Hdr, ecs::system::RunSystemOnce, prelude::*, render::view::Msaa};
use bevy_comics::ComicsPlugin;
use bevy_comics_testkit::{
    headless::{self, Headless, HeadlessOptions},
    scenes::{Stage, Vantage},
    studio::{set_cartoon, wear},
};

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

    let options = HeadlessOptions {
        size: arguments.size,
        log: true,
        ..default()
    };
    let mut headless = Headless::new(options, ComicsPlugin);
    let mut vantage = match &arguments.scene {
        SceneChoice::BuiltIn(scene) => {
            println!("building {}", scene.name());
            let scene = *scene;
            headless
                .app
                .world_mut()
                .run_system_once(move |mut stage: Stage| stage.spawn(scene))
                .map_err(|error| format!("cannot build {}: {error}", scene.name()))?
        }
        SceneChoice::Model(path) => model::load(&mut headless, path)?,
    };
    arguments.adjust(&mut vantage);
    if arguments.cartoon {
        set_cartoon(headless.app.world_mut(), true);
    }
    let camera = spawn_camera(&mut headless, &arguments, &vantage);

    for frame in 0..arguments.frames {
        headless.step(1);
        println!("frame {} of {}", frame + 1, arguments.frames);
    }

    let picture = headless.picture();
    if let Some(folder) = arguments.out.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
    }
    picture
        .save(&arguments.out)
        .map_err(|error| format!("cannot write {}: {error}", arguments.out.display()))?;
    println!("wrote {}", arguments.out.display());
    if let Some(folder) = &arguments.dump {
        dump::write(&mut headless, camera, &arguments, &adapter, folder)?;
        println!("wrote {}", folder.display());
    }
    Ok(())
}

fn spawn_camera(headless: &mut Headless, arguments: &Arguments, vantage: &Vantage) -> Entity {
    let target = headless.render_target();
    let world = headless.app.world_mut();
    let projection = match arguments.ortho {
        Some(height) => vantage.orthographic(height),
        None => vantage.perspective(),
    };
    let mut camera = world.spawn((
        vantage.camera(),
        target,
        Msaa::from_samples(arguments.msaa),
        bevy_comics::VisibleDepthRange::default(),
    ));
    camera.insert(projection);
    if arguments.hdr {
        camera.insert(Hdr);
    }
    let camera = camera.id();
    if let Some(style) = &arguments.style {
        wear(&mut world.commands().entity(camera), style);
        world.flush();
    }
    camera
}
