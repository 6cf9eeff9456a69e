//! The game without a window: the autopilot flies, and a picture is saved.

use std::{path::PathBuf, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_comics::ComicsPlugin;
use bevy_comics_testkit::headless::{Headless, HeadlessOptions};

use crate::{
    Game, GamePlugin, Target,
    courses::LEVELS,
    input::Input,
    pages::Page,
    rules::{Event, Flight},
};

/// What the autopilot is asked for.
pub struct Orders {
    pub level: usize,
    pub picture: Option<PathBuf>,
    /// Number of lanterns that are found before it is drawn; by default half of them on a picture,
    /// and all but two else.
    pub lanterns: Option<usize>,
    pub size: UVec2,
}

/// App time per frame.
const FRAME: Duration = Duration::from_millis(50);
/// Frames after which the end of the flight is given up: more than a level takes.
const PATIENCE: usize = 2600;
/// Frames before a picture: the camera arrives, and motion lines grow.
const SHOT: usize = 14;
/// Frames for the transition to the style of the last page.
const SETTLE: usize = 30;

/// Lets the autopilot fly a level. Returns the exit code: 0 for a won level or a saved picture, 1
/// for a lost level, 2 for a picture that cannot be saved.
pub fn by_itself(orders: &Orders) -> i32 {
    let mut headless = start(orders);
    // The title, and then the flight.
    for confirm in [false, false, true, false] {
        headless.app.world_mut().resource_mut::<Input>().confirm = confirm;
        headless.step(1);
    }
    if let Some(path) = &orders.picture {
        let world = headless.app.world_mut();
        let now = world.resource::<Time>().elapsed_secs();
        let game = world.resource_mut::<Game>().into_inner();
        skip_to(&mut game.flight, orders.lanterns);
        // The last lantern still rings on the picture.
        game.shout(Event::Lantern(0), now + 0.3);
        headless.step(SHOT);
        if let Err(error) = headless.picture().save(path) {
            eprintln!("{}: {error}", path.display());
            return 2;
        }
        return 0;
    }
    // Most of the flight is not drawn: without a GPU that would take minutes.
    let all = LEVELS[orders.level].course().lanterns.len();
    let game = headless.app.world_mut().resource_mut::<Game>();
    let lanterns = orders.lanterns.unwrap_or(all.saturating_sub(2));
    skip_to(&mut game.into_inner().flight, Some(lanterns));
    let page = |headless: &Headless| *headless.app.world().resource::<State<Page>>().get();
    for _ in 0..PATIENCE {
        headless.step(1);
        if matches!(page(&headless), Page::Won | Page::Lost) {
            break;
        }
    }
    headless.step(SETTLE);
    report(headless.app.world())
}

/// Flies without drawing until so many lanterns are found, half of them by default.
fn skip_to(flight: &mut Flight, lanterns: Option<usize>) {
    let half = flight.collected.len() / 2;
    while !flight.is_over && flight.found() < lanterns.unwrap_or(half) {
        let controls = flight.autopilot();
        flight.step(&controls, FRAME.as_secs_f32());
    }
}

fn start(orders: &Orders) -> Headless {
    let options = HeadlessOptions {
        size: match orders.picture {
            Some(_) => orders.size,
            None => UVec2::new(96, 54),
        },
        ..default()
    };
    let game = GamePlugin {
        level: orders.level,
        lettered: orders.picture.is_some(),
    };
    let mut headless = Headless::new(options, (ComicsPlugin, game));
    let target = headless.render_target();
    headless
        .app
        .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
        .init_resource::<Input>()
        .insert_resource(Target(target));
    headless.app.world_mut().resource_mut::<Game>().autopilot = true;
    headless
}

fn report(world: &World) -> i32 {
    let (game, page) = (world.resource::<Game>(), world.resource::<State<Page>>());
    let won = *page.get() == Page::Won;
    println!(
        "{}: {} in {:.1} s, {} of {} lanterns",
        LEVELS[game.level].name,
        if won { "won" } else { "lost" },
        game.flight.seconds_used(),
        game.flight.found(),
        game.flight.course.lanterns.len(),
    );
    i32::from(!won)
}
