//! The inspector on a built-in scene, with one or two cameras.
//!
//! `cargo run --example inspector -- --help`

use std::{fs, path::PathBuf, time::Instant};

use bevy::{
    camera::{Viewport, visibility::RenderLayers},
    prelude::*,
    render::view::Msaa,
    window::WindowResolution,
};
use bevy_comics::{ComicStyle, ComicsPlugin, presets};
use bevy_comics_inspector::{ComicsInspector, ComicsInspectorPlugin};
use bevy_comics_testkit::{
    orbit::{Orbit, OrbitPlugin},
    panel_state::panel_state,
    scenes::{BuiltIn, Stage, figure::motion::MotionPlugin},
    studio::{set_style, set_toon},
};

const HELP: &str = "\
The inspector on a built-in scene. F10 closes and opens the panel.

    --scene NAME       mountains, teapot, theatre, village or figure (village)
    --style NAME       the first style: a preset, a style file, or `none` (graphic-novel)
    --toon          the scene in toon materials, with its looks
    --cameras N        1, or 2 side by side (1)
    --size WxH         size of the window in physical pixels (1280x720)
    --viewport WIDTH   cameras draw only to this width of the window, from its left side,
                       in physical pixels (all of it)
    --scale FACTOR     scale factor of the window (the system's)
    --styles FOLDER    folder of style files (assets/styles)
    --shadings FOLDER     folder of shading files (assets/shading)
    --pictures FOLDER  folder of screenshots (screenshots)
    --memory FILE      file of the panel's settings, `none` for no file
    --closed           start with the panel closed
    --state FILE       write what the panel shows to a JSON file, every frame
    --bench FRAMES     print the mean time of this number of frames, then exit
    --bare             without the inspector
    --help             print this text
";

#[derive(Resource, Clone)]
struct Options {
    scene: BuiltIn,
    style: ComicStyle,
    toon: bool,
    cameras: u32,
    size: UVec2,
    viewport: Option<u32>,
    scale: Option<f32>,
    plugin: ComicsInspectorPlugin,
    open: bool,
    bare: bool,
    state: Option<PathBuf>,
    bench: Option<u32>,
}

/// A preset, a style file, or no style.
fn style(name: &str) -> Result<ComicStyle, String> {
    if let Some(preset) = presets::find(name) {
        return Ok(preset.style());
    }
    if name == "none" {
        return Ok(ComicStyle::new());
    }
    let text = fs::read_to_string(name)
        .map_err(|error| format!("--style {name}: no preset, and no file: {error}"))?;
    ComicStyle::from_ron(&text).map_err(|error| format!("--style {name}: {error}"))
}

fn options() -> Result<Options, lexopt::Error> {
    use lexopt::prelude::*;
    let mut options = Options {
        scene: BuiltIn::Village,
        style: presets::GRAPHIC_NOVEL.style(),
        toon: false,
        cameras: 1,
        size: UVec2::new(1280, 720),
        viewport: None,
        scale: None,
        plugin: ComicsInspectorPlugin::default(),
        open: true,
        bare: false,
        state: None,
        bench: None,
    };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("scene") => {
                let name = parser.value()?.string()?;
                options.scene = BuiltIn::from_name(&name).ok_or("no scene of this name")?;
            }
            Long("style") => options.style = style(&parser.value()?.string()?)?,
            Long("cameras") => options.cameras = parser.value()?.parse::<u32>()?.clamp(1, 2),
            Long("size") => {
                let text = parser.value()?.string()?;
                let (width, height) = text.split_once('x').ok_or("a size is WIDTHxHEIGHT")?;
                let side = |text: &str| text.parse().map_err(|_| "a size is WIDTHxHEIGHT");
                options.size = UVec2::new(side(width)?, side(height)?);
            }
            Long("viewport") => options.viewport = Some(parser.value()?.parse()?),
            Long("scale") => options.scale = Some(parser.value()?.parse()?),
            Long("styles") => options.plugin.styles = parser.value()?.into(),
            Long("toon") => options.toon = true,
            Long("shadings") => options.plugin.shadings = parser.value()?.into(),
            Long("pictures") => options.plugin.pictures = parser.value()?.into(),
            Long("memory") => {
                let path = PathBuf::from(parser.value()?);
                options.plugin.memory = (path.as_os_str() != "none").then_some(path);
            }
            Long("bare") => options.bare = true,
            Long("closed") => options.open = false,
            Long("state") => options.state = Some(parser.value()?.into()),
            Long("bench") => options.bench = Some(parser.value()?.parse()?),
            Long("help") => {
                print!("{HELP}");
                std::process::exit(0);
            }
            _ => return Err(argument.unexpected()),
        }
    }
    if options
        .viewport
        .is_some_and(|width| width < options.cameras)
    {
        return Err("--viewport: at least one pixel for each camera".into());
    }
    Ok(options)
}

