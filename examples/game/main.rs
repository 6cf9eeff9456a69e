//! Paper Glider: fly a paper plane through a comic, collect the lanterns before the time
//! is up, and avoid houses, trees and storm clouds.
//!
//! `cargo run --example game`. The title page lists the keys and gamepad buttons. The
//! photo mode opens the inspector's panel (feature `inspector`, which is always on for
//! this repository's examples).

mod best;
mod courses;
mod flying;
mod input;
mod pages;
mod play;
mod rules;
mod scenery;
mod screen;
mod solids;
mod styles;

use std::path::PathBuf;

use bevy::{camera::RenderTarget, prelude::*, window::WindowResolution};
use bevy_comics::ComicsPlugin;
use bevy_comics_inspector::ComicsInspectorPlugin;
use bevy_comics_testkit::demo;

use best::BestTimes;
use courses::LEVELS;
use input::InputPlugin;
use play::Orders;
use rules::{Event, Flight};

#[derive(Resource)]
struct Game {
    level: usize,
    flight: Flight,
    /// Whether the autopilot flies.
    autopilot: bool,
    /// Whether the level is still to be built.
    fresh: bool,
    /// Whether the flight that was won is the best one so far.
    is_record: bool,
    /// What happened last that is lettered on the picture, and when, in seconds.
    last: Option<(Event, f32)>,
}

impl Game {
    fn at_level(level: usize) -> Self {
        Self {
            level,
            flight: Flight::new(LEVELS[level].course()),
            autopilot: false,
            fresh: true,
            is_record: false,
            last: None,
        }
    }

    /// Goes to the start of a level.
    fn open(&mut self, level: usize) {
        *self = Self {
            autopilot: self.autopilot,
            ..Self::at_level(level)
        };
    }

    fn shout(&mut self, event: Event, seconds: f32) {
        self.last = Some((event, seconds));
    }
}

/// The camera's render target, if it is not the window.
#[derive(Resource)]
struct Target(RenderTarget);

/// The game without input devices.
struct GamePlugin {
    level: usize,
    /// Whether there is text on the screen.
    lettered: bool,
}

impl Plugin for GamePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Game::at_level(self.level))
            .add_plugins((pages::PagesPlugin, flying::FlyingPlugin));
        if self.lettered {
            app.add_plugins(screen::ScreenPlugin);
        }
    }
}

const HELP: &str = "\
Paper Glider. Without arguments it opens a window.

    --level N        start with level 1 (village), 2 (street at night) or 3 (valley at dusk)
    --best FILE      where best times are kept (default: paper-glider.txt in the working folder)
    --play           let the autopilot fly a level without a window, and print the result
    --out FILE       without a window: save a picture when half of the lanterns are found
    --picture FILE   the same
    --lanterns N     when this many are found; with --play, draw only from then on (default: all but two)
    --size WxH       size of the picture (default 960x540)
    --help           print this help
";

/// What the command line asks for.
struct Options {
    play: bool,
    best: PathBuf,
    orders: Orders,
}

fn main() {
    match options() {
        Ok(None) => print!("{HELP}"),
        Ok(Some(options)) if options.play => std::process::exit(play::by_itself(&options.orders)),
        Ok(Some(options)) => open_window(options),
        Err(error) => {
            eprintln!("{error}\n\n{HELP}");
            std::process::exit(2);
        }
    }
}

/// Reads the command line; `None` asks for help.
fn options() -> Result<Option<Options>, lexopt::Error> {
    use lexopt::prelude::*;
    let mut options = Options {
        play: false,
        best: "paper-glider.txt".into(),
        orders: Orders {
            level: 0,
            picture: None,
            lanterns: None,
            size: UVec2::new(960, 540),
        },
    };
    let orders = &mut options.orders;
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("level") => {
                orders.level = parser.value()?.parse::<usize>()?.clamp(1, LEVELS.len()) - 1;
            }
            Long("best") => options.best = parser.value()?.into(),
            Long("play") => options.play = true,
            Long("picture" | "out") => {
                orders.picture = Some(parser.value()?.into());
                options.play = true;
            }
            Long("lanterns") => orders.lanterns = Some(parser.value()?.parse()?),
            Long("size") => {
                let wrong = "possible are 16x16 to 4096x4096";
                let size = |text: &str| demo::parse_size(text).ok_or(wrong);
                orders.size = parser.value()?.parse_with(size)?;
            }
            Long("help") => return Ok(None),
            _ => return Err(argument.unexpected()),
        }
    }
    Ok(Some(options))
}

fn open_window(options: Options) {
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(Window {
            title: "Paper Glider".into(),
            resolution: WindowResolution::new(1280, 720),
            ..default()
        }),
        ..default()
    }));
    let game = GamePlugin {
        level: options.orders.level,
        lettered: true,
    };
    app.insert_resource(BestTimes::load(options.best))
        .add_plugins((
            ComicsPlugin,
            InputPlugin,
            game,
            ComicsInspectorPlugin::default(),
        ));
    app.run();
}
