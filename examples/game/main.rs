//! Paper Glider: fly a paper plane through a comic, collect the lanterns before the time
//! is up, and avoid the storm clouds.
//!
//! `cargo run --example game`. The title page lists the keys and gamepad buttons. The
//! photo mode opens the inspector's panel (feature `inspector`, which is always on for
//! this repository's examples).

mod courses;
mod input;
mod looks;
mod rules;
mod screen;

use bevy::{prelude::*, render::view::Msaa, window::WindowResolution};
use bevy_comics::{CameraCut, ComicsPlugin};
use bevy_comics_testkit::{
    headless::{Headless, HeadlessOptions},
    scenes::{ScenePart, Stage},
};
use courses::{CloudAt, LEVELS, LanternAt, Plane, build, course};
use input::{Input, InputPlugin};
use looks::{Dressed, Looks, Mood, come_back, dress};
use rules::{Controls, Event, Flight};

/// The page that is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Title,
    Flying,
    Paused,
    Photo,
    Won,
    Lost,
}

#[derive(Resource)]
struct Game {
    page: Page,
    level: usize,
    flight: Flight,
    /// Points of the levels before this one.
    score: u32,
    /// Whether the autopilot flies.
    autopilot: bool,
    /// Whether the level is still to be built.
    fresh: bool,
}

impl Game {
    fn at_level(level: usize) -> Self {
        Self {
            page: Page::Title,
            level,
            flight: Flight::new(course(level)),
            score: 0,
            autopilot: false,
            fresh: true,
        }
    }

    fn open(&mut self, level: usize) {
        self.level = level;
        self.flight = Flight::new(course(level));
        self.fresh = true;
    }
}

const HELP: &str = "\
Paper Glider. Without arguments it opens a window.

    --level N        start with level 1, 2 or 3
    --play           let the autopilot fly a level without a window, and print the result
    --picture FILE   with --play: save a picture when half of the lanterns are found, and exit
    --help           print this help
";

fn main() {
    if let Err(error) = start() {
        eprintln!("{error}\n\n{HELP}");
        std::process::exit(2);
    }
}

fn start() -> Result<(), lexopt::Error> {
    use lexopt::prelude::*;
    let (mut level, mut play, mut picture) = (0, false, None);
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("level") => level = parser.value()?.parse::<usize>()?.clamp(1, LEVELS.len()) - 1,
            Long("play") => play = true,
            Long("picture") => picture = Some(std::path::PathBuf::from(parser.value()?)),
            Long("help") => {
                print!("{HELP}");
                return Ok(());
            }
            _ => return Err(argument.unexpected()),
        }
    }
    if play {
        std::process::exit(play_by_itself(level, picture));
    }
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(Window {
            title: "Paper Glider".into(),
            resolution: WindowResolution::new(1280, 720),
            ..default()
        }),
        ..default()
    }))
    .add_plugins((ComicsPlugin, InputPlugin, GamePlugin { level }))
    .add_plugins(screen::ScreenPlugin);
    #[cfg(feature = "inspector")]
    app.add_plugins(bevy_comics::inspector::ComicsInspectorPlugin::default());
    app.run();
    Ok(())
}

/// Lets the autopilot fly a level without a window, at 1/20 s per frame. Returns the exit
/// code: 0 for a won level or a saved picture, 1 for a lost level, 2 for a picture that
/// cannot be saved.
fn play_by_itself(level: usize, picture: Option<std::path::PathBuf>) -> i32 {
    let options = HeadlessOptions {
        size: if picture.is_some() {
            UVec2::new(960, 540)
        } else {
            UVec2::new(96, 54)
        },
        log: false,
        ..default()
    };
    let mut headless = Headless::new(options, (ComicsPlugin, GamePlugin { level }));
    headless
        .app
        .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(
            std::time::Duration::from_millis(50),
        ));
    headless.app.init_resource::<Input>();
    let target = headless.render_target();
    headless.app.world_mut().insert_resource(Target(target));
    headless.app.world_mut().resource_mut::<Game>().autopilot = true;
    for frame in 0..2400 {
        let mut input = headless.app.world_mut().resource_mut::<Input>();
        *input = Input {
            confirm: frame == 3,
            ..default()
        };
        headless.step(1);
        let game = headless.app.world().resource::<Game>();
        let half = game.flight.found() * 2 >= game.flight.course.lanterns.len();
        if let Some(path) = picture
            .as_ref()
            .filter(|_| game.page == Page::Flying && half)
        {
            let shot = headless.picture();
            if let Err(error) = shot.save(path) {
                eprintln!("{}: {error}", path.display());
                return 2;
            }
            return 0;
        }
        if matches!(game.page, Page::Won | Page::Lost) {
            break;
        }
    }
    // Also runs the transition to the style of the last page.
    headless.step(30);
    let game = headless.app.world().resource::<Game>();
    let won = game.page == Page::Won;
    println!(
        "{}: {}, {} of {} lanterns, {:.1} s left, score {}",
        LEVELS[game.level].name,
        if won { "won" } else { "lost" },
        game.flight.found(),
        game.flight.course.lanterns.len(),
        game.flight.seconds_left,
        game.flight.score
    );
    i32::from(!won)
}