fn main() {
    let options = options().unwrap_or_else(|error| {
        eprintln!("{error}\n\n{HELP}");
        std::process::exit(2);
    });
    let mut resolution = WindowResolution::new(options.size.x, options.size.y);
    if let Some(scale) = options.scale {
        resolution = resolution.with_scale_factor_override(scale);
    }
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(Window {
            title: "bevy_comics inspector".into(),
            resolution,
            present_mode: bevy::window::PresentMode::AutoNoVsync,
            ..default()
        }),
        ..default()
    }))
    .add_plugins((ComicsPlugin, OrbitPlugin, MotionPlugin));
    if !options.bare {
        app.add_plugins(options.plugin.clone());
    }
    if options.toon {
        let all = |world: &mut World| set_toon(world, true);
        app.add_systems(PostStartup, all);
    }
    app.insert_resource(options)
        .add_systems(Startup, setup)
        .add_systems(Update, lay_out)
        .add_systems(Last, (tell, bench))
        .run();
}

/// Marks a camera of the window: 0 is the left one or the only one, 1 the right.
#[derive(Component)]
struct Half(u32);

fn setup(mut stage: Stage, options: Res<Options>, inspector: Option<ResMut<ComicsInspector>>) {
    if let Some(mut inspector) = inspector {
        inspector.open = options.open;
    }
    let vantage = stage.spawn(options.scene);
    for i in 0..options.cameras {
        let mut view = vantage.clone();
        if i == 1 {
            // A little to the side of the first camera.
            let away = view.eye - view.target;
            view.eye = view.target + Quat::from_rotation_y(0.35) * away;
        }
        let mut camera = stage.commands.spawn((
            Name::new(if i == 0 {
                "Main camera"
            } else {
                "Second camera"
            }),
            Half(i),
            view.camera(),
            Orbit::of(&view),
            Msaa::Off,
            RenderLayers::default(),
        ));
        set_style(&mut camera, &options.style);
    }
}

/// Keeps cameras within the width that `--viewport` names. Two cameras share it: the first draws to
/// its left half, the second to its right half.
fn lay_out(
    options: Res<Options>,
    window: Single<&Window>,
    mut cameras: Query<(&mut Camera, &Half)>,
) {
    if options.cameras < 2 && options.viewport.is_none() {
        return;
    }
    let mut size = window.physical_size();
    size.x = options.viewport.unwrap_or(size.x).min(size.x);
    if size.x < options.cameras || size.y == 0 {
        return;
    }
    for (mut camera, half) in &mut cameras {
        if camera
            .viewport
            .as_ref()
            .is_some_and(|v| v.physical_size.y > size.y)
        {
            // A screenshot is being taken.
            continue;
        }
        let width = size.x / options.cameras;
        let viewport = Viewport {
            physical_position: UVec2::new(half.0 * width, 0),
            physical_size: UVec2::new(width, size.y),
            ..default()
        };
        if camera.order != half.0 as isize {
            camera.order = half.0 as isize;
            if half.0 > 0 {
                camera.clear_color = ClearColorConfig::None;
            }
        }
        if camera
            .viewport
            .as_ref()
            .is_none_or(|v| v.physical_size != viewport.physical_size)
        {
            camera.viewport = Some(viewport);
        }
    }
}

/// Writes the state of the panel and the cameras to a file, for tests.
fn tell(world: &mut World) {
    let Some(path) = world.resource::<Options>().state.clone() else {
        return;
    };
    // Queries do not keep the order when components come and go.
    let mut cameras: Vec<(u32, Entity)> = world
        .query::<(Entity, &Half)>()
        .iter(world)
        .map(|(camera, half)| (half.0, camera))
        .collect();
    cameras.sort_unstable();
    let cameras: Vec<Entity> = cameras.into_iter().map(|(_, camera)| camera).collect();
    let state = panel_state(world, &cameras);
    // Readers never see a partial file.
    let part = path.with_extension("part");
    if let Err(error) = fs::write(&part, state.to_string()).and_then(|()| fs::rename(&part, &path))
    {
        error!("{}: {error}", path.display());
    }
}

/// Prints the mean time of a frame, after frames in which pipelines compile.
fn bench(
    options: Res<Options>,
    mut frames: Local<u32>,
    mut started: Local<Option<Instant>>,
    mut exit: MessageWriter<AppExit>,
) {
    const WARM_UP: u32 = 60;
    let Some(wanted) = options.bench else {
        return;
    };
    *frames += 1;
    if *frames == WARM_UP {
        *started = Some(Instant::now());
    }
    if let Some(started) = started.filter(|_| *frames >= WARM_UP + wanted) {
        let mean = started.elapsed().as_secs_f64() * 1e3 / f64::from(wanted);
        println!("{mean:.3} ms per frame, mean of {wanted}");
        exit.write(AppExit::Success);
    }
}