/// The camera's render target, if it is not the window.
#[derive(Resource)]
struct Target(bevy::camera::RenderTarget);

/// The game without input devices and text.
struct GamePlugin {
    level: usize,
}

impl Plugin for GamePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Game::at_level(self.level))
            .init_resource::<Looks>()
            .add_observer(come_back)
            .add_systems(
                Update,
                (
                    turn_pages,
                    open_level,
                    fly,
                    follow,
                    dress.run_if(any_with_component::<Dressed>),
                )
                    .chain(),
            );
    }
}

/// Changes the page when a button is pressed.
fn turn_pages(mut game: ResMut<Game>, input: Res<Input>) {
    let page = game.page;
    game.page = match page {
        Page::Title if input.confirm => Page::Flying,
        Page::Flying if input.pause => Page::Paused,
        Page::Flying | Page::Paused if input.photo => Page::Photo,
        Page::Paused if input.pause || input.confirm => Page::Flying,
        Page::Photo if input.photo || input.pause => Page::Paused,
        Page::Won if input.confirm => {
            let next = (game.level + 1) % LEVELS.len();
            game.score = if next == 0 {
                0
            } else {
                game.score + game.flight.score
            };
            game.open(next);
            Page::Flying
        }
        Page::Lost if input.confirm => {
            let again = game.level;
            game.open(again);
            Page::Flying
        }
        _ => page,
    };
    if input.restart && !matches!(game.page, Page::Title | Page::Photo) {
        let again = game.level;
        game.open(again);
        game.page = Page::Flying;
    }
}

fn open_level(
    mut stage: Stage,
    mut game: ResMut<Game>,
    mut looks: ResMut<Looks>,
    old: Query<Entity, Or<((With<ScenePart>, Without<ChildOf>), With<Dressed>)>>,
    target: Option<Res<Target>>,
) {
    if !std::mem::take(&mut game.fresh) {
        return;
    }
    for entity in &old {
        stage.commands.entity(entity).despawn();
    }
    let level = &LEVELS[game.level];
    let vantage = build(&mut stage, level, &game.flight);
    looks.enter(level.style());
    let mut camera = stage.commands.spawn((
        Name::new("Chase camera"),
        Dressed,
        vantage.camera(),
        Chase::behind(&game.flight),
        Msaa::Off,
    ));
    if let Some(target) = target {
        camera.insert(target.0.clone());
    }
    // The depth range must not be smoothed from the last level to this one.
    let camera = camera.id();
    stage.commands.trigger(CameraCut { entity: camera });
}

/// A camera that follows the plane with a delay. Both places are in world units.
#[derive(Component)]
struct Chase {
    eye: Vec3,
    target: Vec3,
}

impl Chase {
    fn goal(flight: &Flight) -> (Vec3, Vec3) {
        let heading = Quat::from_rotation_y(flight.yaw);
        let eye = flight.at + heading * Vec3::new(0.0, 2.8, 6.5);
        let target = flight.at + heading * Vec3::new(0.0, 0.6 + 6.0 * flight.pitch, -12.0);
        (eye, target)
    }

    fn behind(flight: &Flight) -> Self {
        let (eye, target) = Self::goal(flight);
        Self { eye, target }
    }
}

fn fly(
    mut game: ResMut<Game>,
    mut looks: ResMut<Looks>,
    input: Res<Input>,
    time: Res<Time>,
    mut commands: Commands,
    lanterns: Query<(Entity, &LanternAt)>,
) {
    if game.page == Page::Flying {
        let controls = if game.autopilot {
            game.flight.autopilot()
        } else {
            Controls {
                steer: input.steer,
                boost: input.boost,
                slow: input.slow,
            }
        };
        // A longer step, after a slow frame, could pass through a cloud.
        let seconds = time.delta_secs().min(0.1);
        for event in game.flight.step(&controls, seconds) {
            match event {
                Event::Lantern(index) => {
                    looks.lantern();
                    let found = lanterns.iter().find(|(_, at)| at.0 == index);
                    if let Some((lantern, _)) = found {
                        commands.entity(lantern).despawn();
                    }
                }
                Event::Hit => looks.hit(),
                Event::Won => game.page = Page::Won,
                Event::Lost => game.page = Page::Lost,
            }
        }
    }
    looks.danger = game.flight.danger();
    looks.mood = match game.page {
        Page::Title => Mood::Title,
        Page::Flying if game.flight.is_slow => Mood::Slow,
        // The photo mode keeps the style of the flight.
        Page::Flying | Page::Photo => Mood::Flying,
        Page::Paused => Mood::Paused,
        Page::Won => Mood::Won,
        Page::Lost => Mood::Lost,
    };
}

fn follow(
    game: Res<Game>,
    time: Res<Time>,
    mut camera: Single<(&mut Transform, &mut Chase)>,
    mut plane: Query<&mut Transform, (With<Plane>, Without<Chase>)>,
    mut clouds: Query<(&mut Transform, &CloudAt), (Without<Plane>, Without<Chase>)>,
    mut lanterns: Query<
        (&mut Transform, &LanternAt),
        (Without<CloudAt>, Without<Plane>, Without<Chase>),
    >,
) {
    let flight = &game.flight;
    // The nose is drawn lower than it is, so that the wings stay visible in a climb.
    let lower = Quat::from_rotation_x(-0.12 - 0.5 * flight.pitch.max(0.0));
    for mut plane in &mut plane {
        *plane = Transform::from_translation(flight.at).with_rotation(flight.rotation() * lower);
    }
    for (mut transform, cloud) in &mut clouds {
        if cloud.0 < flight.course.clouds.len() {
            transform.translation = flight.cloud(cloud.0);
        }
    }
    for (mut transform, _) in &mut lanterns {
        transform.rotation = Quat::from_rotation_y(time.elapsed_secs() * 1.5);
    }
    let (transform, chase) = &mut *camera;
    let (eye, target) = match game.page {
        // A slow orbit around the plane.
        Page::Title => {
            let turn = Quat::from_rotation_y(0.5 + time.elapsed_secs() * 0.15);
            (flight.at + turn * Vec3::new(0.0, 1.6, 5.0), flight.at)
        }
        _ => Chase::goal(flight),
    };
    let fraction = 1.0 - (-7.0 * time.delta_secs()).exp();
    chase.eye = chase.eye.lerp(eye, fraction);
    chase.target = chase.target.lerp(target, fraction * 0.9);
    let lowest = (flight.course.ground)(Vec2::new(chase.eye.x, chase.eye.z)) + 0.6;
    chase.eye.y = chase.eye.y.max(lowest);
    **transform = Transform::from_translation(chase.eye).looking_at(chase.target, Vec3::Y);
}

#[cfg(test)]
#[test]
fn levels_have_courses() {
    for (i, level) in LEVELS.iter().enumerate() {
        assert!(course(i).lanterns.len() > 5);
        assert!(
            !level.style().name.is_empty(),
            "{} has no style",
            level.name
        );
    }
}

#[cfg(test)]
#[test]
fn every_course_can_be_won() {
    for i in 0..LEVELS.len() {
        for frame in [0.05, 1.0 / 60.0] {
            let mut flight = Flight::new(course(i));
            while !flight.is_over {
                let controls = flight.autopilot();
                flight.step(&controls, frame);
            }
            let found = flight.found();
            assert_eq!(
                found,
                flight.course.lanterns.len(),
                "level {}: {flight:?}",
                i + 1
            );
        }
    }
}
